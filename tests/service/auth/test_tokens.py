"""Tokens and signatures, and the sessions and limits that go by them."""

from __future__ import annotations

import hashlib
import re
from base64 import b64decode

from hypothesis import given
from hypothesis import strategies as st

from service.auth.tokens import digest, new_link_secret, new_signing_secret, new_token, signature, signed_by

LINES = st.text(st.characters(exclude_characters="\n", exclude_categories=["Cs"]))


def test_tokens_are_random_can_be_searched_for_and_are_kept_as_a_hash() -> None:
    tokens = {new_token() for _ in range(100)}
    assert len(tokens) == 100 and all(re.fullmatch(r"galatea_[\w-]{43}", token) for token in tokens)
    token = tokens.pop()
    assert digest(token) == hashlib.sha256(token.encode()).hexdigest() != digest(tokens.pop())


def test_secrets_have_the_length_and_form_that_is_prescribed() -> None:
    signing = new_signing_secret().reveal()
    assert signing.startswith("whsec_") and len(b64decode(signing.removeprefix("whsec_"), validate=True)) == 32
    assert len(bytes.fromhex(new_link_secret().reveal())) == 32


@given(st.lists(LINES, min_size=1, max_size=3), LINES)
def test_a_signature_is_that_of_these_texts_in_this_order_by_this_secret_alone(parts: list[str], secret: str) -> None:
    given_one = signature(secret, *parts)
    assert re.fullmatch(r"[\w-]{43}", given_one)
    assert signed_by(secret, given_one, *parts)
    assert not signed_by(secret + "x", given_one, *parts)
    assert not signed_by(secret, given_one, *parts, "")
    assert not signed_by(secret, given_one, *parts[:-1], parts[-1] + "x")
    assert not signed_by(secret, "ä", *parts)
