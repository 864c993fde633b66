"""The faces of a photograph, and what decides whether one is of use."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.imaging.blur import blur_effect
from engine.imaging.resample import resized, size_within
from engine.perception.face.faces import find_faces
from engine.perception.face.head_pose import head_pose
from engine.perception.face.landmarks import eye_centres
from engine.perception.identity.descriptor import FaceDescriptor
from engine.perception.identity.face_chip import ARCFACE_LAYOUT, face_chip

LOOKED_AT_SIDE_PIXELS = 1600
"""Pixels at which photographs are looked at: faces of people who had their picture taken are large in them by then."""
MAX_FACES_OF_PHOTO = 12
"""Faces of one photograph that are looked at, the largest first: of a group, whoever is meant is among them."""
JUDGED_EYE_DISTANCE = 40.0
"""Pixels between the eyes at which blur is told: a large face is shrunk to it, so that what is told is of the face and not of the
file's size."""
NEAR_WIDTHS, MIN_NEIGHBOUR_SHARE = 2.5, 0.4
"""Widths of a face within which another is beside it, and the share of that width that the other has at least."""
ALIGNED_FACE_LAYOUT = ARCFACE_LAYOUT


@dataclass(frozen=True)
class PhotoFace:
    """A face of a photograph.

    photo : which one.
    mesh : (478, 3) float32, pixels of the photograph as it is looked at (`as_looked_at`).
    eye_distance : pixels between the middles of the eyes.
    yaw, pitch : degrees by which it is turned to the picture's right, and down.
    blur : in [0, 1], as `engine.imaging.blur` tells.
    size_share : its width, in shares of that of the photograph's largest face.
    descriptor : (D,) float32.
    chip : (C, C) uint8 grey, the face laid on fixed places.
    year : in which the photograph was taken, where that is known.
    beside : how many other faces are near it, and large enough to belong to whoever stands beside.
    """

    photo: int
    mesh: NDArray[np.float32]
    eye_distance: float
    yaw: float
    pitch: float
    blur: float
    size_share: float
    descriptor: NDArray[np.float32]
    chip: NDArray[np.uint8]
    year: int | None = None
    beside: int = 0


def as_looked_at(rgb: NDArray[np.uint8]) -> NDArray[np.uint8]:
    """A photograph (H, W, 3), shrunk where it is larger than faces ask for."""
    return (
        resized(rgb, size_within(rgb.shape, LOOKED_AT_SIDE_PIXELS))
        if max(rgb.shape[:2]) > LOOKED_AT_SIDE_PIXELS
        else rgb
    )


def faces_of(rgb: NDArray[np.uint8], photo: int, describe: FaceDescriptor) -> list[PhotoFace]:
    """The faces of a photograph `rgb` (H, W, 3) uint8, as `as_looked_at` gives it, the largest first."""
    meshes = find_faces(rgb, MAX_FACES_OF_PHOTO)
    widest = max((float(np.ptp(mesh[:, 0])) for mesh in meshes), default=1.0)
    beside = _beside(meshes)
    return [
        replace(_face(rgb, photo, mesh, widest, describe), beside=count)
        for mesh, count in zip(meshes, beside, strict=True)
    ]


def _beside(meshes: Sequence[NDArray[np.floating]]) -> list[int]:
    """How many of the others are near each face (478, 3), and as large as `MIN_NEIGHBOUR_SHARE` of it."""
    if not meshes:
        return []
    middles = np.array([mesh[:, :2].mean(axis=0) for mesh in meshes])
    widths = np.array([float(np.ptp(mesh[:, 0])) for mesh in meshes])
    near = np.linalg.norm(middles[:, None] - middles[None], axis=-1) < NEAR_WIDTHS * widths[:, None]
    near &= widths[None] > MIN_NEIGHBOUR_SHARE * widths[:, None]
    return [int(count) - 1 for count in near.sum(axis=1)]


def _face(
    rgb: NDArray[np.uint8], photo: int, mesh: NDArray[np.float32], widest: float, describe: FaceDescriptor
) -> PhotoFace:
    right, left = eye_centres(mesh)
    pose = head_pose(mesh, (rgb.shape[1], rgb.shape[0]))
    # eyes of a turned face are seen nearer to each other than they are
    distance = float(np.linalg.norm(left[:2] - right[:2])) / max(np.cos(pose.yaw), 0.5)
    return PhotoFace(
        photo,
        mesh,
        distance,
        float(np.degrees(pose.yaw)),
        float(np.degrees(pose.pitch)),
        _blur(rgb, mesh, distance),
        float(np.ptp(mesh[:, 0])) / widest,
        describe(rgb, mesh),
        cv2.cvtColor(face_chip(rgb, mesh, ALIGNED_FACE_LAYOUT), cv2.COLOR_RGB2GRAY).astype(np.uint8),
    )


def _blur(rgb: NDArray[np.uint8], mesh: NDArray[np.float32], eye_distance: float) -> float:
    low = np.maximum(np.floor(mesh[:, :2].min(axis=0)), 0).astype(int)
    high = np.minimum(np.ceil(mesh[:, :2].max(axis=0)), np.array(rgb.shape[1::-1])).astype(int)
    if (high - low < 8).any():
        return 1.0
    grey = np.asarray(cv2.cvtColor(rgb[low[1] : high[1], low[0] : high[0]], cv2.COLOR_RGB2GRAY), np.uint8)
    scale = min(JUDGED_EYE_DISTANCE / max(eye_distance, 1.0), 1.0)
    small = resized(grey, (max(round(grey.shape[1] * scale), 8), max(round(grey.shape[0] * scale), 8)))
    return blur_effect(small)
