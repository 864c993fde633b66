"""What a key may have at once: its own limits, then those of the settings."""

from __future__ import annotations

from pathlib import Path

import pytest

from service.auth.quotas import Limits
from service.settings import Settings
from service.tables.keys import LOCAL_KEY_ID, Key

FIELDS = ("requests_per_minute", "jobs_at_once", "uploads_at_once", "stored_mb")


@pytest.mark.parametrize(
    ("key", "expected"),
    [
        (Key(id="somebody"), (10, 2, 3, 40)),
        (Key(id="somebody", requests_per_minute=7, jobs_at_once=0, stored_mb=0), (7, 0, 3, 0)),
        (Key(id=LOCAL_KEY_ID), (None, None, None, None)),
        (Key(id=LOCAL_KEY_ID, jobs_at_once=5), (None, 5, None, None)),
    ],
)
def test_own_limits_go_before_those_of_the_settings_and_the_local_key_has_only_its_own(
    tmp_path: Path, key: Key, expected: tuple[int | None, ...]
) -> None:
    settings = Settings(data_dir=tmp_path, requests_per_minute=10, jobs_at_once=2, uploads_at_once=3, stored_mb=40)
    limits = Limits(key, settings)
    assert tuple(getattr(limits, name) for name in FIELDS) == expected
