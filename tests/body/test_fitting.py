"""Bodies with known pose and shape come back: from exact landmarks, and from what perception sees in a render."""

from __future__ import annotations

import numpy as np
import pytest

from engine.body import load_template
from engine.body.body_space import load_body_space
from engine.body.first_guess import first_guess
from engine.body.fitting import (
    BEFORE,
    COEFFICIENTS,
    LIMBS,
    TURNED,
    Crossing,
    Seen,
    fit_body,
    forward,
    rotation_matrices,
)
from engine.body.landmarks import landmark_model
from engine.body.rig import HUMAN
from engine.body.template import load_rig

SPACE = load_body_space()
MARKS = landmark_model(load_template(), SPACE, load_rig(HUMAN))
FOCAL, CENTRE = 1400.0, (320.0, 400.0)


def somebody(seed: int) -> np.ndarray:
    """Parameters of somebody who stands, arms and head anywhere within reason."""
    random = np.random.default_rng(seed)
    turns = np.zeros((len(TURNED), 3))
    turns[0, 1] = random.uniform(-0.5, 0.5)
    for side, sign in (("Left", 1), ("Right", -1)):
        turns[TURNED.index(f"{side}Arm")] = [0, sign * random.uniform(-0.5, 0.2), -sign * random.uniform(-0.3, 1.2)]
        turns[TURNED.index(f"{side}ForeArm")] = [0, -sign * random.uniform(0, 1.2), 0]
        turns[TURNED.index(f"{side}UpLeg")] = [random.uniform(-0.3, 0.05), 0, sign * random.uniform(0, 0.2)]
        turns[TURNED.index(f"{side}Leg")] = [random.uniform(0, 0.4), 0, 0]
    turns[TURNED.index("Head")] = random.uniform(-0.2, 0.2, 3)
    return np.concatenate([[0.1, 0.0, -4.5], turns.ravel(), random.normal(0, 0.7, COEFFICIENTS)])


def test_exact_landmarks_give_the_joints_within_two_centimetres() -> None:
    """In the median over joints and people; seen from the root, since only it says how far away somebody is."""
    off = []
    for seed in range(12):
        joints, points = forward(SPACE, MARKS, somebody(seed))
        pixels = points[:, :2] * [FOCAL, -FOCAL] / -points[:, 2:] + CENTRE
        place = dict(zip(SPACE.names, joints, strict=True))
        limbs = np.stack([place[b] - place[a] for a, b in LIMBS])
        limbs /= np.linalg.norm(limbs, axis=1, keepdims=True)
        trust = np.ones(len(pixels), np.float32), np.ones(len(LIMBS), np.float32)
        seen = Seen(pixels.astype(np.float32), trust[0], limbs.astype(np.float32), trust[1], FOCAL, CENTRE, noise=0.002)
        fit = fit_body(SPACE, MARKS, seen, first_guess(SPACE, MARKS, seen, place))
        found, _ = forward(SPACE, MARKS, fit.parameters)
        turned = [SPACE.names.index(name) for name in TURNED]
        off.append(np.linalg.norm((found - found[0]) - (joints - joints[0]), axis=1)[turned])
        assert fit.reprojection < 0.01 * np.ptp(pixels[:, 1])
    assert np.median(off) < 0.02


def test_who_strides_towards_the_viewer_is_not_fitted_flat() -> None:
    """The feet's distance in depth, of somebody who walks at an ordinary pace and is seen as they are."""
    truth = np.zeros(len(somebody(0)))
    truth[:3] = [0.1, 0.0, -4.5]
    turns = truth[3:-COEFFICIENTS].reshape(-1, 3)
    for name, turn in {"LeftArm": (0, 0, -1.1), "RightArm": (0, 0, 1.1), "LeftUpLeg": (-0.4, 0, 0),
                       "LeftLeg": (0.15, 0, 0), "RightUpLeg": (0.15, 0, 0), "RightLeg": (0.3, 0, 0)}.items():  # fmt: skip
        turns[TURNED.index(name)] = turn
    joints, points = forward(SPACE, MARKS, truth)
    pixels = (points[:, :2] * [FOCAL, -FOCAL] / -points[:, 2:] + CENTRE).astype(np.float32)
    place = dict(zip(SPACE.names, joints, strict=True))
    limbs = np.stack([place[b] - place[a] for a, b in LIMBS]).astype(np.float32)
    limbs /= np.linalg.norm(limbs, axis=1, keepdims=True)
    seen = Seen(pixels, np.ones(len(pixels), np.float32), limbs, np.ones(len(LIMBS), np.float32), FOCAL, CENTRE)
    found, _ = forward(SPACE, MARKS, fit_body(SPACE, MARKS, seen, first_guess(SPACE, MARKS, seen, place)).parameters)
    feet = [SPACE.names.index(f"{side}Foot") for side in ("Left", "Right")]
    strides = [at[feet[0], 2] - at[feet[1], 2] for at in (joints, found)]
    assert strides[0] > 0.45
    assert abs(strides[1] / strides[0] - 1) < 0.15


@pytest.mark.parametrize("front", [0, 1])
def test_of_crossed_forearms_that_is_before_the_other_which_is_said_to_be(front: int) -> None:
    """From landmarks alone, which fit both."""
    truth = np.zeros(len(somebody(0)))
    truth[:3] = [0.1, 0.0, -4.5]
    turns = truth[3:-COEFFICIENTS].reshape(-1, 3)
    for side, sign in (("Left", 1), ("Right", -1)):
        turns[TURNED.index(f"{side}Arm")] = [0.6, 0, -1.25 * sign]
        turns[TURNED.index(f"{side}ForeArm")] = [0, -1.9 * sign, 0]
    joints, points = forward(SPACE, MARKS, truth)
    pixels = (points[:, :2] * [FOCAL, -FOCAL] / -points[:, 2:] + CENTRE).astype(np.float32)
    place = dict(zip(SPACE.names, joints, strict=True))
    limbs = np.stack([place[b] - place[a] for a, b in LIMBS]).astype(np.float32)
    limbs /= np.linalg.norm(limbs, axis=1, keepdims=True)
    trust = np.ones(len(pixels), np.float32), np.ones(len(LIMBS), np.float32)
    seen = Seen(pixels, trust[0], limbs, trust[1], FOCAL, CENTRE, crossing=Crossing(front, 0.5, 0.5))
    fit = fit_body(SPACE, MARKS, seen, first_guess(SPACE, MARKS, seen, place))
    found, _ = forward(SPACE, MARKS, fit.parameters)
    middle = [
        np.mean([found[SPACE.names.index(f"{side}{name}"), 2] for name in ("ForeArm", "Hand")])
        for side in ("Left", "Right")
    ]
    assert middle[front] - middle[1 - front] > BEFORE - 0.02
    assert fit.reprojection < 0.015 * np.ptp(pixels[:, 1])


def test_turns_are_rotations_and_small_ones_too() -> None:
    vectors = np.array([[0, 0, 0], [1e-10, 0, 0], [0, np.pi / 2, 0], [0.3, -0.2, 0.9]])
    matrices = rotation_matrices(vectors)
    np.testing.assert_allclose(
        matrices @ np.swapaxes(matrices, 1, 2), np.broadcast_to(np.eye(3), (4, 3, 3)), atol=1e-12
    )
    np.testing.assert_allclose(matrices[2] @ [1, 0, 0], [0, 0, -1], atol=1e-12)


def test_landmarks_are_where_they_should_be() -> None:
    place = dict(zip(MARKS.names, MARKS.mean, strict=True))
    assert place["LeftEye"][0] > 0 > place["RightEye"][0]
    assert place["Nose"][2] > place["LeftEye"][2] > place["LeftEar"][2]
    assert place["LeftFootIndex"][2] > place["LeftHeel"][2]
    assert place["LeftWrist"][0] > place["LeftElbow"][0] > place["LeftShoulder"][0] > 0
