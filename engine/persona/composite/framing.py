"""How the photograph that acts is framed: head and shoulders, as much of them as it shows."""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.face_animation.eyes.lower_lids import fit_lower_lids
from engine.face_animation.target_face import TargetFace
from engine.imaging.resample import even_size, resized
from engine.perception.face.faces import find_faces
from engine.perception.face.landmarks import FACE_OVAL
from engine.perception.masks.segmentation import people_confidence
from engine.persona.collection.face_photo import FacePhoto

BUST_FACE_HEIGHTS = 2.9
"""Of the picture's height, where the photograph shows as much."""
FACE_MIDDLE = 0.44
"""Share of the picture's height, from above, at which the face's middle is."""
HEAD_FACE_SIZES = (1.5, 1.75)
"""Widths and heights of the face that a head has, hair and some of the neck with it."""
HEAD_MIDDLE = 0.54
"""Share of the head's height, from above, at which the face's middle is."""


def head_box(mesh: NDArray[np.floating]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Two corners (2,) of what a head takes, by its face's `mesh` (478, 2 or 3), pixels."""
    low, high = _face_box(mesh)
    extent = (high - low) * HEAD_FACE_SIZES
    middle = (low + high) / 2
    corner = middle - extent * (0.5, HEAD_MIDDLE)
    return corner, corner + extent


def framed(photo: FacePhoto, size: tuple[int, int]) -> TargetFace:
    """The photograph's part around the head, as large as `size` (width, height) has room for: a photograph that shows less than
    such a part on one side gives a picture of another shape, and no head is cut."""
    low, high = _part(photo, size)
    scale = float((np.array(size) / (high - low)).min())
    width, height = even_size(*((high - low) * scale))
    place = np.array([[scale, 0, -low[0] * scale], [0, scale, -low[1] * scale]])
    matrix = place.copy()
    matrix[:, 2] += 0.5 * scale - 0.5  # pixel centres
    source = cv2.GaussianBlur(photo.rgb, (0, 0), 0.35 / scale) if scale < 1 else photo.rgb
    way = cv2.INTER_LINEAR if scale < 1 else cv2.INTER_CUBIC
    rgb = np.asarray(cv2.warpAffine(source, matrix, (width, height), flags=way, borderMode=cv2.BORDER_REPLICATE))
    mesh = photo.mesh.copy()
    mesh[:, :2] = (photo.mesh[:, :2] + 0.5) * scale + place[:, 2] - 0.5
    mesh[:, 2] *= scale
    boxes = np.array([[*corner, *(end - corner)] for corner, end in map(_face_box, _faces(photo))], np.float32)
    people = resized(people_confidence(photo.rgb), (photo.rgb.shape[1], photo.rgb.shape[0]))
    people = np.asarray(cv2.warpAffine(people, matrix, (width, height), borderMode=cv2.BORDER_REPLICATE))
    fitted = fit_lower_lids(rgb.astype(np.uint8), mesh.astype(np.float32))
    original = (photo.rgb.shape[1], photo.rgb.shape[0])
    return TargetFace(rgb.astype(np.uint8), None, fitted, boxes, original, place, people)


def _faces(photo: FacePhoto) -> list[NDArray[np.float32]]:
    """The meshes (478, 3) of the face that acts, and of all others in the photograph."""
    low, high = _face_box(photo.mesh)

    def another(mesh: NDArray[np.float32]) -> bool:
        one, end = _face_box(mesh)
        return bool(np.linalg.norm((one + end - low - high) / 2) > np.linalg.norm(high - low) / 2)

    return [photo.mesh, *filter(another, find_faces(photo.rgb))]


def _part(photo: FacePhoto, size: tuple[int, int]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    low, high = _face_box(photo.mesh)
    height = BUST_FACE_HEIGHTS * (high[1] - low[1])
    wanted = np.array([height * size[0] / size[1], height])
    head = head_box(photo.mesh)
    wanted = np.maximum(wanted, head[1] - head[0])
    whole = np.array(photo.rgb.shape[1::-1], np.float64)
    extent = np.minimum(wanted, whole)
    corner = (low + high) / 2 - extent * (0.5, FACE_MIDDLE)
    corner = np.clip(corner, 0, whole - extent)
    return corner, corner + extent


def _face_box(mesh: NDArray[np.floating]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    oval = np.asarray(mesh, np.float64)[list(FACE_OVAL), :2]
    return oval.min(axis=0), oval.max(axis=0)
