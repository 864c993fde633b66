"""Where the face is, so that it does not come to lie on the back of the head."""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.character.figure.figure import Figure
from engine.imaging.masks.mask_distance import distance_inside

RIGHT_EDGE_VERTEX, NOSE_FRONT_VERTEX, LEFT_EDGE_VERTEX = 234, 1, 454
"""Vertices of the face's mesh: before the ears, and at the tip of the nose."""
PROFILE_EAR_SPREAD = 0.4
"""How far one ear is beside the other in the picture, in lengths from the eyes to the mouth, below which a head is in profile."""
BROW_DEPTH_SHARE = 0.3
"""How far below the top of the head, hair included, a face begins, as a share of the head's height."""


def face_ellipse(figure: Figure, to_grid: NDArray[np.float64], head: NDArray[np.bool_]) -> NDArray[np.float32] | None:
    """An ellipse around the face on the grid: centre x and y, half its width and height, degrees by which it is turned. It
    is as large as the mesh of the face, or where there is none, around eyes, nose and mouth. Where nobody was found, as on drawings, it is where the `head` (h, w) of the grid has it. None where there
    is neither."""
    if not figure.spatial:
        return face_within(head)
    named = ("LeftEye", "RightEye", "MouthLeft", "MouthRight", "LeftEar", "RightEar")
    place = {name: to_grid[:, :2] @ figure.point(name) + to_grid[:, 2] for name in named}
    eyes, mouth = (place["LeftEye"] + place["RightEye"]) / 2, (place["MouthLeft"] + place["MouthRight"]) / 2
    up = eyes - mouth
    length = float(np.linalg.norm(up))
    if length < 1:
        return None
    turned = np.degrees(np.arctan2(up[0], -up[1]))
    if figure.face is not None:
        axes = np.array([[-up[1], up[0]], [-up[0], -up[1]]]) / length  # across the face, and down it
        mesh = (figure.face[:, :2] @ to_grid[:, :2].T + to_grid[:, 2]) @ axes.T
        low, far = mesh.min(0), mesh.max(0)
        x, y = (low + far) / 2 @ axes
        return np.array([x, y, *(far - low) / 2, turned], np.float32)
    x, y = (eyes + mouth) / 2 + 0.1 * up
    wide = max(1.25 * length, 0.5 * float(np.linalg.norm(place["LeftEar"] - place["RightEar"])))
    return np.array([x, y, wide, 1.9 * length, turned], np.float32)


def face_turn(figure: Figure) -> float:
    """How far a face is turned: -1 fully to the picture's left, 0 to the viewer, 1 to the right, by where between its edges its
    nose is; 0 where none is seen."""
    if figure.face is None:
        return 0.0
    left, nose, right = (
        float(figure.face[vertex, 0]) for vertex in (RIGHT_EDGE_VERTEX, NOSE_FRONT_VERTEX, LEFT_EDGE_VERTEX)
    )
    return float(np.clip((2 * nose - left - right) / max(right - left, 1e-6), -1, 1)) if right > left else 0.0


def in_profile(figure: Figure) -> bool:
    """Whether a head is seen from its side: its ears lie one behind the other, and half of its face is not to be seen."""
    if not figure.spatial:
        return False
    ears, eyes, mouth = (
        np.stack([figure.point(one) for one in pair])
        for pair in (("LeftEar", "RightEar"), ("LeftEye", "RightEye"), ("MouthLeft", "MouthRight"))
    )
    up = eyes.mean(0) - mouth.mean(0)
    length = float(np.linalg.norm(up))
    if length < 1:
        return False
    across = np.array([-up[1], up[0]]) / length
    return bool(abs((ears[1] - ears[0]) @ across) < PROFILE_EAR_SPREAD * length)


def face_within(head: NDArray[np.bool_]) -> NDArray[np.float32] | None:
    """Where a face would be on a head (h, w) seen from the front: as wide as the largest circle in it, and from the brow to
    where the head ends below. None where that is no larger than a pixel."""
    depth = distance_inside(head)
    x = int(depth.argmax()) % head.shape[1]
    wide = float(depth.max())
    if wide <= 1:
        return None
    middle = np.flatnonzero(head[:, x])
    brow, chin = middle[0] + BROW_DEPTH_SHARE * (middle[-1] - middle[0]), middle[-1]
    return np.array([x, (brow + chin) / 2, wide, (chin - brow) / 2, 0], np.float32)


def within_oval(face: NDArray[np.floating], shape: tuple[int, ...]) -> NDArray[np.bool_]:
    """The pixels (h, w) in a face's oval."""
    x, y, wide, high, angle = (float(value) for value in face)
    inside = np.zeros(shape, np.uint8)
    cv2.ellipse(inside, ((x, y), (2 * wide, 2 * high), angle), (1,), -1)
    return inside > 0
