"""What the joints say of the mask and of depth: hands belong to the person, arms before the trunk are before it."""

from __future__ import annotations

import numpy as np
import pytest

from engine.body.parts import BODY_PARTS
from engine.character.figure.figure import Figure
from engine.character.figure.silhouette import (
    FOREARM_WIDTH_SHARE,
    HAND_REACH_SHARE,
    MAX_HAND_DISTANCE_SHARE,
    seen_limbs,
)
from engine.character.fit.template_fit import ARM_FORWARD_METRES, arms_before_the_trunk
from engine.character.stages import hand_labels
from engine.perception.masks.person import DOUBTFUL_BELIEF, LIKELY_BELIEF
from engine.perception.pose.body import BODY_LANDMARKS

TRUNK = {"LeftShoulder": (120, 50), "RightShoulder": (80, 50), "RightHip": (85, 120), "LeftHip": (115, 120)}


def figure(places: dict[str, tuple[float, float]], confidence: float, world_z: float = 0.0) -> Figure:
    points, sure = np.zeros((len(BODY_LANDMARKS), 2), np.float32), np.zeros(len(BODY_LANDMARKS), np.float32)
    world = np.zeros((len(BODY_LANDMARKS), 3), np.float32)
    for name, place in (TRUNK | places).items():
        points[BODY_LANDMARKS.index(name)], sure[BODY_LANDMARKS.index(name)] = place, confidence
    world[[BODY_LANDMARKS.index(name) for name in places], 2] = world_z
    none = np.zeros((240, 200), np.bool_)
    return Figure(np.zeros((240, 200, 3), np.uint8), None, points, sure, world, True, (200, 240),
                  np.zeros((1, 4), np.float32), 0, none, None, (None, None))  # fmt: skip


HAND = {"LeftWrist": (150, 120), "LeftIndex": (150, 140), "LeftPinky": (154, 140)}


def test_the_middle_of_a_hand_is_the_persons_and_no_finger_beyond_it() -> None:
    seed = seen_limbs(figure(HAND, 0.95)) == np.float32(LIKELY_BELIEF)
    for x, y in ((150, 121), (151, 130), (152, 139)):
        assert seed[y, x]
    assert not seed[150:].any() and not seed[:110].any()
    rows, columns = np.nonzero(seed)
    assert np.ptp(columns) <= 8, "as narrow as a palm"
    assert np.ptp(rows) >= 19


def test_a_hand_that_is_not_surely_seen_says_nothing() -> None:
    assert not seen_limbs(figure(HAND, 0.6)).any()
    assert not seen_limbs(figure({"LeftWrist": (150, 120)}, 0.95)).any(), "a wrist without fingers"


def test_around_a_hand_colours_are_asked() -> None:
    seed = seen_limbs(figure(HAND, 0.95))
    sure, doubtful = seed == np.float32(LIKELY_BELIEF), seed == np.float32(DOUBTFUL_BELIEF)
    assert (sure | doubtful | (seed == 0)).all()
    reach = max(1, round(HAND_REACH_SHARE * 90))  # from the shoulders to the fingers
    rows, columns = np.nonzero(sure)
    assert doubtful[rows.max() + reach, columns].any() and not doubtful[rows.max() + reach + 1].any()


def test_a_hand_that_is_not_seen_closely_may_be_as_far_from_the_elbow_as_an_arm_is_long() -> None:
    places = {"LeftElbow": (120.0, 80.0), "LeftWrist": (128.0, 80.0)}
    end = 120 + MAX_HAND_DISTANCE_SHARE * 70  # from the shoulders to the hips
    doubtful = seen_limbs(figure(places, 0.95))[80] == np.float32(DOUBTFUL_BELIEF)
    assert doubtful[135 : int(end)].all()
    assert not doubtful[int(end) + 2 + round((HAND_REACH_SHARE + FOREARM_WIDTH_SHARE) * 70) :].any()


def test_a_forearm_between_joints_that_are_seen_is_the_persons() -> None:
    seed = seen_limbs(figure({"LeftElbow": (150, 80), "LeftWrist": (180, 110)}, 0.95)) == np.float32(LIKELY_BELIEF)
    for x, y in ((151, 81), (165, 95), (179, 109)):
        assert seed[y, x]


def test_a_hand_that_is_seen_is_the_arms_and_the_other_says_nothing() -> None:
    hand = np.zeros((21, 3), np.float32)
    hand[:, :2] = [20, 30]
    hand[5, :2], hand[17, :2], hand[12, :2] = (10, 50), (30, 50), (20, 70)
    doubled = np.array([[2.0, 0, 5], [0, 2, 1]])
    labels = hand_labels((None, hand), doubled, (200, 120))
    assert set(np.unique(labels)) == {-1, BODY_PARTS.index("right_arm")}
    for x, y in ((20, 30), (20, 45), (20, 65), (12, 50)):
        assert labels[2 * y + 1, 2 * x + 5] == BODY_PARTS.index("right_arm")
    assert labels[2 * 65 + 1, 2 * 28 + 5] == -1, "beside the tip"
    assert (labels >= 0).sum() == pytest.approx(4 * (20 * 20 / 2 + 20 * 20 / 2), rel=0.1), "the area of its hull"


@pytest.mark.parametrize(
    ("place", "confidence", "expected"),
    [((100, 90), 0.9, ARM_FORWARD_METRES), ((150, 90), 0.9, -0.1), ((100, 90), 0.3, -0.1)],
    ids=["before the trunk", "beside it", "hidden"],
)
def test_an_arm_seen_before_the_trunk_is_before_it(place: tuple[int, int], confidence: float, expected: float) -> None:
    wrist = figure({"LeftWrist": place}, confidence, -0.1)
    found = arms_before_the_trunk(wrist)
    assert found[BODY_LANDMARKS.index("LeftWrist"), 2] == pytest.approx(expected)
    others = [
        k for k, name in enumerate(BODY_LANDMARKS) if name not in ("LeftWrist", "RightWrist", "LeftElbow", "RightElbow")
    ]
    np.testing.assert_array_equal(found[others], wrist.world[others])


def test_an_arm_already_further_forward_stays() -> None:
    found = arms_before_the_trunk(figure({"LeftWrist": (100, 90)}, 0.9, 0.45))
    assert found[BODY_LANDMARKS.index("LeftWrist"), 2] == pytest.approx(0.45)
