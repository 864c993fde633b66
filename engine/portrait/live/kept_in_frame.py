"""How far a head may go: whoever sits before a camera leans and sways more than a picture's frame, or its neck, can hold.

What the head does is passed on as it is as long as it is little, and saturates smoothly where it is more: it cannot leave the frame,
and nothing jumps. Turns are limited by the head's proxy.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from engine.face_animation.target_face import TargetFace
from engine.geometry.registration.rigid import fit_similarities
from engine.perception.face.landmarks import FACE_OVAL, RIGID_VERTICES, eye_distance

MIN_REACH_EYE_DISTANCES, MAX_REACH_EYE_DISTANCES = 0.35, 0.9
"""Eye distances by which the head may go aside, or up and down: at least, and where the frame has room; beyond, shoulders would be
drawn along."""
ROOM_SHARE = 0.6
"""Share of the way from the face to the frame's edge that it may go."""
MAX_SCALE = 1.3
"""By how many times the head may grow or shrink."""


def reach_in_frame(target: TargetFace) -> NDArray[np.float64]:
    """(2,) eye distances by which the target's head may go aside, and up or down."""
    oval, size = target.mesh[list(FACE_OVAL), :2], np.array(target.size)
    room = np.minimum(oval.min(axis=0), size - oval.max(axis=0)) / float(eye_distance(target.mesh[:, :2]))
    return np.asarray(np.clip(ROOM_SHARE * room, MIN_REACH_EYE_DISTANCES, MAX_REACH_EYE_DISTANCES), float)


def kept_in_frame(
    mesh: NDArray[np.floating], rest: NDArray[np.floating], reach: NDArray[np.floating]
) -> NDArray[np.float32]:
    """A mesh (478, 3) whose head has gone from where it is at `rest` (478, 3) by no more than `reach` (2,), eye distances, and is no
    more than `MAX_SCALE` times as large or small. Its turn and its expression stay."""
    rigid = list(RIGID_VERTICES)
    scale = float(fit_similarities(rest[rigid].astype(float), mesh[None, rigid], np.ones(len(rigid)))[0][0])
    most = np.log(MAX_SCALE)
    kept_scale = float(np.exp(most * np.tanh(np.log(scale) / most)))
    from_middle, middle = mesh[rigid].mean(axis=0), rest[rigid].mean(axis=0)
    limit = reach * float(eye_distance(rest[:, :2]))
    way = limit * np.tanh((from_middle - middle)[:2] / limit)
    kept = middle + (mesh - from_middle) * (kept_scale / scale)
    kept[:, :2] += way
    return np.asarray(kept, np.float32)
