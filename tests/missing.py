"""What tests need, and a machine lacks."""

from __future__ import annotations

import os
from typing import NoReturn

import pytest


def missing(message: str) -> NoReturn:
    """End the test: it is skipped, with a word; where everything must be there (`CI=true`) it fails."""
    if os.environ.get("CI") == "true":
        pytest.fail(message)
    pytest.skip(message)
