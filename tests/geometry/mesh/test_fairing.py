"""Fairing takes ripples and leaves the shape."""

import numpy as np

from engine.geometry.mesh.fairing import fair
from engine.geometry.mesh.iso_surface import iso_surface


def test_a_rippled_ball_becomes_smooth_and_keeps_its_size() -> None:
    axis = np.arange(-12, 13)
    field = 9.0 - np.sqrt(sum(np.square(np.meshgrid(axis, axis, axis, indexing="ij")).astype(float)))
    vertices, triangles = iso_surface(field, (-12, -12, -12), 1.0)
    random = np.random.default_rng(0)
    rough = vertices * (1 + random.normal(0, 0.02, (len(vertices), 1)))
    smooth = fair(rough, triangles, 20)
    before, after = (np.linalg.norm(places, axis=1) for places in (rough, smooth))
    assert after.std() < 0.4 * before.std()
    assert abs(after.mean() - 9.0) < 0.05
