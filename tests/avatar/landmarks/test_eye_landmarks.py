"""Lids and irises that several cameras see."""

from __future__ import annotations

import numpy as np

from engine.avatar.landmarks.detection import eye_opening, spatial_landmarks
from engine.avatar.landmarks.in_frames import EYE_MESH_VERTICES, FrameLandmarks
from engine.geometry.camera import Camera
from engine.perception.face.head_pose import canonical_face
from engine.perception.face.landmarks import fiducials

FACE = canonical_face().astype(np.float64) @ np.diag([1.0, -1.0, -1.0]) * 0.06 + [0, 1.6, 0]


def _seen(face: np.ndarray, turn: float) -> tuple[Camera, FrameLandmarks]:
    lens = Camera((0.0, 0.0, 0.0), 1100.0, (359.5, 639.5), (1280, 720))
    camera = lens.aimed((0.6 * np.sin(turn), 1.65, 0.6 * np.cos(turn)), (0, 1.6, 0))
    pixels = camera.project(face)[:, :2].astype(np.float64)
    return camera, FrameLandmarks({}, fiducials(pixels), {}, pixels[EYE_MESH_VERTICES])


def test_eyes_are_where_frames_show_them_open() -> None:
    shut = FACE.copy()
    for eye in EYE_MESH_VERTICES:
        shut[eye[1:8], 1] = shut[eye[15:8:-1], 1]
    turns = np.linspace(-0.35, 0.35, 11)
    seen = [_seen(shut if k in (2, 5, 6) else FACE, turn) for k, turn in enumerate(turns)]
    found = spatial_landmarks(seen).eyes
    assert np.abs(found - FACE[EYE_MESH_VERTICES]).max() < 2e-4
    assert eye_opening(shut[EYE_MESH_VERTICES[0]]) < 0.4 * eye_opening(FACE[EYE_MESH_VERTICES[0]])


def test_two_views_do_not_tell() -> None:
    assert np.isnan(spatial_landmarks([_seen(FACE, 0.0), _seen(FACE, 0.2)]).eyes).all()
