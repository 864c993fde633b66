"""Where a far camera stands, of cameras that are known."""

from __future__ import annotations

import numpy as np
from scipy.spatial.transform import Rotation

from engine.geometry.registration.scaled_orthographic import scaled_orthographic


def test_cameras_come_back_from_what_they_show() -> None:
    random = np.random.default_rng(0)
    points = random.normal(size=(30, 3))
    scales, shifts = random.uniform(0.5, 90, 4), random.normal(size=(4, 2)) * 100
    cameras = scales[:, None, None] * Rotation.random(4, rng=1).as_matrix()[:, :2]
    found, moved = scaled_orthographic(points, np.einsum("nij,vj->nvi", cameras, points) + shifts[:, None])
    np.testing.assert_allclose(found, cameras, atol=1e-9)
    np.testing.assert_allclose(moved, shifts, atol=1e-9)


def test_rows_are_at_right_angles_and_alike_whatever_is_seen() -> None:
    random = np.random.default_rng(2)
    found, _ = scaled_orthographic(random.normal(size=(20, 3)), random.normal(size=(20, 2)))
    np.testing.assert_allclose(found @ found.T, found[0] @ found[0] * np.eye(2), atol=1e-12)
