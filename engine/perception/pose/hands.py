"""Hands in pictures and video: MediaPipe Hands behind a small interface."""

from __future__ import annotations

from contextlib import AbstractContextManager
from dataclasses import dataclass, replace
from types import TracebackType
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.geometry.rigging.joint_names import FINGER_NAMES, SIDE_NAMES, Side
from engine.perception.pose.body import Body
from engine.perception.solutions import network

HAND_JOINTS = (
    "",
    *(f"{finger}{k}" for finger in FINGER_NAMES for k in (1, 2, 3, 4)),
)
"""The 21 points as ends of Mixamo names: point k of a left hand is the joint "LeftHand" + JOINTS[k]."""

CROP_SIZE_PIXELS = 256
"""Pixels a side of the crop in which the hand at a body's wrist is looked for."""


@dataclass(frozen=True)
class Hand:
    """One hand.

    Attributes
    ----------
    side : the person's own "Left" or "Right".
    points : (21, 2) float32, x and y in pixels.
    depth : (21,) float32, pixels by which each point is nearer to the viewer than the wrist: of one scale with `points`.
    world : (21, 3) float32, metres around the hand's middle: x to the picture's right, y up, z to the viewer.
    confidence : [0, 1].
    """

    side: Side
    points: NDArray[np.float32]
    depth: NDArray[np.float32]
    world: NDArray[np.float32]
    confidence: float

    def joint(self, name: str) -> tuple[NDArray[np.float32], NDArray[np.float32]]:
        """A joint by its Mixamo name, such as "LeftHandIndex2": pixel (2,) and world (3,)."""
        index = HAND_JOINTS.index(name.removeprefix(f"{self.side}Hand"))
        return self.points[index], self.world[index]


class HandTracker:
    """Follows the hands of a video, frame by frame. Use as a context manager."""

    def __init__(self, hands: int = 2, confidence: float = 0.5):
        self._lent = _hands(video=True, hands=hands, confidence=confidence)
        self._hands = self._lent.__enter__()

    def __enter__(self) -> HandTracker:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._lent.__exit__(kind, error, trace)

    def __call__(self, rgb: NDArray[np.uint8]) -> list[Hand]:
        """The hands in this frame, (H, W, 3) uint8, the surest first."""
        return _read(self._hands.process(np.ascontiguousarray(rgb)), rgb.shape[:2])


def find_hands(rgb: NDArray[np.uint8], body: Body | None = None, confidence: float = 0.5) -> list[Hand]:
    """The hands of a picture (H, W, 3) uint8, the surest first.

    In a picture of a whole body the hands are too small to be seen at once: give the `body`, and they are
    looked for in crops at its wrists, and carry the side of their wrist.
    """
    if body is None:
        with _hands(video=False, hands=4, confidence=confidence) as seer:
            return _read(seer.process(np.ascontiguousarray(rgb)), rgb.shape[:2])
    sides: tuple[Side, ...] = SIDE_NAMES
    found = (_hand_at_wrist(rgb, body, side, confidence) for side in sides)
    return sorted((hand for hand in found if hand is not None), key=lambda hand: -hand.confidence)


def _hand_at_wrist(rgb: NDArray[np.uint8], body: Body, side: Side, confidence: float) -> Hand | None:
    wrist, elbow = body.landmark(f"{side}Wrist"), body.landmark(f"{side}Elbow")
    knuckles = (body.landmark(f"{side}Index") + body.landmark(f"{side}Pinky")) / 2
    palm = float(np.linalg.norm(knuckles - wrist))
    shoulders = float(np.linalg.norm(body.landmark("LeftShoulder") - body.landmark("RightShoulder")))
    # a foreshortened forearm or palm must not shrink the crop: shoulders are about two hands wide
    reach = max(2.2 * palm, 0.75 * float(np.linalg.norm(elbow - wrist)), 0.5 * shoulders, 8.0)
    centre = wrist + 0.8 * (knuckles - wrist)
    scale = CROP_SIZE_PIXELS / (2 * reach)
    into_crop = np.array(
        [[scale, 0, CROP_SIZE_PIXELS / 2 - scale * centre[0]], [0, scale, CROP_SIZE_PIXELS / 2 - scale * centre[1]]]
    )
    crop = cv2.warpAffine(
        rgb, into_crop, (CROP_SIZE_PIXELS, CROP_SIZE_PIXELS), flags=cv2.INTER_AREA if scale < 1 else cv2.INTER_CUBIC
    )
    with _hands(video=False, hands=2, confidence=confidence) as seer:
        hands = _read(seer.process(np.ascontiguousarray(crop, np.uint8)), (CROP_SIZE_PIXELS, CROP_SIZE_PIXELS))
    hands = [
        replace(
            hand,
            side=side,
            points=((hand.points - into_crop[:, 2]) / scale).astype(np.float32),
            depth=(hand.depth / scale).astype(np.float32),
        )
        for hand in hands
    ]
    hands = [hand for hand in hands if np.linalg.norm(hand.points[0] - wrist) < reach / 2]
    return min(hands, key=lambda hand: float(np.linalg.norm(hand.points[0] - wrist)), default=None)


def _hands(video: bool, hands: int, confidence: float) -> AbstractContextManager[Any]:
    return network(
        "hands",
        "Hands",
        follows=video,
        static_image_mode=not video,
        max_num_hands=hands,
        model_complexity=1,
        min_detection_confidence=confidence,
        min_tracking_confidence=confidence,
    )


def _read(result: Any, shape: tuple[int, int]) -> list[Hand]:
    height, width = shape
    hands = []
    for marks, world, handedness in zip(
        result.multi_hand_landmarks or [],
        result.multi_hand_world_landmarks or [],
        result.multi_handedness or [],
        strict=True,
    ):
        label = handedness.classification[0]
        points = np.array([(p.x * width - 0.5, p.y * height - 0.5) for p in marks.landmark], np.float32)
        depth = np.array([-p.z * width for p in marks.landmark], np.float32)
        metres = np.array([(p.x, -p.y, -p.z) for p in world.landmark], np.float32)
        # the network was trained on mirrored selfies: its left is our right
        side: Side = "Right" if label.label == "Left" else "Left"
        hands.append(Hand(side, points, depth, metres, float(label.score)))
    return sorted(hands, key=lambda hand: -hand.confidence)
