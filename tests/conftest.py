"""What every test may ask for: real media, kept outside the project."""

from __future__ import annotations

import os
import signal
from collections.abc import Callable
from pathlib import Path

import pytest

ROOT = Path(__file__).parent.parent

signal.signal(signal.SIGINT, signal.default_int_handler)  # run in the background, it would be ignored in every child


@pytest.fixture(scope="session")
def media() -> Callable[[str], Path]:
    """`media("portraits/photo_woman_white.png")` is that file of the shared test media.

    Skips where the media are absent (a user's machine); fails where they must be there (`CI=true`).
    """
    folder = Path(os.environ.get("GALATEA_TEST_DATA", ROOT.parent / "shared" / "data"))

    def find(name: str) -> Path:
        path = folder / name
        if not path.exists():
            message = f"test media not found: {path} (set GALATEA_TEST_DATA to the folder that holds them)"
            if os.environ.get("CI") == "true":
                pytest.fail(message)
            pytest.skip(message)
        return path

    return find
