"""Limbs that a mask lacks come back; the rest of it stays."""

import cv2
import numpy as np

from engine.avatar.capture.limb_masks import limbs_of, shown_limbs, with_limbs
from engine.avatar.landmarks.spatial import SpatialLandmarks
from engine.geometry.camera import Camera

CAMERA = Camera((0.0, 0.0, 0.0), 400.0, (99.5, 149.5), (300, 200)).aimed((0.0, 0.6, 2.0), (0.0, 0.6, 0.0))
WRIST, PINKY, INDEX = np.array([0.0, 0.12, 0.0]), np.array([0.0, 0.03, -0.06]), np.array([0.2, 0.02, 0.0])
PALM = SpatialLandmarks({"LeftWrist": WRIST, "LeftPinky": PINKY, "LeftIndex": INDEX})


def scene() -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """A sleeve with a dark glove before tiles: the picture, the mask as networks have it, and the true one."""
    random = np.random.default_rng(2)
    tiles = (np.indices((300, 200)) // 12).sum(0) % 2
    rgb = np.where(tiles[..., None] == 1, [150, 40, 50], [60, 70, 130]).astype(np.uint8)
    sleeve = np.zeros((300, 200), np.uint8)
    cv2.rectangle(sleeve, (88, 30), (112, 245), 1, -1)
    corners = np.rint(CAMERA.project(np.stack([WRIST, PINKY, INDEX]))[:, :2]).astype(np.int32)
    hand = np.zeros_like(sleeve)
    cv2.fillConvexPoly(hand, corners, 1)
    hand = cv2.dilate(hand, np.ones((11, 11), np.uint8))
    rgb[sleeve > 0], rgb[hand > 0] = (190, 150, 130), (40, 28, 30)
    noisy = rgb + random.normal(0, 5, rgb.shape)
    return noisy.clip(0, 255).astype(np.uint8), (sleeve > 0) & ~(hand > 0), (sleeve | hand) > 0


def test_a_hand_that_the_networks_lost_is_found_by_where_the_palm_is() -> None:
    rgb, lacking, true = scene()
    found = with_limbs(rgb, lacking, CAMERA, limbs_of(PALM))
    assert (lacking & true).sum() / true.sum() < 0.85
    assert (found & true).sum() / (found | true).sum() > 0.96
    assert np.array_equal(found[:200], lacking[:200]), "far from the palm nothing changes"


def test_a_forearm_that_the_networks_lost_is_found_and_one_that_is_there_stays() -> None:
    random = np.random.default_rng(3)
    rgb = np.full((300, 200, 3), (120, 140, 90), np.uint8)
    ends = {"LeftElbow": np.array([-0.1, 0.9, 0.0]), "LeftWrist": np.array([0.15, 0.75, 0.0])}
    arm = np.zeros((300, 200), np.uint8)
    elbow, wrist = np.rint(CAMERA.project(np.stack(list(ends.values())))[:, :2]).astype(int).tolist()
    cv2.line(arm, elbow, wrist, 1, 16)
    rgb[arm > 0] = (60, 80, 170)
    rgb = (rgb + random.normal(0, 5, rgb.shape)).clip(0, 255).astype(np.uint8)
    limbs = limbs_of(SpatialLandmarks(ends))
    lacking = (arm > 0) & (np.arange(200) < elbow[0] + 10)
    found = with_limbs(rgb, lacking, CAMERA, limbs)
    assert (found & (arm > 0)).sum() / (found | (arm > 0)).sum() > 0.9
    generous = cv2.dilate(arm, np.ones((9, 9), np.uint8)) > 0
    assert np.array_equal(with_limbs(rgb, generous, CAMERA, limbs), generous)


def test_an_arm_that_most_masks_lack_is_not_believed() -> None:
    ends = {"LeftElbow": np.array([-0.1, 0.9, 0.0]), "LeftWrist": np.array([0.15, 0.75, 0.0])}
    limbs = limbs_of(SpatialLandmarks(ends))
    whole, empty = np.ones((300, 200), np.bool_), np.zeros((300, 200), np.bool_)
    assert shown_limbs(limbs, [whole] * 6 + [empty], [CAMERA] * 7) == limbs
    assert shown_limbs(limbs, [whole] * 2 + [empty] * 3, [CAMERA] * 5) == []
    hands = limbs_of(PALM)
    assert shown_limbs(hands, [empty], [CAMERA]) == hands


def test_what_is_not_known_or_not_in_the_picture_changes_nothing() -> None:
    rgb, lacking, _ = scene()
    assert limbs_of(SpatialLandmarks({"LeftWrist": WRIST, "LeftPinky": PINKY})) == []
    elsewhere = SpatialLandmarks({name: at + np.array([9.0, 0.0, 0.0]) for name, at in PALM.body.items()})
    assert np.array_equal(with_limbs(rgb, lacking, CAMERA, limbs_of(elsewhere)), lacking)
    behind = SpatialLandmarks({name: at + np.array([0.0, 0.0, 4.0]) for name, at in PALM.body.items()})
    assert np.array_equal(with_limbs(rgb, lacking, CAMERA, limbs_of(behind)), lacking)
