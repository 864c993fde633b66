"""Rotations that points underwent come back, whatever the points are."""

import numpy as np
from scipy.spatial.transform import Rotation

from engine.geometry.nearest_rotations import nearest_rotations


def test_nearest_rotations_are_those_that_were_applied_and_never_mirror() -> None:
    random = np.random.default_rng(5)
    turns = Rotation.random(20, random_state=7).as_matrix()
    points = random.normal(0, 1, (20, 6, 3))
    spread = np.einsum("npi,npj->nij", points, np.einsum("nij,npj->npi", turns, points))
    np.testing.assert_allclose(nearest_rotations(spread), turns, atol=1e-10)
    mirrored = np.einsum("npi,npj->nij", points, points * [1, 1, -1])
    assert (np.linalg.det(nearest_rotations(mirrored)) > 0.99).all()
    np.testing.assert_allclose(nearest_rotations(np.zeros((1, 3, 3)))[0], np.eye(3), atol=1e-12)


def test_of_any_spread_no_rotation_brings_the_points_nearer() -> None:
    spread = np.random.default_rng(8).normal(0, 1, (200, 3, 3)) * np.geomspace(1e-9, 1e9, 200)[:, None, None]
    found = nearest_rotations(spread)
    np.testing.assert_allclose(found @ found.transpose(0, 2, 1), np.broadcast_to(np.eye(3), found.shape), atol=1e-12)
    singular, sign = np.linalg.svd(spread)[1], np.sign(np.linalg.det(spread))
    most = singular[:, 0] + singular[:, 1] + sign * singular[:, 2]  # Umeyama's bound of the trace of R S
    np.testing.assert_allclose(np.einsum("nij,nji->n", found, spread), most, rtol=1e-12)


def test_points_on_a_line_turn_no_further_than_it_does() -> None:
    turn = Rotation.from_rotvec([0, 0, 0.7])
    line = np.array([[1.0, 0, 0], [2, 0, 0], [-1.5, 0, 0]])
    found = nearest_rotations((line.T @ turn.apply(line))[None])[0]
    np.testing.assert_allclose(found, turn.as_matrix(), atol=1e-3)
