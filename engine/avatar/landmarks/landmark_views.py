"""Which view shows a landmark best: the paper's heuristics, section 3.3.

Hands and ears are looked at from the side, heels from behind, noses, mouths and eyes from the front.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from engine.avatar.landmarks.in_frames import FrameLandmarks
from engine.geometry.rigging.joint_names import SIDE_NAMES

SIDE_VIEW_LANDMARKS = ("Ear", "Index", "Pinky", "Thumb")
BACK_VIEW_LANDMARKS = ("Heel",)
FRONT_VIEW_LANDMARKS = ("Nose", "EyeInner", "Eye", "EyeOuter", "MouthLeft", "MouthRight")
"""Landmarks, but for their side, by where they are looked at from."""
SIDE_TELLING_LANDMARKS = ("Index", "Ear")
"""Landmarks whose confidence says which side of the person is seen."""
UPPER_LID_FACE_POINTS, LOWER_LID_FACE_POINTS, EYE_CORNER_POINT_PAIRS = (
    ((37, 38), (43, 44)),
    ((41, 40), (47, 46)),
    ((36, 39), (42, 45)),
)
"""Of the 68 points of a face, of both eyes."""
MIRRORED_FACE_POINTS = tuple(
    zip(
        (*range(8), *range(17, 22), 31, 32, 36, 48),
        (*range(16, 8, -1), *range(26, 21, -1), 35, 34, 45, 54),
        strict=True,
    )
)
"""Pairs of the 68 points that are each other's mirror images."""
MIDLINE_LANDMARKS = (27, 28, 29, 30, 33, 51, 57, 8)
"""Which of the 68 points lie in the middle of a face."""


def chosen_views(seen: Sequence[FrameLandmarks]) -> Mapping[str, int]:
    """The number of the view from which each landmark of the body is projected back; landmarks that no view suits are left out."""
    found: dict[str, int] = {}
    frontal = most_frontal(seen)
    for name in FRONT_VIEW_LANDMARKS:
        for one in [name] if name in ("Nose", "MouthLeft", "MouthRight") else [f"{side}{name}" for side in SIDE_NAMES]:
            if frontal is not None and one in seen[frontal].body:
                found[one] = frontal
    for side in SIDE_NAMES:
        for names, fault in ((SIDE_VIEW_LANDMARKS, _not_from_the_side), (BACK_VIEW_LANDMARKS, _not_from_behind)):
            for name in names:
                faults = [fault(one.body, side) if f"{side}{name}" in one.body else np.inf for one in seen]
                if faults and np.isfinite(min(faults)):
                    found[f"{side}{name}"] = int(np.argmin(faults))
    return found


def most_frontal(seen: Sequence[FrameLandmarks]) -> int | None:
    """The number of the view that shows a face most from the front: the most symmetric one, with the highest eyes."""
    scores = [-np.inf if one.face is None else frontality(one.face) for one in seen]
    return int(np.argmax(scores)) if scores and np.isfinite(max(scores)) else None


def frontality(face: NDArray[np.float64]) -> float:
    """How symmetric a face (68, 2) is about its centre line, 1 at the most, and how high its eyes are for their width."""
    across = face[45] - face[36]
    width = float(np.linalg.norm(across))
    if width == 0:
        return -np.inf
    along = across / width
    middle = face[list(MIDLINE_LANDMARKS)].mean(0)
    left, right = (face[list(points)] for points in zip(*MIRRORED_FACE_POINTS, strict=True))
    symmetry = 1 - float(np.abs((left - middle) @ along + (right - middle) @ along).mean()) / width
    heights = [
        np.linalg.norm(face[list(upper)].mean(0) - face[list(lower)].mean(0))
        / (np.linalg.norm(face[a] - face[b]) + 1e-9)
        for upper, lower, (a, b) in zip(
            UPPER_LID_FACE_POINTS, LOWER_LID_FACE_POINTS, EYE_CORNER_POINT_PAIRS, strict=True
        )
    ]
    return symmetry + float(np.mean(heights))


Found = Mapping[str, tuple[NDArray[np.float64], float]]


def _not_from_the_side(body: Found, side: str) -> float:
    """How wide the shoulders are for the trunk, which is least where a body is seen from the side; infinite where it is the other
    side."""
    other = SIDE_NAMES[1 - SIDE_NAMES.index(side)]
    near, far = (
        sum(body[f"{one}{name}"][1] for name in SIDE_TELLING_LANDMARKS if f"{one}{name}" in body)
        for one in (side, other)
    )
    if near <= far or not {"LeftShoulder", "RightShoulder", f"{side}Hip"} <= body.keys():
        return np.inf
    shoulders = body["LeftShoulder"][0] - body["RightShoulder"][0]
    trunk = np.linalg.norm(body[f"{side}Shoulder"][0] - body[f"{side}Hip"][0])
    return float(np.abs(shoulders[0]) / max(trunk, 1e-9))


def _not_from_behind(body: Found, side: str) -> float:
    """By how much of their distance one heel is higher than the other; infinite where feet are not seen from behind: the left one on
    the left, toes above heels."""
    if not {f"{one}{name}" for one in SIDE_NAMES for name in ("Heel", "FootIndex")} <= body.keys():
        return np.inf
    left, right = (body[f"{one}Heel"][0] for one in SIDE_NAMES)
    toes_above = all(body[f"{one}FootIndex"][0][1] < body[f"{one}Heel"][0][1] for one in SIDE_NAMES)
    if left[0] >= right[0] or not toes_above:
        return np.inf
    return float(abs(left[1] - right[1]) / (right[0] - left[0]))
