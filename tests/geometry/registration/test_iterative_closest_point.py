"""Points brought onto a surface."""

from __future__ import annotations

import numpy as np
import pytest
import trimesh
from scipy.spatial.transform import Rotation

from engine.geometry.registration.iterative_closest_point import rigid_onto_cloud, rigid_onto_surface
from engine.geometry.registration.rigid import Similarity


def test_a_known_motion_comes_back_although_a_tenth_is_astray() -> None:
    box = trimesh.creation.box((0.3, 0.2, 0.25)).subdivide().subdivide().subdivide()
    points = np.asarray(trimesh.sample.sample_surface(box, 1500, seed=1)[0])
    moved = Similarity(Rotation.from_rotvec([0.05, -0.08, 0.03]).as_matrix(), np.array([0.008, -0.01, 0.006]))
    away = moved.inverse()(points)
    away[::10] += 0.2
    found = rigid_onto_surface(away, box.vertices, box.faces, 0.03, 20)
    assert np.allclose(found.linear, moved.linear, atol=5e-4)
    assert np.allclose(found.shift, moved.shift, atol=1e-4)


def test_far_away_nothing_moves() -> None:
    ball = trimesh.creation.icosphere(1)
    found = rigid_onto_surface(np.full((9, 3), 50.0), ball.vertices, ball.faces, 0.1, 5)
    assert np.array_equal(found.linear, np.eye(3))
    assert not found.shift.any()


def test_points_come_onto_a_surface_of_which_points_are_known() -> None:
    ellipsoid = trimesh.creation.icosphere(5)
    ellipsoid.vertices *= [0.3, 0.9, 0.2]
    samples, faces = trimesh.sample.sample_surface(ellipsoid, 20_000, seed=1)
    normals = ellipsoid.face_normals[faces]
    turn = Rotation.from_rotvec([0.03, -0.02, 0.04]).as_matrix()
    away = Similarity(turn, np.array([0.01, -0.015, 0.008]))
    own = trimesh.sample.sample_surface(ellipsoid, 3000, seed=2)[0]
    part = own[own[:, 1] > -0.2]  # it may show less than there is
    found = rigid_onto_cloud(away(part), samples, normals, 0.05, 15)
    assert np.abs(found(away(part)) - part).max() < 0.002
    assert np.linalg.det(found.linear) == pytest.approx(1)
