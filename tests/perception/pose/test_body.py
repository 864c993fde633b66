"""Body poses on pictures in which one can see where the joints are."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import cv2
import numpy as np
import pytest

from engine.perception.pose.body import BODY_LANDMARKS, MIXAMO_JOINTS, Body, BodyTracker, find_body

Media = Callable[[str], Path]


SEEN = {
    "Head": (490, 185),
    "LeftArm": (590, 312),
    "RightArm": (405, 312),
    "LeftForeArm": (618, 450),
    "LeftHand": (620, 562),
    "RightHand": (378, 565),
    "LeftLeg": (562, 760),
    "RightLeg": (455, 765),
    "LeftFoot": (570, 912),
    "RightFoot": (450, 912),
}
"""Pixels of `man_spotlight_001.jpg`."""


def read(path: Path) -> np.ndarray:
    return cv2.imread(str(path))[..., ::-1].copy()


@pytest.fixture(scope="module")
def standing(media: Media) -> tuple[np.ndarray, Body]:
    picture = read(media("fullbody/man_spotlight_001.jpg"))
    body = find_body(picture)
    assert body is not None
    return picture, body


def test_joints_are_where_they_were_seen_by_eye(standing: tuple[np.ndarray, Body]) -> None:
    """1024 px; marked by hand on an enlarged picture with a grid."""
    _, body = standing
    for name, seen in SEEN.items():
        assert np.linalg.norm(body.joint(name)[0] - seen) < 25, name
    assert body.confidence.min() > 0.5


def test_the_persons_left_is_on_the_right_of_the_picture(standing: tuple[np.ndarray, Body]) -> None:
    _, body = standing
    for joint in ("Arm", "ForeArm", "Hand", "UpLeg", "Leg", "Foot"):
        left, right = body.joint(f"Left{joint}"), body.joint(f"Right{joint}")
        assert left[0][0] > right[0][0]
        assert left[1][0] > right[1][0]


def test_world_is_upright_in_metres_and_faces_the_viewer(standing: tuple[np.ndarray, Body]) -> None:
    _, body = standing
    head, hips, foot = (body.joint(name)[1] for name in ("Head", "Hips", "LeftFoot"))
    assert head[1] > 0.4 > hips[1] > foot[1]
    assert 1.2 < head[1] - foot[1] < 1.9
    np.testing.assert_allclose(hips, 0, atol=0.02)
    nose, ears = body.world[BODY_LANDMARKS.index("Nose")], body.joint("Head")[1]
    assert nose[2] > ears[2]
    assert body.joint("LeftToeBase")[1][2] > foot[2]


def test_mirrored_picture_mirrors_the_body(standing: tuple[np.ndarray, Body]) -> None:
    picture, body = standing
    mirrored = find_body(np.ascontiguousarray(picture[:, ::-1]))
    assert mirrored is not None
    for name in MIXAMO_JOINTS:
        other = name.replace("Left", "?").replace("Right", "Left").replace("?", "Right")
        x, y = mirrored.joint(other)[0]
        expected = body.joint(name)[0]
        assert np.hypot(picture.shape[1] - 1 - x - expected[0], y - expected[1]) < 25, name


def test_tracking_follows_a_moving_picture(standing: tuple[np.ndarray, Body]) -> None:
    picture, body = standing
    with BodyTracker() as tracker:
        for step in range(6):
            shift = np.float32([[1, 0, 4 * step], [0, 1, 0]])
            frame = cv2.warpAffine(picture, shift, picture.shape[1::-1], borderMode=cv2.BORDER_REPLICATE)
            found = tracker(frame)
            assert found is not None
    moved = found.joint("Hips")[0] - body.joint("Hips")[0]
    assert abs(moved[0] - 20) < 10
    assert abs(moved[1]) < 10


def test_every_weight_of_a_joint_sums_to_one() -> None:
    for name, parts in MIXAMO_JOINTS.items():
        assert abs(sum(share for _, share in parts) - 1) < 1e-9, name
        assert all(landmark in BODY_LANDMARKS for landmark, _ in parts)
    assert len(BODY_LANDMARKS) == 33


def test_nobody_there() -> None:
    assert find_body(np.full((240, 320, 3), 128, np.uint8)) is None
