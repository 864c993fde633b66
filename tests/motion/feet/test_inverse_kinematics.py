"""Limbs of two bones: they reach, keep their lengths and their plane."""

from __future__ import annotations

import numpy as np

from engine.motion import rotation
from engine.motion.feet.inverse_kinematics import two_bones

RNG = np.random.default_rng(3)
UPPER, LOWER = np.array([0.02, -0.42, 0.01]), np.array([0.0, -0.4, -0.02])
HINGE = (1.0, 0.0, 0.0)


def bent_legs(count: int, least: float = 0.2) -> tuple[np.ndarray, ...]:
    upper = rotation.normalize(RNG.normal(size=(count, 4)))
    lower = rotation.multiply(upper, rotation.about("x", RNG.uniform(least, 2.0, count)))
    hip = RNG.normal(size=(count, 3))
    knee = hip + rotation.rotate(upper, UPPER)
    return upper, lower, hip, knee, knee + rotation.rotate(lower, LOWER)


def follow(hip: np.ndarray, upper: np.ndarray, lower: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    knee = hip + rotation.rotate(upper, UPPER)
    return knee, knee + rotation.rotate(lower, LOWER)


def test_the_limb_reaches_its_target_with_its_own_bones() -> None:
    upper, lower, hip, knee, ankle = bent_legs(200)
    direction = rotation.normalize(RNG.normal(size=(200, 3)))
    target = hip + direction * RNG.uniform(0.1, 0.8, (200, 1))
    new_upper, new_lower, end = two_bones((hip, knee, ankle), (upper, lower), target, HINGE)
    assert np.allclose(end, target, atol=1e-9)
    assert np.allclose(follow(hip, new_upper, new_lower)[1], target, atol=1e-6)


def test_a_limb_that_is_there_already_stays_as_it_is() -> None:
    upper, lower, hip, knee, ankle = bent_legs(100)
    new_upper, new_lower, _ = two_bones((hip, knee, ankle), (upper, lower), ankle, HINGE)
    turned = rotation.angle(rotation.multiply(rotation.inverse(upper), new_upper))
    assert np.degrees(turned.max()) < 0.01
    assert np.degrees(rotation.angle(rotation.multiply(rotation.inverse(lower), new_lower)).max()) < 0.01


def test_the_knee_stays_in_the_plane_of_the_leg() -> None:
    """A target in the leg's own plane, on the same side: the new knee is in that plane too."""
    upper, lower, hip, knee, ankle = bent_legs(100)
    normal = rotation.normalize(np.cross(knee - hip, ankle - knee))
    target = hip + (ankle - hip) * 0.8
    knee_after, _ = follow(hip, *two_bones((hip, knee, ankle), (upper, lower), target, HINGE)[:2])
    assert np.abs(np.sum((knee_after - hip) * normal, -1)).max() < 1e-6


def test_a_straight_limb_bends_about_its_hinge_and_the_right_way() -> None:
    hip, knee, ankle = np.zeros(3), np.array([0, -0.4, 0.0]), np.array([0, -0.8, 0.0])
    still = rotation.identity()
    upper, lower, end = two_bones((hip, knee, ankle), (still, still), np.array([0, -0.6, 0.0]), HINGE)
    assert np.allclose(end, [0, -0.6, 0])
    new_knee = rotation.rotate(upper, knee)
    assert np.allclose(new_knee, [0, -0.3, np.sqrt(0.4**2 - 0.3**2)])  # forward, as knees do
    assert np.allclose(new_knee + rotation.rotate(lower, ankle - knee), end)


def test_a_target_out_of_reach_is_approached() -> None:
    hip, knee, ankle = np.zeros(3), np.array([0, -0.4, 0.05]), np.array([0, -0.8, 0.0])
    still = rotation.identity()
    _, _, end = two_bones((hip, knee, ankle), (still, still), np.array([3.0, 0, 0]), HINGE)
    length = 2 * np.hypot(0.4, 0.05)
    assert np.allclose(end, [length * 0.9995, 0, 0])
