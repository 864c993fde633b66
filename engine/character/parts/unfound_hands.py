"""Hands at hips and belly that were not found: they may be in a pocket, behind the tail of a coat, or too small to be known for
hands.

Beyond the paper.
"""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.character.figure.figure import Figure
from engine.character.parts.labels import ARM_LABELS
from engine.geometry.rigging.joint_names import SIDE_NAMES
from engine.perception.pose.body import BODY_LANDMARKS

HIP_DEPTH_TRUNK_SHARE, WRIST_HIP_WIDTH_RATIO, MAX_HIP_DISTANCE_TRUNK_LENGTHS = 0.7, 1.5, 0.5
"""Where a wrist is at the hip. It is at least so far down the trunk, and so much further from the middle than the hip's
joint. It is at most so far from that joint, all in lengths of the trunk."""
MIN_HIP_OFFSET_TRUNK_LENGTHS = 0.15
"""How far the hip's joint is from the middle, at least, in lengths of the trunk: seen from the side it is nowhere
aside."""
BELLY_DEPTH_TRUNK_SHARE, MIN_WRIST_DISTANCE_TRUNK_LENGTHS = 0.55, 0.35
"""Where one is before the belly, as in the pocket of a jumper: how far down the trunk, at least, and how far both
wrists are from each other, at least. Nearer, one hand hides the other."""
SEEN_FINGER_CONFIDENCE = 0.9
"""Confidence of a finger from which on a hand before the belly is seen."""


@dataclass(frozen=True)
class UnfoundHand:
    """A hand that no network has found.

    arm : whose it is, an index of `BODY_PARTS`.
    wrist, knuckles : (2,) on the grid.
    confidence : with which the body's network has its fingers.
    before : whether it is before the belly rather than beside the hip.
    skin : (N, 3) of the face, RGB.
    """

    arm: int
    wrist: NDArray[np.float64]
    knuckles: NDArray[np.float64]
    confidence: float
    before: bool
    skin: NDArray[np.float64]


def unfound_hands(figure: Figure, rgb: NDArray[np.uint8], to_grid: NDArray[np.float64]) -> tuple[UnfoundHand, ...]:
    """Those of a figure, on the grid of `rgb` (h, w, 3)."""

    def at(name: str) -> NDArray[np.float64]:
        return np.asarray(to_grid[:, :2] @ figure.point(name) + to_grid[:, 2], np.float64)

    shoulders, hips = ((at(f"Left{joint}") + at(f"Right{joint}")) / 2 for joint in ("Shoulder", "Hip"))
    down = hips - shoulders
    trunk = max(float(np.linalg.norm(down)), 1.0)
    skin = np.zeros((0, 3))
    if figure.face is not None:
        skin = _skin(rgb, figure.face[:, :2] @ to_grid[:, :2].T + to_grid[:, 2])
    apart = float(np.linalg.norm(at("LeftWrist") - at("RightWrist"))) > MIN_WRIST_DISTANCE_TRUNK_LENGTHS * trunk
    found = []
    for arm, side, hand in zip(ARM_LABELS, SIDE_NAMES, figure.hands, strict=True):
        wrist, hip = at(f"{side}Wrist"), at(f"{side}Hip")
        half = float(np.linalg.norm(hip - hips))
        aside = float((wrist - hips) @ unit(hip - hips)) > WRIST_HIP_WIDTH_RATIO * max(
            half, MIN_HIP_OFFSET_TRUNK_LENGTHS * trunk
        )
        low = float((wrist - shoulders) @ down) / trunk**2
        sure = float(min(figure.confidence[BODY_LANDMARKS.index(f"{side}{finger}")] for finger in ("Index", "Pinky")))
        beside, before = (
            aside and low > HIP_DEPTH_TRUNK_SHARE,
            apart and low > BELLY_DEPTH_TRUNK_SHARE and sure < SEEN_FINGER_CONFIDENCE,
        )
        if hand is None and (beside or before) and np.linalg.norm(wrist - hip) < MAX_HIP_DISTANCE_TRUNK_LENGTHS * trunk:
            knuckles = (at(f"{side}Index") + at(f"{side}Pinky")) / 2
            found.append(UnfoundHand(arm, wrist, knuckles, sure, not beside, skin))
    return tuple(found)


def _skin(rgb: NDArray[np.uint8], face: NDArray[np.floating]) -> NDArray[np.float64]:
    """The half of the colours (N, 3) of a face (478, 2) that are nearest to its median: no eyes, lips or beard."""
    inside = np.zeros(rgb.shape[:2], np.uint8)
    cv2.fillConvexPoly(inside, cv2.convexHull(np.rint(face).astype(np.int32)), (1,))
    colours = rgb[inside > 0].astype(np.float64)
    if not len(colours):
        return colours
    off = np.linalg.norm(colours - np.median(colours, axis=0), axis=1)
    return np.asarray(colours[off <= np.median(off)])


def unit(vector: NDArray[np.float64]) -> NDArray[np.float64]:
    """A vector of length 1 in the same direction."""
    return vector / max(float(np.linalg.norm(vector)), 1e-6)
