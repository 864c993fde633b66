"""Quaternions: known answers and inverses."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from engine.motion import rotation

RNG = np.random.default_rng(7)
SOME = rotation.normalize(RNG.normal(size=(40, 4)))
OTHERS = rotation.normalize(RNG.normal(size=(40, 4)))


def apart(first: np.ndarray, second: np.ndarray) -> float:
    return float(np.max(rotation.angle(rotation.multiply(rotation.inverse(first), second))))


def test_a_quarter_turn_about_y_brings_z_to_x() -> None:
    assert np.allclose(rotation.rotate(rotation.about("y", np.pi / 2), [0, 0, 1]), [1, 0, 0])


def test_products_rotations_and_matrices_agree_with_scipy() -> None:
    a, b = Rotation.from_quat(SOME), Rotation.from_quat(OTHERS)
    vectors = RNG.normal(size=(40, 3))
    assert apart(rotation.multiply(SOME, OTHERS), (a * b).as_quat()) < 1e-6
    assert np.allclose(rotation.rotate(SOME, vectors), a.apply(vectors))
    assert np.allclose(rotation.to_matrix(SOME), a.as_matrix())
    assert np.allclose(rotation.from_vector(a.as_rotvec()), a.as_quat() * np.sign(a.as_quat()[:, 3:]), atol=1e-9)


def test_what_is_taken_apart_is_put_together_again() -> None:
    assert apart(rotation.from_matrix(rotation.to_matrix(SOME)), SOME) < 1e-6
    assert apart(rotation.from_vector(rotation.to_vector(SOME)), SOME) < 1e-6
    assert apart(rotation.multiply(SOME, rotation.inverse(SOME)), rotation.identity(40)) < 1e-6


def test_half_turns_survive_the_way_through_matrices() -> None:
    turns = np.concatenate([np.eye(3), np.zeros((3, 1))], 1)
    assert apart(rotation.from_matrix(rotation.to_matrix(turns)), turns) < 1e-6


def test_between_is_the_shortest_turn_even_to_the_opposite_direction() -> None:
    start, end = RNG.normal(size=(2, 30, 3))
    turn = rotation.between(start, end)
    assert np.allclose(rotation.rotate(turn, rotation.normalize(start)), rotation.normalize(end))
    cosines = np.sum(rotation.normalize(start) * rotation.normalize(end), -1)
    assert np.allclose(rotation.angle(turn), np.arccos(cosines))
    assert np.allclose(rotation.rotate(rotation.between([1, 2, 3], [-1, -2, -3]), [1, 2, 3]), [-1, -2, -3])


@pytest.mark.parametrize("share", [0.0, 0.25, 1.0])
def test_slerp_goes_the_shorter_way_at_even_speed(share: float) -> None:
    between = rotation.slerp(SOME, -OTHERS, np.full(40, share))
    whole = rotation.angle(rotation.multiply(rotation.inverse(SOME), OTHERS))
    assert np.allclose(rotation.angle(rotation.multiply(rotation.inverse(SOME), between)), share * whole, atol=1e-6)


def test_the_mean_of_turns_about_one_axis_is_the_mean_angle_whatever_their_signs() -> None:
    turns = rotation.about("z", np.radians([10.0, 20.0, 60.0])) * np.array([[1.0], [-1.0], [1.0]])
    assert np.degrees(apart(rotation.mean(turns), rotation.about("z", np.radians(30.0)))) < 0.7


def test_a_mirrored_turn_moves_mirrored_vectors() -> None:
    mirror = np.array([-1, 1, 1])
    vectors = RNG.normal(size=(40, 3))
    mirrored = rotation.rotate(rotation.mirrored(SOME), vectors * mirror)
    assert np.allclose(mirrored, rotation.rotate(SOME, vectors) * mirror)
