"""Joints of drawn figures by their outline: of limbs drawn from known joints, and of shapes that are nobody's."""

from __future__ import annotations

from itertools import pairwise

import cv2
import numpy as np
import pytest
from numpy.typing import NDArray

from engine.perception.masks.figure import figure_on_paper
from engine.perception.pose.body import BODY_LANDMARKS
from engine.perception.pose.outline_skeleton import outline_skeleton

Places = dict[str, tuple[float, float]]

STANDING: Places = {
    **{"Nose": (200, 70), "LeftShoulder": (245, 135), "RightShoulder": (155, 135), "LeftElbow": (290, 200)},
    **{"RightElbow": (110, 200), "LeftWrist": (325, 265), "RightWrist": (75, 265), "LeftHip": (225, 260)},
    **{"RightHip": (175, 260), "LeftKnee": (245, 350), "RightKnee": (155, 350), "LeftAnkle": (260, 440)},
    "RightAnkle": (140, 440),
}
SPREAD: Places = STANDING | {
    **{"LeftElbow": (310, 130), "LeftWrist": (375, 125), "RightElbow": (95, 110), "RightWrist": (50, 60)},
}
LIMB, HEAD = 30, 42


def figure(places: Places) -> NDArray[np.bool_]:
    """The outline of a figure with these joints."""
    drawn = np.zeros((500, 400), np.uint8)
    at = {name: tuple(round(value) for value in place) for name, place in places.items()}
    trunk = [at[name] for name in ("LeftShoulder", "RightShoulder", "RightHip", "LeftHip")]
    cv2.fillPoly(drawn, [np.array(trunk, np.int32)], (1,))
    for side in ("Left", "Right"):
        for chain in (("Shoulder", "Elbow", "Wrist"), ("Hip", "Knee", "Ankle")):
            for a, b in pairwise(chain):
                cv2.line(drawn, at[side + a], at[side + b], (1,), LIMB)
        cv2.line(drawn, at[f"{side}Shoulder"], at[f"{side}Hip"], (1,), LIMB)
    cv2.line(drawn, at["LeftShoulder"], at["RightShoulder"], (1,), LIMB)
    cv2.circle(drawn, at["Nose"], HEAD, (1,), -1)
    cv2.line(drawn, at["Nose"], (at["Nose"][0], at["LeftShoulder"][1]), (1,), LIMB)
    return drawn > 0


@pytest.mark.parametrize("places", [STANDING, SPREAD], ids=["arms down", "one arm raised"])
def test_joints_are_found_where_limbs_were_drawn(places: Places) -> None:
    found = outline_skeleton(figure(places))
    assert found is not None
    for name, place in places.items():
        away = np.linalg.norm(found[BODY_LANDMARKS.index(name)] - place)
        assert away < (30 if "Hip" not in name else 60), name  # where legs begin within a trunk no outline says


def test_a_mirrored_outline_has_left_and_right_exchanged() -> None:
    outline = figure(SPREAD)
    found, mirrored = outline_skeleton(outline), outline_skeleton(outline[:, ::-1])
    assert found is not None
    assert mirrored is not None
    for name in ("Shoulder", "Elbow", "Wrist", "Knee", "Ankle"):
        own, other = (
            points[BODY_LANDMARKS.index(f"{side}{name}")] for points, side in ((found, "Left"), (mirrored, "Right"))
        )
        np.testing.assert_allclose(other, [outline.shape[1] - 1 - own[0], own[1]], atol=6)


def test_hair_that_stands_off_is_no_hand() -> None:
    outline = figure(STANDING).astype(np.uint8)
    for side in (-1, 1):
        tail = np.array([(200 + side * 30, 50), (200 + side * 75, 30), (200 + side * 80, 80)], np.int32)
        cv2.polylines(outline, [tail], False, (1,), 12)
    found = outline_skeleton(outline > 0)
    assert found is not None
    for name in ("Nose", "LeftWrist", "RightWrist"):
        assert np.linalg.norm(found[BODY_LANDMARKS.index(name)] - STANDING[name]) < 30


@pytest.mark.parametrize("thing", ["disk", "bar", "cross", "nothing"])
def test_what_has_no_limbs_is_nobody(thing: str) -> None:
    drawn = np.zeros((400, 300), np.uint8)
    if thing == "disk":
        cv2.circle(drawn, (150, 200), 120, (1,), -1)
    elif thing == "bar":
        cv2.rectangle(drawn, (130, 20), (170, 380), (1,), -1)
    elif thing == "cross":
        cv2.line(drawn, (150, 20), (150, 380), (1,), 40)
        cv2.line(drawn, (20, 150), (280, 150), (1,), 40)
    assert outline_skeleton(drawn > 0) is None


def test_what_lines_enclose_on_paper_is_filled() -> None:
    outline = figure(STANDING)
    edge = outline & ~cv2.erode(outline.astype(np.uint8), np.ones((5, 5), np.uint8)).astype(bool)
    paper = np.full((*outline.shape, 3), 235, np.uint8)
    paper[edge] = (40, 40, 120)
    found = figure_on_paper(paper)
    assert found is not None
    assert (found & outline).sum() / (found | outline).sum() > 0.95
    assert figure_on_paper(np.full((200, 200, 3), 40, np.uint8)) is None


def test_what_is_filled_is_no_drawing() -> None:
    outline = figure(STANDING)
    paper = np.full((*outline.shape, 3), 235, np.uint8)
    paper[outline] = (90, 80, 60)
    assert figure_on_paper(paper) is None
