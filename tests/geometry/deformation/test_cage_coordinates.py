"""Points that follow a surface around them."""

from __future__ import annotations

import numpy as np
import trimesh
from scipy.spatial.transform import Rotation

from engine.geometry.deformation.cage_coordinates import cage_coordinates


def test_points_are_means_of_the_cage_and_follow_it() -> None:
    cage = trimesh.creation.icosphere(2)
    vertices = np.asarray(cage.vertices) * [0.4, 1.0, 0.3]
    points = np.random.default_rng(1).uniform(-0.15, 0.15, (20, 3))
    weights = cage_coordinates(points, vertices, cage.faces)
    assert np.allclose(weights.sum(1), 1)
    assert np.allclose(weights @ vertices, points, atol=1e-9)
    bent = Rotation.from_rotvec([0.3, 1, -0.2]).as_matrix() @ np.diag([1.2, 0.8, 1.1])
    assert np.allclose(weights @ (vertices @ bent.T + 3), points @ bent.T + 3, atol=1e-9)


def test_on_the_surface_only_what_is_there_counts() -> None:
    cage = trimesh.creation.box()
    vertices, faces = np.asarray(cage.vertices), np.asarray(cage.faces)
    inside_first = vertices[faces[0]].mean(0)
    weights = cage_coordinates(np.stack([vertices[3], inside_first]), vertices, faces)
    assert np.allclose(weights[0], np.eye(8)[3])
    assert np.allclose(weights[1, faces[0]], 1 / 3)
