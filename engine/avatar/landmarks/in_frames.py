"""Landmarks of body, hands and face in one frame, unreliable ones left out: section 3.3."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from engine.geometry.rigging.joint_names import SIDE_NAMES
from engine.perception.face.face_wear import FaceWear, face_wear
from engine.perception.face.faces import find_faces
from engine.perception.face.landmarks import LEFT_EYE, LEFT_IRIS, RIGHT_EYE, RIGHT_IRIS, fiducials
from engine.perception.pose.body import BODY_LANDMARKS, Body, find_body
from engine.perception.pose.hands import find_hands

SKELETON_BONES = (
    *(("LeftShoulder", "RightShoulder"), ("LeftHip", "RightHip")),
    *((f"{side}{a}", f"{side}{b}") for side in SIDE_NAMES for a, b in (
        ("Shoulder", "Elbow"), ("Elbow", "Wrist"), ("Shoulder", "Hip"), ("Hip", "Knee"), ("Knee", "Ankle")
    )),
)  # fmt: skip
"""Bones by their landmarks at both ends."""
MIN_SKELETON_BONES = 4
"""Bones of which both ends are seen, at least, where a frame shows a skeleton."""
MIN_BEST_CONFIDENCE = 0.5
"""Confidence of a skeleton's surest landmark, at least."""
MIN_LANDMARK_CONFIDENCE = 0.3
"""Of a landmark that is used."""
KNUCKLE_LANDMARKS = ("Index", "Pinky")
"""Landmarks of the body that a hand's own crop shows better: its first joints."""
HEAD_CROP_HALF_SIDE = 1.6
"""Half the side of the square in which a body's face is looked for, in distances between its shoulders' and eyes' middle."""


EYE_MESH_VERTICES = np.array([[*LEFT_EYE, *LEFT_IRIS], [*RIGHT_EYE, *RIGHT_IRIS]])
"""Vertices of the face mesh that are an eye, of the left, then of the right: sixteen between the lids, five of the iris."""


@dataclass(frozen=True)
class FrameLandmarks:
    """What one frame shows.

    body : pixels (2,) and confidence by name.
    face : (68, 2) pixels or None.
    hands : by side, (21, 2) pixels and confidence.
    eyes : (2, 21, 2) pixels, the left and the right one's `EYE_MESH_VERTICES`, where there is a face.
    wear : what the face wears.
    """

    body: Mapping[str, tuple[NDArray[np.float64], float]]
    face: NDArray[np.float64] | None
    hands: Mapping[str, tuple[NDArray[np.float64], float]] = field(default_factory=dict)
    eyes: NDArray[np.float64] | None = None
    wear: FaceWear = field(default_factory=FaceWear)

    def scaled(self, factor: float) -> FrameLandmarks:
        """Those of the same frame, larger by `factor`."""

        def at(places: NDArray[np.float64]) -> NDArray[np.float64]:
            return np.asarray((places + 0.5) * factor - 0.5)

        return FrameLandmarks(
            {name: (at(place), confidence) for name, (place, confidence) in self.body.items()},
            None if self.face is None else at(self.face),
            {side: (at(points), confidence) for side, (points, confidence) in self.hands.items()},
            None if self.eyes is None else at(self.eyes),
            self.wear,
        )


def frame_landmarks(rgb: NDArray[np.uint8]) -> FrameLandmarks:
    """The landmarks of the person in a frame (H, W, 3) uint8; none of those that cannot be relied on."""
    body = find_body(rgb)
    named = {} if body is None else reliable(body)
    hands: dict[str, tuple[NDArray[np.float64], float]] = {}
    if body is not None and named:
        for hand in find_hands(rgb, body):
            hands[hand.side] = hand.points.astype(np.float64), hand.confidence
            for finger in KNUCKLE_LANDMARKS:
                at, _ = hand.joint(f"{hand.side}Hand{finger}1")
                named[f"{hand.side}{finger}"] = at.astype(np.float64), hand.confidence
    mesh = _face_mesh(rgb, body if named else None)
    if mesh is None:
        return FrameLandmarks(named, None, hands)
    return FrameLandmarks(named, np.asarray(fiducials(mesh)), hands, mesh[EYE_MESH_VERTICES], face_wear(rgb, mesh))


def _face_mesh(rgb: NDArray[np.uint8], body: Body | None) -> NDArray[np.float64] | None:
    """(478, 2) the largest face; of a body, that where its head is, if its nose is seen at all."""
    within = None
    if body is not None:
        if body.confidence[BODY_LANDMARKS.index("Nose")] < MIN_LANDMARK_CONFIDENCE:
            return None
        eyes = (body.landmark("LeftEye") + body.landmark("RightEye")) / 2
        shoulders = (body.landmark("LeftShoulder") + body.landmark("RightShoulder")) / 2
        reach = HEAD_CROP_HALF_SIDE * float(np.linalg.norm(eyes - shoulders))
        height, width = rgb.shape[:2]
        x0, y0 = (max(0, round(float(at - reach))) for at in eyes)
        x1, y1 = (min(limit, round(float(at + reach))) for at, limit in zip(eyes, (width, height), strict=True))
        if x1 - x0 < 2 or y1 - y0 < 2:
            return None
        within = x0, y0, x1, y1
    faces = find_faces(rgb, most=1, within=within)
    return faces[0][:, :2].astype(np.float64) if faces else None


def reliable(body: Body) -> dict[str, tuple[NDArray[np.float64], float]]:
    """A body's landmarks of some confidence; none at all of a skeleton with fewer than four bones, or whose best confidence is
    below one half."""
    sure = {
        name for name, value in zip(BODY_LANDMARKS, body.confidence, strict=True) if value >= MIN_LANDMARK_CONFIDENCE
    }
    bones = sum(a in sure and b in sure for a, b in SKELETON_BONES)
    if bones < MIN_SKELETON_BONES or body.confidence.max() < MIN_BEST_CONFIDENCE:
        return {}
    points = zip(BODY_LANDMARKS, body.points, body.confidence, strict=True)
    return {name: (at.astype(np.float64), float(value)) for name, at, value in points if name in sure}
