"""Laplacians of edges."""

from __future__ import annotations

import numpy as np
import trimesh
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from engine.geometry.deformation.hinge_laplacian import HingeLaplacian


def icosphere(subdivisions: int) -> tuple[NDArray[np.float64], NDArray[np.int32]]:
    mesh = trimesh.creation.icosphere(subdivisions)
    return np.asarray(mesh.vertices, np.float64), np.asarray(mesh.faces, np.int32)


def test_flat_hinges_have_none() -> None:
    flat = np.array([[0.0, 0, 0], [1, 0, 0], [0.3, 0.8, 0], [0.6, -0.7, 0]])
    hinges = HingeLaplacian(flat, np.array([[0, 1, 2], [1, 0, 3]]))
    assert len(hinges.hinges) == 1
    assert np.allclose(hinges.operator @ flat, 0)


def test_a_bent_hinge_by_hand() -> None:
    """Two right isosceles triangles on one diagonal, folded by a right angle: at its ends, cotangents of 45 degrees."""
    folded = np.array([[0.0, 0, 0], [2, 0, 0], [1, 1, 0], [1, 0, 1]])
    hinges = HingeLaplacian(folded, np.array([[0, 1, 2], [1, 0, 3]]))
    assert np.allclose(hinges.areas, 2 / 3)
    # (2 * start + 2 * end - 2 * here - 2 * there) / area
    assert np.allclose(hinges.operator @ folded, [[0, -3, -3]])


def test_hinges_turn_with_the_surface() -> None:
    vertices, triangles = icosphere(2)
    hinges = HingeLaplacian(vertices, triangles)
    turn = Rotation.from_rotvec([0.4, -1.1, 0.7]).as_matrix()
    moved = vertices @ turn.T + [1, 2, 3]
    rotations = hinges.rotations(moved)
    assert np.allclose(rotations, turn, atol=1e-5)
    assert np.allclose(hinges.turned(rotations), hinges.operator @ moved, atol=1e-4)


def test_closed_surfaces_have_a_hinge_at_each_edge() -> None:
    vertices, triangles = icosphere(1)
    hinges = HingeLaplacian(vertices, triangles)
    assert len(hinges.hinges) == 3 * len(triangles) // 2
    assert np.allclose(hinges.operator @ np.ones(len(vertices)), 0, atol=1e-9)
