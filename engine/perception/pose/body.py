"""Body poses in pictures and video: MediaPipe Pose behind a small interface.

Its heavier and lighter models are not in the wheel and would be downloaded; the middle one is, and is the
only one used. It sees one body, the most prominent.
"""

from __future__ import annotations

from contextlib import AbstractContextManager
from dataclasses import dataclass
from types import TracebackType
from typing import Any

import numpy as np
from numpy.typing import NDArray

from engine.geometry.rigging.joint_names import SIDE_NAMES
from engine.perception.solutions import network

BODY_LANDMARKS = (
    *("Nose", "LeftEyeInner", "LeftEye", "LeftEyeOuter", "RightEyeInner", "RightEye", "RightEyeOuter"),
    *("LeftEar", "RightEar", "MouthLeft", "MouthRight", "LeftShoulder", "RightShoulder", "LeftElbow"),
    *("RightElbow", "LeftWrist", "RightWrist", "LeftPinky", "RightPinky", "LeftIndex", "RightIndex"),
    *("LeftThumb", "RightThumb", "LeftHip", "RightHip", "LeftKnee", "RightKnee", "LeftAnkle", "RightAnkle"),
    *("LeftHeel", "RightHeel", "LeftFootIndex", "RightFootIndex"),
)
"""The 33 points. "Left" is the person's own left."""

MIXAMO_JOINTS: dict[str, tuple[tuple[str, float], ...]] = {
    "Hips": (("LeftHip", 0.5), ("RightHip", 0.5)),
    "Spine": (("LeftHip", 0.4), ("RightHip", 0.4), ("LeftShoulder", 0.1), ("RightShoulder", 0.1)),
    "Spine1": (("LeftHip", 0.275), ("RightHip", 0.275), ("LeftShoulder", 0.225), ("RightShoulder", 0.225)),
    "Spine2": (("LeftHip", 0.15), ("RightHip", 0.15), ("LeftShoulder", 0.35), ("RightShoulder", 0.35)),
    "Neck": (("LeftShoulder", 0.5), ("RightShoulder", 0.5)),
    "Head": (("LeftEar", 0.5), ("RightEar", 0.5)),
    **{
        f"{side}{joint}": ((f"{side}{landmark}", 1.0),)
        for side in SIDE_NAMES
        for joint, landmark in (
            *(("Arm", "Shoulder"), ("ForeArm", "Elbow"), ("Hand", "Wrist"), ("HandIndex1", "Index")),
            *(("UpLeg", "Hip"), ("Leg", "Knee"), ("Foot", "Ankle"), ("ToeBase", "FootIndex")),
        )
    },
}
"""Joints by their Mixamo names as weighted means of landmarks. The pose has no points in the spine: they are
placed along the line from hips to neck."""

FAINT_CONFIDENCE = 0.3
"""The detector's confidence that does where nobody is found otherwise."""


@dataclass(frozen=True)
class Body:
    """One body.

    Attributes
    ----------
    points : (33, 2) float32, x and y in pixels.
    world : (33, 3) float32, metres around the middle of the hips: x to the picture's right, y up, z to the
        viewer (a body that faces the camera faces +z).
    confidence : (33,) float32 in [0, 1], that the point is in the picture and not hidden.
    """

    points: NDArray[np.float32]
    world: NDArray[np.float32]
    confidence: NDArray[np.float32]

    def joint(self, name: str) -> tuple[NDArray[np.float32], NDArray[np.float32], float]:
        """A joint by its Mixamo name: pixel (2,), world (3,), and the least confidence it rests on."""
        indices = [BODY_LANDMARKS.index(landmark) for landmark, _ in MIXAMO_JOINTS[name]]
        shares = np.array([share for _, share in MIXAMO_JOINTS[name]], np.float32)
        return shares @ self.points[indices], shares @ self.world[indices], float(self.confidence[indices].min())

    def landmark(self, name: str) -> NDArray[np.float32]:
        """The pixel (2,) of one of `BODY_LANDMARKS`."""
        return self.points[BODY_LANDMARKS.index(name)]


class BodyTracker:
    """Follows the body of a video, frame by frame. Use as a context manager."""

    def __init__(self, confidence: float = 0.5):
        self._lent = _pose(video=True, confidence=confidence)
        self._pose = self._lent.__enter__()

    def __enter__(self) -> BodyTracker:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._lent.__exit__(kind, error, trace)

    def __call__(self, rgb: NDArray[np.uint8]) -> Body | None:
        """The body in this frame, (H, W, 3) uint8; None where none is seen."""
        return _body(self._pose.process(np.ascontiguousarray(rgb)), rgb.shape[:2])


def find_body(rgb: NDArray[np.uint8], confidence: float = 0.5) -> Body | None:
    """The most prominent body of a picture (H, W, 3) uint8; None where none is seen."""
    with _pose(video=False, confidence=confidence) as pose:
        return _body(pose.process(np.ascontiguousarray(rgb)), rgb.shape[:2])


def _pose(video: bool, confidence: float) -> AbstractContextManager[Any]:
    return network(
        "pose",
        "Pose",
        follows=video,
        static_image_mode=not video,
        model_complexity=1,
        min_detection_confidence=confidence,
        min_tracking_confidence=confidence,
    )


def _body(result: Any, shape: tuple[int, int]) -> Body | None:
    if result.pose_landmarks is None:
        return None
    height, width = shape
    found, world = result.pose_landmarks.landmark, result.pose_world_landmarks.landmark
    return Body(
        points=np.array([(p.x * width - 0.5, p.y * height - 0.5) for p in found], np.float32),
        world=np.array([(p.x, -p.y, -p.z) for p in world], np.float32),
        confidence=np.array([p.visibility for p in found], np.float32),
    )
