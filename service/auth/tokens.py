"""Tokens and secrets: how they are made, and how they are compared."""

from __future__ import annotations

import hashlib
import hmac
import secrets
from base64 import b64encode, urlsafe_b64encode

from service.vault import Secret

KEY_PREFIX = "galatea_"
KEY_HINT_CHARACTERS = len(KEY_PREFIX) + 4


def new_token() -> str:
    """A fresh token: 256 random bits behind a prefix by which leaked ones can be searched for."""
    return KEY_PREFIX + secrets.token_urlsafe(32)


def digest(token: str) -> str:
    """What is kept of a token. It is random throughout, so that a fast hash cannot be tried backwards."""
    return hashlib.sha256(token.encode()).hexdigest()


def new_signing_secret() -> Secret:
    """A fresh secret in the form that Standard Webhooks prescribes: `whsec_` and 24 to 64 bytes in base64."""
    return Secret("whsec_" + b64encode(secrets.token_bytes(32)).decode())


def new_link_secret() -> Secret:
    """A fresh secret for links and sessions."""
    return Secret(secrets.token_hex(32))


def signature(secret: str, *parts: str) -> str:
    """The signature of texts that hold no line breaks (HMAC-SHA-256, 43 characters that suit an address)."""
    signed = hmac.digest(secret.encode(), "\n".join(parts).encode(), "sha256")
    return urlsafe_b64encode(signed).decode().rstrip("=")


def signed_by(secret: str, given: str, *parts: str) -> bool:
    """Whether a signature is the one of these texts."""
    return hmac.compare_digest(given.encode(), signature(secret, *parts).encode())
