"""A signed link opens one artifact, for at least the time that the settings say."""

from __future__ import annotations

import time
from urllib.parse import parse_qs, unquote, urlsplit

from service.job_records.signed_links import Signer, is_valid
from service.tables.keys import Key
from service.vault import Secret

KEY = Key(id="mine", link_secret=Secret("secret"))


def signed(name: str, seconds: float = 3600) -> tuple[str, str, str]:
    """The path of a link, when it ends, and its signature."""
    link = urlsplit(Signer("secret", seconds).link("job", name))
    asked = parse_qs(link.query)
    return unquote(link.path), asked["expires"][0], asked["signature"][0]


def test_a_link_is_good_for_its_artifact_alone() -> None:
    path, expires, signature = signed("a b.png")
    assert path == "/v1/jobs/job/artifacts/a b.png"
    assert is_valid(KEY, "job", "a b.png", expires, signature)
    for key, job, name, end in (
        (KEY, "other", "a b.png", expires),
        (KEY, "job", "b.png", expires),
        (KEY, "job", "a b.png", str(int(expires) + 1)),
        (Key(id="mine", link_secret=Secret("renewed")), "job", "a b.png", expires),
    ):
        assert not is_valid(key, job, name, end, signature)


def test_it_lasts_as_long_as_is_said_and_half_as_long_again_at_most() -> None:
    for seconds in (1.0, 60.0, 3600.0):
        before = time.time()
        _, expires, _ = signed("a.png", seconds)
        step = max(1, round(seconds / 2))
        assert before + seconds <= int(expires) <= time.time() + seconds + step
        assert int(expires) % step == 0, "the same address for a while"


def test_what_has_ended_or_is_no_moment_opens_nothing() -> None:
    _, past, signature = signed("a.png", -100)
    assert int(past) < time.time() and not is_valid(KEY, "job", "a.png", past, signature)
    for expires in ("", "soon", "-1", "9" * 20, "\u0661"):
        assert not is_valid(KEY, "job", "a.png", expires, signature)
