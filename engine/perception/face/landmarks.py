"""Which of the face mesh's 478 vertices mean what."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

MESH_SIZE = 478
"""Vertices of the face mesh with irises; 468 without."""

FIDUCIALS: tuple[tuple[int, ...], ...] = tuple(
    v if isinstance(v, tuple) else (v,)
    for v in (
        *(127, 234, 93, (132, 58), (58, 172), 136, 150, 176, 152, 400, 379, 365, (397, 288), 361, 323, 454, 356),
        *(70, 63, 105, 66, 107, 336, 296, 334, 293, 300),
        *((168, 6), (197, 195), 5, 4, 75, 97, 2, 326, 305),
        *(33, 160, 158, 133, 153, 144, 362, 385, 387, 263, 373, 380),
        *(61, 39, 37, 0, 267, 269, 291, 321, 314, 17, 84, 91),
        *(78, 82, 13, 312, 308, 317, 14, 87),
    )
)
"""The 68 points of the iBUG scheme as mesh vertices; where two are named, their mean."""
_FIRST, _SECOND = np.array([(v[0], v[-1]) for v in FIDUCIALS]).T

JAW_POINTS, BROW_POINTS, NOSE_POINTS, EYE_POINTS, OUTER_LIPS, INNER_LIPS = (
    slice(0, 17),
    slice(17, 27),
    slice(27, 36),
    slice(36, 48),
    slice(48, 60),
    slice(60, 68),
)
"""The groups of the 68 points."""
JAW_LANDMARK_COUNT = JAW_POINTS.stop
"""The first of them, which lie along the jaw: where it is seen depends on the view, so that they are no points of the surface."""

FACE_OVAL = (
    *(10, 338, 297, 332, 284, 251, 389, 356, 454, 323, 361, 288, 397, 365, 379, 378, 400, 377, 152, 148, 176),
    *(149, 150, 136, 172, 58, 132, 93, 234, 127, 162, 21, 54, 103, 67, 109),
)
"""The mesh's outer contour, from the top of the forehead over the left temple and the chin."""

LIPS_OUTER = (61, 185, 40, 39, 37, 0, 267, 269, 270, 409, 291, 375, 321, 405, 314, 17, 84, 181, 91, 146)
LIPS_INNER = (78, 191, 80, 81, 82, 13, 312, 311, 310, 415, 308, 324, 318, 402, 317, 14, 87, 178, 88, 95)
"""Closed contours, from the picture's left corner over the upper lip; vertex k of one faces k of the other."""

RIGHT_EYE = (33, 246, 161, 160, 159, 158, 157, 173, 133, 155, 154, 153, 145, 144, 163, 7)
LEFT_EYE = (263, 466, 388, 387, 386, 385, 384, 398, 362, 382, 381, 380, 374, 373, 390, 249)
"""The opening between the lids, from the outer corner over the upper lid (8) to the inner corner and back."""

RIGHT_IRIS = (468, 469, 470, 471, 472)
LEFT_IRIS = (473, 474, 475, 476, 477)
"""Centre first, then four points of the rim. "Right" is the person's own right."""

RIGHT_BROW = (70, 63, 105, 66, 107, 46, 53, 52, 65, 55)
LEFT_BROW = (300, 293, 334, 296, 336, 276, 283, 282, 295, 285)

RIGHT_EYE_CORNER_VERTICES, LEFT_EYE_CORNER_VERTICES = (33, 133), (263, 362)
"""Each eye's outer corner and its inner one."""
EYE_CORNER_VERTICES = (*RIGHT_EYE_CORNER_VERTICES, *LEFT_EYE_CORNER_VERTICES)

MOUTH_CORNER_VERTICES, INNER_MOUTH_CORNER_VERTICES = (61, 291), (78, 308)
"""Of the lips' outer contour and of their inner one, from the picture's left."""
INNER_UPPER_LIP_VERTEX, INNER_LOWER_LIP_VERTEX = 13, 14
"""The middles of the lips' inner edges."""

FOREHEAD_VERTEX, CHIN_VERTEX = 10, 152
"""Where the face's axis begins and ends."""
NOSE_TIP_VERTEX, NOSE_BASE_VERTEX = 4, 2
"""The base is where the nose meets the upper lip."""

EYES_AND_NOSE_TIP = (33, 133, 159, 145, 263, 362, 386, 374, 4, 1, 5)
"""What the aligning transformation phi is estimated from (Averbuch-Elor et al. 2017, section 4)."""

RIGID_VERTICES = (
    *(10, 151, 9, 8, 168, 6, 197, 195, 5, 4, 1, 33, 133, 362, 263, 127, 356, 234, 454, 162, 389, 21, 251),
    *(54, 284, 103, 332, 67, 297, 109, 338, 19, 94, 2, 98, 327),
)
"""Vertices that expressions move little: they carry the head's pose."""


def fiducials(mesh: NDArray[np.floating]) -> NDArray[np.floating]:
    """The 68 points of one mesh or many: (..., 478, D) to (..., 68, D), same units."""
    return (mesh[..., _FIRST, :] + mesh[..., _SECOND, :]) / 2


def mouth_opening(mesh: NDArray[np.floating]) -> NDArray[np.floating]:
    """Gap between the inner lips over the mouth's width, (...): 0 is closed, 0.05 parted, 0.5 wide open."""
    right, left = MOUTH_CORNER_VERTICES
    gap = np.linalg.norm(mesh[..., INNER_UPPER_LIP_VERTEX, :2] - mesh[..., INNER_LOWER_LIP_VERTEX, :2], axis=-1)
    return gap / np.linalg.norm(mesh[..., right, :2] - mesh[..., left, :2], axis=-1)


def eye_opening(mesh: NDArray[np.floating]) -> NDArray[np.floating]:
    """Gap between the lids over the eye's width, (..., 2), right eye first: about 0.3 open, under 0.1 closed."""
    gaps = []
    for upper, lower, outer, inner in (
        ((159, 158, 160), (145, 153, 144), *RIGHT_EYE_CORNER_VERTICES),
        ((386, 385, 387), (374, 380, 373), *LEFT_EYE_CORNER_VERTICES),
    ):
        gap = np.linalg.norm(mesh[..., list(upper), :2] - mesh[..., list(lower), :2], axis=-1).mean(axis=-1)
        gaps.append(gap / np.linalg.norm(mesh[..., outer, :2] - mesh[..., inner, :2], axis=-1))
    return np.stack(gaps, axis=-1)


def eye_centres(mesh: NDArray[np.floating]) -> tuple[NDArray[np.floating], NDArray[np.floating]]:
    """The middles between the corners of the right eye and of the left one of meshes (..., 478, D), (..., D) each."""
    right, left = (
        (mesh[..., outer, :] + mesh[..., inner, :]) / 2
        for outer, inner in (RIGHT_EYE_CORNER_VERTICES, LEFT_EYE_CORNER_VERTICES)
    )
    return right, left


def eye_distance(mesh: NDArray[np.floating]) -> NDArray[np.floating]:
    """Distance between the eyes' centres, pixels, (...): the unit in which distances on a face are given."""
    right, left = eye_centres(mesh)
    return np.linalg.norm(right - left, axis=-1)


def eyes_and_chin(mesh: NDArray[np.floating]) -> tuple[NDArray[np.floating], NDArray[np.floating]]:
    """The middle between the eyes of a face (478, 2 or 3), and its chin, (2,) pixels each: the line by which lengths on a head are measured."""
    return mesh[list(EYE_CORNER_VERTICES), :2].mean(axis=0), mesh[CHIN_VERTEX, :2]
