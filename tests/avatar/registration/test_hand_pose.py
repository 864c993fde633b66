"""Hands as they were held: known wrists, fingers and sizes come back from landmarks in space."""

from __future__ import annotations

import numpy as np
from known_person import KnownPerson, sampled
from scipy.spatial.transform import Rotation

from engine.avatar.landmarks.spatial import SpatialLandmarks
from engine.avatar.registration.hand_pose import CoarseBody, with_hands
from engine.avatar.registration.models import HumanModels
from engine.body.fitting.articulated_hand import HAND_ANGLE_COUNT, TURNED_LANDMARKS, ArticulatedHand

WRIST = np.array([0.4, -0.3, 0.2])
SCALE = 0.8
SHIFT = np.array([0.012, -0.008, 0.01])


def held(models: HumanModels, person: KnownPerson, angles: np.ndarray) -> tuple[CoarseBody, np.ndarray]:
    """The body with its hands at rest, and the landmarks (21, 3) of its left hand as it is held."""
    body = with_hands(models, person.parameters, SpatialLandmarks({}))
    forearm, wrist = (models.space.names.index(name) for name in ("LeftForeArm", "LeftHand"))
    hand = ArticulatedHand(
        models.hands["Left"], person.parameters[-models.body.coefficients :], body.rotations[forearm]
    )
    places = hand.places(WRIST[None], angles[None])[0]
    return body, body.joints[wrist] + SHIFT + SCALE * places


def fist() -> np.ndarray:
    angles = np.zeros((1, HAND_ANGLE_COUNT))
    angles[0, :5] = [0.2, -0.1, 0.2, 0.3, 0.5]
    angles[0, 5:] = np.tile([0.05, 0.9, 1.2, 0.75], 4)
    return angles[0]


def test_a_small_hand_that_is_half_closed_is_held_so(models: HumanModels, person: KnownPerson) -> None:
    body, seen = held(models, person, fist())
    random = np.random.default_rng(3)
    hands = np.full((2, 21, 3), np.nan)
    hands[0] = seen + random.normal(0, 0.002, seen.shape)
    hands[0, [4, 9]] = np.nan
    hands[0, 13] += 0.2  # views agreed on something else
    found = with_hands(models, person.parameters, SpatialLandmarks({}, hands=hands))
    assert found.hands == ("Left",)
    turned = models.hands["Left"].joints[TURNED_LANDMARKS]
    at = [k for k in range(16) if TURNED_LANDMARKS[k] not in (4, 9, 13)]
    off = np.linalg.norm(found.joints[turned] - seen[TURNED_LANDMARKS], axis=1)[at]
    assert np.median(off) < 0.003 and off.max() < 0.008

    others = np.setdiff1d(np.arange(len(found.joints)), turned)
    np.testing.assert_array_equal(found.joints[others], body.joints[others])
    hand = np.isin(models.rig.bones[models.skin.vertices, 0], turned)
    right = models.rig.bones[models.skin.vertices, 0] == models.rig.index("RightHand")
    np.testing.assert_array_equal(found.vertices[right], body.vertices[right])
    size = [np.linalg.norm(np.ptp(one.vertices[hand], axis=0)) for one in (found, body)]
    assert size[0] < 0.85 * size[1]
    knuckle, last = (found.rotations[models.rig.index(f"LeftHandMiddle{k}")] for k in (1, 3))
    bend = Rotation.from_matrix(knuckle.T @ last).magnitude()
    assert 1.5 < bend < 2.3  # 1.2 and 0.75 of the two joints behind it


def test_a_few_landmarks_are_no_hand(models: HumanModels, person: KnownPerson) -> None:
    body, seen = held(models, person, np.zeros(HAND_ANGLE_COUNT))
    hands = np.full((2, 21, 3), np.nan)
    hands[0, [0, 4, 5, 8]] = seen[[0, 4, 5, 8]]
    found = with_hands(models, person.parameters, SpatialLandmarks({}, hands=hands))
    assert found.hands == ()
    np.testing.assert_array_equal(found.vertices, body.vertices)


def test_points_tell_how_a_hand_is_held_where_landmarks_are_off(models: HumanModels, person: KnownPerson) -> None:
    _, seen = held(models, person, fist())
    hands = np.full((2, 21, 3), np.nan)
    hands[0] = seen
    truth = with_hands(models, person.parameters, SpatialLandmarks({}, hands=hands)).vertices
    hand = models.skin.regions["whole_hands"] & (truth[:, 0] > 0)
    cloud = sampled(models, truth, 20000, 0.001, "hands")
    hands[0] += np.random.default_rng(5).normal(0, 0.006, seen.shape)
    off = []
    for points in (None, cloud):
        found = with_hands(models, person.parameters, SpatialLandmarks({}, hands=hands), points).vertices
        off.append(np.linalg.norm((found - truth)[hand], axis=1))
    assert off[1].mean() < 0.5 * off[0].mean() and off[1].mean() < 0.002
