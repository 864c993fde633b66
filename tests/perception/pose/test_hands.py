"""Hands on pictures in which one can see them."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import cv2
import numpy as np
import pytest

from engine.perception.pose.body import find_body
from engine.perception.pose.hands import HAND_JOINTS, HandTracker, find_hands

Media = Callable[[str], Path]

TIPS, KNUCKLES = (8, 12, 16, 20), (5, 9, 13, 17)


def read(path: Path) -> np.ndarray:
    return cv2.imread(str(path))[..., ::-1].copy()


@pytest.mark.parametrize("name", ["man_spotlight_001.jpg", "scan_render_corey_wave.jpg", "man_mug_arm_across.png"])
def test_both_hands_are_found_at_the_bodys_wrists(media: Media, name: str) -> None:
    picture = read(media(f"fullbody/{name}"))
    body = find_body(picture)
    assert body is not None
    hands = find_hands(picture, body)
    assert {hand.side for hand in hands} == {"Left", "Right"}
    shoulders = np.linalg.norm(body.landmark("LeftShoulder") - body.landmark("RightShoulder"))
    for hand in hands:
        assert np.linalg.norm(hand.points[0] - body.landmark(f"{hand.side}Wrist")) < 0.25 * shoulders
        assert hand.points.shape == (21, 2)
        assert 0.05 < np.linalg.norm(hand.world[9] - hand.world[0]) < 0.14  # wrist to middle knuckle, metres


def test_sides_agree_with_the_bodys(media: Media) -> None:
    """Without a body the side is the network's word: it must be the person's, not the mirror's."""
    picture = read(media("fullbody/man_spotlight_001.jpg"))
    hands = find_hands(picture)
    assert {hand.side for hand in hands} == {"Left", "Right"}
    left, right = sorted(hands, key=lambda hand: hand.side)
    assert left.points[0, 0] > right.points[0, 0]


def test_waving_fingers_point_up(media: Media) -> None:
    picture = read(media("fullbody/scan_render_corey_wave.jpg"))
    body = find_body(picture)
    assert body is not None
    waving = next(hand for hand in find_hands(picture, body) if hand.side == "Right")
    for tip, knuckle in zip(TIPS, KNUCKLES, strict=True):
        assert waving.points[tip, 1] < waving.points[knuckle, 1] < waving.points[0, 1]
        assert waving.world[tip, 1] > waving.world[0, 1]
    point, world = waving.joint("RightHandIndex4")
    np.testing.assert_array_equal(point, waving.points[8])
    np.testing.assert_array_equal(world, waving.world[8])


def test_tracking_keeps_a_still_hand_still(media: Media) -> None:
    picture = read(media("fullbody/scan_render_corey_wave.jpg"))[40:340, 180:520]
    picture = np.ascontiguousarray(cv2.resize(picture, None, fx=2, fy=2, interpolation=cv2.INTER_CUBIC))
    with HandTracker(hands=1) as tracker:
        seen = [tracker(picture) for _ in range(6)]
    assert all(len(hands) == 1 for hands in seen)
    assert np.abs(seen[-1][0].points - seen[-2][0].points).max() < 1.5


def test_names_of_the_joints() -> None:
    assert len(HAND_JOINTS) == 21
    assert HAND_JOINTS[0] == ""
    assert HAND_JOINTS[4] == "Thumb4"
    assert HAND_JOINTS[17] == "Pinky1"


def test_no_hands_there() -> None:
    assert find_hands(np.full((240, 320, 3), 128, np.uint8)) == []


def test_depth_and_places_in_space_agree(media: Media) -> None:
    """Both answers to which fingers are nearer, in pixels and in metres, of an open hand."""
    picture = read(media("fullbody/scan_render_corey_wave.jpg"))
    body = find_body(picture)
    assert body is not None
    waving = next(hand for hand in find_hands(picture, body) if hand.side == "Right")
    assert abs(waving.depth[0]) < 1
    world = waving.world - waving.world[0]
    scale = np.linalg.norm(waving.points[12] - waving.points[0]) / np.linalg.norm(world[12, :2])
    length = np.linalg.norm(waving.points[12] - waving.points[0])
    assert np.median(np.abs(waving.depth - scale * world[:, 2])) < 0.15 * length
