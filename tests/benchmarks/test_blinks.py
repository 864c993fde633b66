"""What the benchmark of lag says of blinks."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from benchmarks.portrait_figures.steadiness import blinks
from engine.perception.face.landmarks import MESH_SIZE

UPPER, LOWER = (159, 158, 160, 386, 385, 387), (145, 153, 144, 374, 380, 373)
CORNERS = {33: 0.0, 133: 100.0, 263: 200.0, 362: 100.0}


def looking(openings: list[float]) -> NDArray[np.float32]:
    """Meshes (N, 478, 3) whose eyes are as far open."""
    meshes = np.zeros((len(openings), MESH_SIZE, 3), np.float32)
    for corner, x in CORNERS.items():
        meshes[:, corner, 0] = x
    meshes[:, list(UPPER), 1] = -100 * np.array(openings)[:, None]
    return meshes


def test_a_blink_that_stays_half_open_from_eyes_less_open() -> None:
    """0.4 to 0.1 is a depth of 0.3: from 0.34 to 0.16 the lid goes 0.18 of it, and shuts by 0.24."""
    driver = looking([0.4] * 15 + [0.1] + [0.4] * 8)
    result = looking([0.34] * 15 + [0.34, 0.16] + [0.34] * 7)
    (found,) = blinks(driver, result)
    assert found == pytest.approx((0.6, 0.8), abs=1e-5)


def test_eyes_that_narrow_a_little_do_not_blink() -> None:
    driver = looking([0.4] * 15 + [0.3] + [0.4] * 8)
    assert blinks(driver, driver) == []
