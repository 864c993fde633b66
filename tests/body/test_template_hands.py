"""Hands: landmarks where they belong, fingers that bend to the palm, and known turns that come back from landmarks."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from engine.body import Template
from engine.body.body_space import BodySpace, load_body_space
from engine.body.fitting.hand_fitting import HandAnchor, HandFit, fit_hand, hand_length
from engine.body.hands import HandModel, finger_landmarks, hand_model
from engine.body.rig import HUMAN_RIG
from engine.body.template import load_rig
from engine.geometry.camera import Camera
from engine.geometry.rigging.joint_names import FINGER_NAMES
from engine.geometry.rigging.skinning import bone_transforms
from engine.perception.pose.hands import HAND_JOINTS

FOCAL, CENTRE, WRIST = 2000.0, (500.0, 500.0), np.array([0.4, 0.1, -3.5])
CAMERA = Camera((0, 0, 0), FOCAL, CENTRE, (1000, 1000))
BODY = np.zeros(4)


@pytest.fixture(scope="module")
def space() -> BodySpace:
    return load_body_space()


@pytest.fixture(scope="module", params=["Left", "Right"])
def model(request: pytest.FixtureRequest, space: BodySpace, template: Template) -> HandModel:
    return hand_model(template, space, load_rig(HUMAN_RIG), request.param)


def bent(model: HandModel, space: BodySpace, turns: dict[str, Rotation], arm: np.ndarray) -> np.ndarray:
    """The landmarks (21, 3), metres around the wrist, of a hand whose joints are turned, on a forearm with these axes."""
    rig = load_rig(HUMAN_RIG)
    own = np.tile(np.eye(3), (len(rig.names), 1, 1))
    for name, turn in turns.items():
        own[space.names.index(f"{model.side}Hand{name}")] = turn.as_matrix()
    transforms = bone_transforms(rig.parents, space.joint_mean, own)[model.joints]
    places = np.einsum("nij,nj->ni", transforms[:, :3, :3], model.mean) + transforms[:, :3, 3]
    return (places - places[0]) @ arm.T


def seen(places: np.ndarray) -> np.ndarray:
    """What perception would say of landmarks around the wrist: pixels, and pixels towards the viewer."""
    at = WRIST + places
    pixels = at[:, :2] * [FOCAL, -FOCAL] / -at[:, 2:] + CENTRE
    return np.column_stack([pixels, places[:, 2] * FOCAL / -WRIST[2]])


def refit(model: HandModel, arm: np.ndarray, marks: np.ndarray) -> HandFit:
    return fit_hand(model, BODY, HandAnchor(arm, WRIST, np.eye(3), CAMERA), marks)


def test_fingers_lie_beside_each_other_and_end_in_their_tips(model: HandModel) -> None:
    sign = 1 if model.side == "Left" else -1
    for finger in FINGER_NAMES:
        out = sign * model.mean[finger_landmarks(finger), 0]
        assert (np.diff(out) > 0.01).all()
        assert (
            np.linalg.norm(np.diff(model.mean[finger_landmarks(finger)], axis=0), axis=1)[2] > 0.012
        )  # the tip is not the joint
    knuckles = model.mean[[HAND_JOINTS.index(f"{finger}1") for finger in FINGER_NAMES[1:]], 2]
    assert (np.diff(knuckles) < 0).all(), "from the index, in front, to the little finger"


def test_both_hands_are_each_others_mirror_images(space: BodySpace, template: Template) -> None:
    left, right = (hand_model(template, space, load_rig(HUMAN_RIG), side) for side in ("Left", "Right"))
    np.testing.assert_allclose((left.mean - left.mean[0]) * [-1, 1, 1], right.mean - right.mean[0], atol=0.003)
    np.testing.assert_allclose(
        left.bend * [1, -1, -1], right.bend, atol=0.03
    )  # axes of turns are mirrored the other way


def test_bent_fingers_make_a_fist(model: HandModel, space: BodySpace) -> None:
    """Tips come to the palm: below the hand, whose palm looks down in T-pose, and nearer to the wrist."""
    turns = {
        f"{finger}{k}": Rotation.from_rotvec(0.8 * axis)
        for finger, axis in zip(FINGER_NAMES[1:], model.bend[1:], strict=True)
        for k in (1, 2, 3)
    }
    flat, fist = bent(model, space, {}, np.eye(3)), bent(model, space, turns, np.eye(3))
    tips = [finger_landmarks(finger)[3] for finger in FINGER_NAMES[1:]]
    knuckles = [finger_landmarks(finger)[0] for finger in FINGER_NAMES[1:]]
    assert (fist[tips, 1] < fist[knuckles, 1] - 0.01).all()
    assert (np.linalg.norm(fist[tips], axis=1) < 0.75 * np.linalg.norm(flat[tips], axis=1)).all()
    thumb = finger_landmarks("Thumb")[3]
    bends = {f"Thumb{k}": Rotation.from_rotvec(0.6 * model.bend[0]) for k in (2, 3)}
    across = bent(model, space, bends, np.eye(3))[thumb], flat[thumb]
    little = flat[finger_landmarks("Pinky")[0]]
    assert np.linalg.norm(across[0] - little) < np.linalg.norm(across[1] - little)


@pytest.mark.parametrize("seed", range(4))
def test_known_turns_come_back(model: HandModel, space: BodySpace, seed: int) -> None:
    """Seen from the wrist: joints within five millimetres in the median, and none a centimetre away."""
    random = np.random.default_rng(seed)
    turns = {"": Rotation.from_rotvec(random.uniform(-0.4, 0.4, 3))}
    for finger, axis in zip(FINGER_NAMES, model.bend, strict=True):
        curl = random.uniform(0, 0.9)
        spread = Rotation.from_rotvec(random.uniform(-0.1, 0.1) * model.spread)
        turns[f"{finger}1"] = spread * Rotation.from_rotvec((0.2 if finger == "Thumb" else curl) * axis)
        turns[f"{finger}2"] = Rotation.from_rotvec(curl * axis)
        turns[f"{finger}3"] = Rotation.from_rotvec(0.6 * curl * axis)
    arm = Rotation.from_euler("xyz", [random.uniform(-0.6, 0.6), random.uniform(-0.5, 0.5), random.uniform(-1, 0.5)])
    truth = bent(model, space, turns, arm.as_matrix())
    fit = refit(model, arm.as_matrix(), seen(truth))
    turned = [0, *(mark for finger in FINGER_NAMES for mark in finger_landmarks(finger)[:3])]
    found = {HAND_JOINTS[mark]: Rotation.from_matrix(r) for mark, r in zip(turned, fit.rotations, strict=True)}
    away = np.linalg.norm(bent(model, space, found, arm.as_matrix()) - truth, axis=1)
    assert np.median(away[1:]) < 0.005
    assert away.max() < 0.01
    assert fit.median_error < 0.01
    assert abs(fit.scale - 1) < 0.05


def test_a_hand_elsewhere_and_larger_is_said_to_be(model: HandModel, space: BodySpace) -> None:
    marks = seen(bent(model, space, {}, np.eye(3)))
    moved = marks.copy()
    moved[:, :2] = (marks[:, :2] - marks[0, :2]) * 1.2 + marks[0, :2] + [6, -4]
    moved[:, 2] *= 1.2
    fit = refit(model, np.eye(3), moved)
    np.testing.assert_allclose(fit.shift, [6, -4], atol=0.1 * hand_length(marks))
    assert 1.1 < fit.scale < 1.25
    assert fit.median_error < 0.02


def test_what_is_no_hand_fits_badly(model: HandModel) -> None:
    noise = np.random.default_rng(3).uniform(-50, 50, (21, 3)) + np.array([700, 450, 0])
    assert refit(model, np.eye(3), noise).median_error > 0.08
