"""Points moved away from a surface are laid on it again."""

import numpy as np
import pytest
from scipy.spatial import cKDTree
from scipy.spatial.transform import Rotation

from engine.geometry.registration.cloud_alignment import align_to_surface

RADII = np.array([0.3, 0.2, 0.1])


def ellipsoid(count: int, seed: int) -> tuple[np.ndarray, np.ndarray]:
    """Points of an ellipsoid about (0, 1, 0) and its normals there."""
    away = np.random.default_rng(seed).normal(size=(count, 3))
    away /= np.linalg.norm(away, axis=1, keepdims=True)
    normals = away / RADII
    return away * RADII + [0, 1, 0], normals / np.linalg.norm(normals, axis=1, keepdims=True)


@pytest.mark.parametrize("wrong", [0, 300])
def test_a_small_motion_is_taken_back_even_with_points_that_belong_elsewhere(wrong: int) -> None:
    surface, normals = ellipsoid(40000, 1)
    points, directions = ellipsoid(2000, 2)
    turn, shift = Rotation.from_rotvec([0.004, -0.006, 0.005]).as_matrix(), np.array([0.003, 0.004, -0.003])
    moved = (points - [0, 1, 0]) @ turn.T + [0, 1, 0] + shift
    moved[:wrong] += directions[:wrong] * 0.015
    motion = align_to_surface(moved, directions @ turn.T, cKDTree(surface), normals, 0.02)
    error = np.linalg.norm(motion(moved)[wrong:] - points[wrong:], axis=1)
    assert np.linalg.norm(moved[wrong:] - points[wrong:], axis=1).mean() > 0.005
    assert error.mean() < (0.0005 if wrong == 0 else 0.0015)


def test_what_is_too_far_away_is_left_where_it_is() -> None:
    surface, normals = ellipsoid(1000, 1)
    motion = align_to_surface(surface + np.array([1, 0, 0]), normals, cKDTree(surface), normals, 0.02)
    assert (motion.linear == np.eye(3)).all()
    assert (motion.shift == 0).all()


def test_what_the_points_do_not_determine_stays() -> None:
    rng = np.random.default_rng(4)
    plane = rng.uniform(-0.5, 0.5, (20000, 3)) * [1, 0, 1]
    up = np.tile([0.0, 1.0, 0.0], (20000, 1))
    motion = align_to_surface(plane[:500] + np.array([0, 0.004, 0]), up[:500], cKDTree(plane), up, 0.02)
    assert np.abs(motion.shift - [0, -0.004, 0]).max() < 1e-4
    assert np.abs(motion.linear - np.eye(3)).max() < 1e-3
