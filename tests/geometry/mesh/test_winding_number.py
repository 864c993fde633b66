"""Inside or outside."""

from __future__ import annotations

import numpy as np
import trimesh

from engine.geometry.mesh.winding_number import winding_numbers


def test_inside_is_one_and_outside_zero() -> None:
    ball = trimesh.creation.icosphere(2)
    points = np.array([[0.0, 0, 0], [0.5, 0.5, 0.5], [2, 0, 0], [0, -1.2, 0]])
    assert np.allclose(winding_numbers(points, ball.vertices, ball.faces), [1, 1, 0, 0], atol=1e-9)


def test_half_a_cube_winds_half_about_its_middle() -> None:
    box = trimesh.creation.box()
    upper = np.asarray(box.triangles_center)[:, 2] > 0.49
    sides = np.abs(np.asarray(box.triangles_center)[:, 2]) < 0.49
    assert np.isclose(winding_numbers(np.zeros((1, 3)), box.vertices, box.faces[upper])[0], 1 / 6)
    assert np.isclose(winding_numbers(np.zeros((1, 3)), box.vertices, box.faces[sides])[0], 4 / 6)
