"""Bumps of surfaces one can write down."""

import numpy as np

from engine.render.lighting.bump import bump


def test_a_ramp_tilts_the_normal_by_its_slope() -> None:
    """Height rising by 0.1 for each metre of u on a chart that is stretched fourfold: a slope of 0.025."""
    normals = np.array([[0.0, 0.0, 1.0]])
    tangents = np.array([[4.0, 0, 0, 0, 1, 0]])
    found = bump(normals, tangents, np.array([[0.1, 0.0]]))
    expected = np.array([-0.025, 0, 1]) / np.hypot(0.025, 1)
    np.testing.assert_allclose(found[0], expected, atol=1e-6)


def test_a_mirrored_chart_gives_the_same_relief() -> None:
    normals = np.array([[0.0, 0.0, 1.0]])
    found = bump(normals, np.array([[-4.0, 0, 0, 0, 1, 0]]), np.array([[-0.1, 0.0]]))
    np.testing.assert_allclose(found[0, 0], -0.025 / np.hypot(0.025, 1), atol=1e-6)
