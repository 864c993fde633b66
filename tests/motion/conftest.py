"""What the tests of motions share."""

from __future__ import annotations

import pytest
from humanoids import build_skeleton

from engine.geometry.rigging.skeleton import Skeleton


@pytest.fixture(scope="session")
def skeleton() -> Skeleton:
    return build_skeleton()
