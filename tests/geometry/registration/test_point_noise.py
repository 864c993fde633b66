"""How noisy a cloud is, place by place."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from engine.geometry.registration.point_noise import CONTRADICTION_METRES, SURFACE_REACH_METRES, point_noise

SIDE = 41


def plane() -> tuple[NDArray[np.float64], NDArray[np.intp]]:
    """A square metre, facing up, of vertices 2.5 cm apart."""
    x, z = np.meshgrid(*[np.linspace(-0.5, 0.5, SIDE)] * 2, indexing="ij")
    at = np.arange(SIDE * SIDE).reshape(SIDE, SIDE)
    first, right, below, across = at[:-1, :-1].ravel(), at[:-1, 1:].ravel(), at[1:, :-1].ravel(), at[1:, 1:].ravel()
    triangles = np.concatenate([np.stack([first, right, below], 1), np.stack([right, across, below], 1)])
    return np.stack([x, np.zeros_like(x), z], -1).reshape(-1, 3), triangles


def test_what_scatters_is_told_from_what_does_not() -> None:
    vertices, triangles = plane()
    random = np.random.default_rng(1)
    points = random.uniform(-0.5, 0.5, (60000, 3))
    noise = np.where(points[:, 0] < 0, 0.001, 0.006)
    points[:, 1] = random.normal(0, noise)
    found = point_noise(vertices, triangles, points, np.tile([0.0, 1.0, 0.0], (len(points), 1)), 0.2)
    quiet, loud = (vertices[:, 0] < -0.1), (vertices[:, 0] > 0.1)
    assert np.abs(found[quiet] - 0.001).max() < 0.0002
    assert np.abs(found[loud] - 0.006).max() < 0.0012


def test_points_that_face_another_way_contradict_and_where_there_are_none_nothing_is_known() -> None:
    vertices, triangles = plane()
    points = np.random.default_rng(1).uniform(-0.5, 0, (20000, 3)) * [1, 0, 1]
    found = point_noise(vertices, triangles, points, np.tile([0.0, -1.0, 0.0], (len(points), 1)), 0.2)
    there = (vertices[:, [0, 2]] < -0.06).all(1)
    assert np.allclose(found[there], CONTRADICTION_METRES)
    assert np.allclose(found[(vertices[:, [0, 2]] > 0.06).any(1)], SURFACE_REACH_METRES)
