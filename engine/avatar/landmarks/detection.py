"""Landmarks of the person in space, from frames whose cameras are known."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from engine.avatar.landmarks.in_frames import FrameLandmarks
from engine.avatar.landmarks.robust_triangulation import triangulate_robustly
from engine.avatar.landmarks.spatial import (
    EYE_POINT_COUNT,
    FACE_LANDMARKS,
    HAND_LANDMARKS,
    LID_POINT_COUNT,
    SpatialLandmarks,
)
from engine.body.fitting.hand_fitting import hand_length
from engine.geometry.camera import Camera
from engine.geometry.rigging.joint_names import SIDE_NAMES

DETECTED_SIGMA_SHARE = 6 / 720
"""By what share of a frame's shorter side a landmark of the body is off, usually."""
FACE_SIGMA_SHARE = 0.02
"""By what share of a face's size in the frame one of the face is."""
HAND_SIGMA_SHARE = 0.08
"""By what share of a hand's size in the frame one of the hand is."""
MIN_LANDMARK_VIEWS = 3
"""Views that must agree on a landmark."""
BLINK_OPENING_SHARE = 0.6
"""Of the median opening of an eye, below which a frame shows it blinking."""
MAX_NOSE_OFFSET_SHARE = 0.65
"""The most by which the tip of the nose may be off the middle between the eyes' outer corners, in halves of their distance: faces
seen from the side have landmarks that are guessed."""


def spatial_landmarks(seen: Sequence[tuple[Camera, FrameLandmarks]]) -> SpatialLandmarks:
    """What several views agree on, metres in the world of the cameras."""
    body = {}
    for name in sorted({name for _, found in seen for name in found.body}):
        having = [(camera, *found.body[name]) for camera, found in seen if name in found.body]
        cameras = [camera for camera, _, _ in having]
        sigma = np.array([DETECTED_SIGMA_SHARE * min(camera.size) for camera in cameras])
        confidence = np.array([value for _, _, value in having])
        placed = triangulate_robustly(cameras, np.stack([at for _, at, _ in having]), confidence, sigma)
        if placed is not None and placed.agreeing >= MIN_LANDMARK_VIEWS:
            body[name] = placed.place
    hands = np.stack([_hand(seen, side) for side in SIDE_NAMES])
    return SpatialLandmarks(body, _face(seen), hands, np.stack([_eye(seen, k) for k in range(len(SIDE_NAMES))]))


def _hand(seen: Sequence[tuple[Camera, FrameLandmarks]], side: str) -> NDArray[np.float64]:
    """(21, 3) the landmarks of the person's hand on that `side`; NaN where views do not agree."""
    having = [(camera, *found.hands[side]) for camera, found in seen if side in found.hands]
    out = np.full((HAND_LANDMARKS, 3), np.nan)
    if len(having) < MIN_LANDMARK_VIEWS:
        return out
    cameras = [camera for camera, _, _ in having]
    hands = np.stack([points for _, points, _ in having])
    confidence = np.array([value for _, _, value in having])
    sigma = HAND_SIGMA_SHARE * np.array([hand_length(points) for points in hands])
    for k in range(HAND_LANDMARKS):
        placed = triangulate_robustly(cameras, hands[:, k], confidence, sigma)
        if placed is not None and placed.agreeing >= MIN_LANDMARK_VIEWS:
            out[k] = placed.place
    return out


def _face(seen: Sequence[tuple[Camera, FrameLandmarks]]) -> NDArray[np.float64]:
    """(68, 3) the face's landmarks from the views that show it from the front; NaN where they do not agree."""
    having = [(camera, found.face) for camera, found in seen if found.face is not None and _frontal(found.face)]
    out = np.full((FACE_LANDMARKS, 3), np.nan)
    if len(having) < MIN_LANDMARK_VIEWS:
        return out
    cameras = [camera for camera, _ in having]
    faces = np.stack([face for _, face in having])
    sigma = FACE_SIGMA_SHARE * np.linalg.norm(np.ptp(faces, axis=1), axis=1)
    for k in range(FACE_LANDMARKS):
        placed = triangulate_robustly(cameras, faces[:, k], np.ones(len(faces)), sigma)
        if placed is not None and placed.agreeing >= MIN_LANDMARK_VIEWS:
            out[k] = placed.place
    return out


def _eye(seen: Sequence[tuple[Camera, FrameLandmarks]], side: int) -> NDArray[np.float64]:
    """(21, 3) one eye's lids and iris, from the views that show the face from the front, blinks left out; NaN where they do not
    agree."""
    having = [
        (camera, found.face, found.eyes[side])
        for camera, found in seen
        if found.face is not None and found.eyes is not None and _frontal(found.face)
    ]
    out = np.full((EYE_POINT_COUNT, 3), np.nan)
    if len(having) < MIN_LANDMARK_VIEWS:
        return out
    opening = np.array([eye_opening(eye) for _, _, eye in having])
    having = [
        one for one, wide in zip(having, opening >= BLINK_OPENING_SHARE * np.median(opening), strict=True) if wide
    ]
    if len(having) < MIN_LANDMARK_VIEWS:
        return out
    cameras = [camera for camera, _, _ in having]
    eyes = np.stack([eye for _, _, eye in having])
    sigma = FACE_SIGMA_SHARE * np.array([np.linalg.norm(np.ptp(face, axis=0)) for _, face, _ in having])
    for k in range(EYE_POINT_COUNT):
        placed = triangulate_robustly(cameras, eyes[:, k], np.ones(len(eyes)), sigma)
        if placed is not None and placed.agreeing >= MIN_LANDMARK_VIEWS:
            out[k] = placed.place
    return out


def eye_opening(eye: NDArray[np.floating]) -> float:
    """How far the lids of an eye (21, D) are apart in the mean, as a share of its width."""
    upper, lower = eye[1 : LID_POINT_COUNT // 2], eye[LID_POINT_COUNT - 1 : LID_POINT_COUNT // 2 : -1]
    width = float(np.linalg.norm(eye[0] - eye[LID_POINT_COUNT // 2]))
    return float(np.linalg.norm(upper - lower, axis=1).mean()) / max(width, 1e-9)


def _frontal(face: NDArray[np.float64]) -> bool:
    """Whether a face (68, 2) is seen more from the front than from the side."""
    across = face[45] - face[36]
    width = np.linalg.norm(across)
    if width == 0:
        return False
    nose = (face[30] - (face[36] + face[45]) / 2) @ across / width
    return bool(abs(nose) < MAX_NOSE_OFFSET_SHARE * width / 2)
