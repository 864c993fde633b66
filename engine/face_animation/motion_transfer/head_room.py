"""How far the picture lets a head go, and motion held back to that.

A head that its picture's border cuts has nothing to show beyond the cut, and a face that leaves the picture is none. What
the driver does is carried over as it is while there is room; nearing the end of the room it is held back, smoothly, by what
is needed and no more. The same holds for turns out of the picture plane and for coming nearer: beyond what a picture from
the front can show they saturate.
"""

from __future__ import annotations

from dataclasses import replace

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.face_animation.motion_transfer.head_motion import HeadMotion
from engine.geometry.registration.rigid import Similarity, fit_similarities
from engine.perception.face.head_pose import canonical_face
from engine.perception.face.landmarks import FACE_OVAL, NOSE_TIP_VERTEX, RIGID_VERTICES, eyes_and_chin

FREE_ROOM_SHARE = 0.5
"""Share of the room over which nothing is held back."""
FREE_FACE_ROOM_SHARE = 0.7
"""Share of the room over which the face's contour is not held back on its way to the picture's border: as it goes by
the skull's shift and by the turn."""
MIN_ROOM_FACE_LENGTHS = 0.08
"""Room that there always is, in lengths from eyes to chin."""
CUT_HAIR_SHARE = 0.35
"""Share of the hair between face and border that may come down from a border that cuts it."""
MAX_TURN_RADIANS = np.deg2rad(25.0)
"""Turns out of the picture plane beyond are held back to this, counted from the front: what one picture shows of a head's sides goes no
further. Faces are turned back to the front by as much."""
FREE_TURN_SHARE = 0.8
"""Share of the largest turn up to which nothing is held back."""
FACE_SIDE_SLANT_RADIANS = np.deg2rad(55.0)
"""By which the sides of a face, its cheeks beside the eyes, slant away from its front."""
MAX_STRETCH_RATIO = 1.8
"""By how many times the sides of a face may be drawn out where the picture shows them at a slant."""
MIN_TURN_RADIANS = np.deg2rad(6.0)
"""By which a face may turn in any direction, however far it is turned in its picture."""
MAX_LOG_SIZE_CHANGE = 0.3
"""Logarithm of the largest change of the head's size."""
PICTURE_BORDER_SHARE = 0.02
"""Share of the picture's shorter side within which its border is: a thin frame may lie along it."""
SKULL_BEHIND_EARS = 0.35
"""By how much the skull's middle lies behind the middle between the ears, in lengths from the tip of the nose to the
latter."""
MIN_PERSON_ALPHA = 0.5
"""Of a person's mask, from which on a pixel shows it."""


def head_room(mesh: NDArray[np.floating], person: NDArray[np.floating]) -> NDArray[np.float64]:
    """(2, 2) by how much a head may move: (left, up), both negative, and (right, down), pixels.

    Parameters
    ----------
    mesh : (478, 2 or 3) the face, pixels. person : (H, W) mask [0, 1].
    """
    height, width = person.shape
    oval = mesh[list(FACE_OVAL), :2]
    low, high = oval.min(axis=0), oval.max(axis=0)
    eyes, chin = eyes_and_chin(mesh)
    least = MIN_ROOM_FACE_LENGTHS * float(np.linalg.norm(chin - eyes))
    (left_most, top), (right_most, eye_line) = (
        np.clip(place, 0, (width - 1, height - 1)).astype(int) for place in (low, (high[0], eyes[1]))
    )
    rows, columns = slice(top, eye_line + 1), slice(left_most, right_most + 1)
    before, behind = low, np.array([width - 1, height - 1]) - high
    edge = max(1, round(PICTURE_BORDER_SHARE * min(person.shape)))
    sides = person[rows, :edge], person[rows, -edge:], person[:edge, columns].T
    left, right, above = (_cut_share(side) for side in sides)
    cut = np.array([[right, 0.0], [left, above]])  # a move leaves the border behind that lies opposite
    cut_room = CUT_HAIR_SHARE * np.array([behind, before])
    free = np.array([before, behind])
    room = np.maximum(np.minimum(free, cut * cut_room + (1 - cut) * free), least)
    return np.asarray(room * [[-1], [1]], float)


def cut_above(mesh: NDArray[np.floating], person: NDArray[np.floating]) -> float:
    """The share of a head's width, above the face of a mesh (478, 2 or 3), that the upper border of a `person` (H, W) cuts."""
    across = mesh[list(FACE_OVAL), 0]
    left, right = np.clip((across.min(), across.max()), 0, person.shape[1] - 1).astype(int)
    edge = max(1, round(PICTURE_BORDER_SHARE * min(person.shape)))
    return _cut_share(person[:edge, left : right + 1].T)


def _cut_share(side: NDArray[np.floating]) -> float:
    """The share of the places (N, K), K deep, along a border at which a person is cut."""
    return float(np.mean(side.max(axis=1) > MIN_PERSON_ALPHA))


def face_room(mesh: NDArray[np.floating], size: tuple[int, int]) -> NDArray[np.float64]:
    """(2, 2) by how much the contour of a face (478, 2 or 3) may move in a picture of `size` (w, h): (left, up), both negative, and (right, down),
    pixels."""
    oval = mesh[list(FACE_OVAL), :2].astype(float)
    eyes, chin = eyes_and_chin(mesh)
    least = MIN_ROOM_FACE_LENGTHS * float(np.linalg.norm(chin - eyes))
    free = np.stack([oval.min(axis=0), np.array(size) - 1 - oval.max(axis=0)])
    return np.asarray(np.maximum(free, least) * [[-1], [1]], float)


def soft_limit(
    values: NDArray[np.floating], low: NDArray[np.floating], high: NDArray[np.floating], free: float = FREE_ROOM_SHARE
) -> NDArray[np.float64]:
    """Values as they are over a `free` share of the way to `low` < 0 and `high` > 0, then ever less, never reaching them."""
    end = np.where(values < 0, -np.asarray(low), high)
    begin = free * end
    beyond = np.maximum(np.abs(values) - begin, 0)
    return np.asarray(
        np.sign(values) * (np.minimum(np.abs(values), begin) + (end - begin) * np.tanh(beyond / (end - begin)))
    )


def limit_rotation(rotation: NDArray[np.float64], turned: tuple[float, float] = (0.0, 0.0)) -> NDArray[np.float64]:
    """Rotations (N, 3, 3) with turns out of the picture plane held back softly to `MAX_TURN_RADIANS`. The picture shows
    the face `turned` out of its plane, about x and y, radians. It has less room to the side to which it is turned, and
    less to turn back (`max_counter_rotation`)."""
    limited = rotation.copy()
    own = np.asarray(turned)
    for i, r in enumerate(rotation):
        vector = cv2.Rodrigues(r)[0][:, 0]
        turn = float(np.hypot(vector[0], vector[1]))
        if turn == 0:
            continue
        along = float(own @ vector[:2]) / turn
        aside = float(own @ own) - along**2
        reach = np.sqrt(max(MAX_TURN_RADIANS**2 - aside, 0.0)) - along  # to where it would be turned by the largest
        largest = float(np.clip(min(reach, max_counter_rotation(-along)), MIN_TURN_RADIANS, MAX_TURN_RADIANS))
        start = FREE_TURN_SHARE * largest
        if turn > start:
            vector[:2] *= (start + (largest - start) * np.tanh((turn - start) / (largest - start))) / turn
            limited[i] = cv2.Rodrigues(vector)[0]
    return limited


def max_counter_rotation(turned: float) -> float:
    """How far a face may turn against the way it is turned in its picture, radians. `turned`: how far that is, radians. The limit is where the
    side that faces away in the picture is stretched by `MAX_STRETCH_RATIO`."""
    slant = min(FACE_SIDE_SLANT_RADIANS + max(turned, 0.0), np.pi / 2)
    return float(slant - np.arccos(np.clip(MAX_STRETCH_RATIO * np.cos(slant), 0, 1)))


def turned_in_picture(mesh: NDArray[np.floating]) -> tuple[float, float]:
    """By how much a face (478, 3) is turned out of the picture plane, about x and y, radians."""
    chosen = list(RIGID_VERTICES)
    rotation = fit_similarities(canonical_face()[chosen].astype(float), mesh[None][:, chosen], np.ones(len(chosen)))[1]
    x, y, _ = cv2.Rodrigues(rotation[0])[0][:, 0].tolist()
    return x, y


def skull_centre(mesh: NDArray[np.floating]) -> NDArray[np.float64]:
    """(3,) the middle of the skull, which a head turns about more nearly than about its face: behind the middle between the
    ears, seen from the nose."""
    ears = mesh[[127, 234, 93, 356, 454, 323]].mean(axis=0)
    return np.asarray(ears + SKULL_BEHIND_EARS * (ears - mesh[NOSE_TIP_VERTEX]), float)


def skull_shift(motion: HeadMotion) -> NDArray[np.float64]:
    """(N, 3) how far the middle of a driver's skull goes, pixels of the driver."""
    centre = skull_centre(motion.neutral)
    return np.asarray(motion.scale[:, None] * (motion.rotation @ centre) + motion.shift - centre)


def hold_back(
    motion: HeadMotion,
    phi: Similarity,
    room: NDArray[np.floating],
    turned: tuple[float, float] = (0.0, 0.0),
    face: NDArray[np.floating] | None = None,
) -> HeadMotion:
    """A driver's motion as far as the target can follow it: the skull's shift within `room` (2, 2), and what the `face` (2, 2) has of it, see
    `face_room`, pixels of the target.

    phi : from the driver's neutral frame to the target, in the plane. turned : as `limit_rotation` has it.
    """
    centre = skull_centre(motion.neutral)
    moved = skull_shift(motion)
    moved[:, :2] = phi.inverse().offsets(soft_limit(phi.offsets(moved[:, :2]), room[0], room[1]))
    end = np.array(MAX_LOG_SIZE_CHANGE)
    scale = np.exp(soft_limit(np.log(motion.scale), -end, end))
    rotation = limit_rotation(motion.rotation, turned)
    if face is not None:
        oval = motion.neutral[list(FACE_OVAL)]
        apart = (
            scale[:, None, None] * ((oval - centre) @ rotation.transpose(0, 2, 1)) - (oval - centre) + moved[:, None]
        )
        apart = phi.offsets(apart[..., :2])
        ends = phi.offsets(oval[:, :2])
        moved[:, :2] -= phi.inverse().offsets(_excess(apart + ends, ends, face))
    shift = centre + moved - scale[:, None] * (rotation @ centre)
    return replace(motion, scale=scale, rotation=rotation, shift=shift)


def _excess(
    contours: NDArray[np.floating], rest: NDArray[np.floating], room: NDArray[np.floating]
) -> NDArray[np.float64]:
    """(N, 2) by how much contours (N, 36, 2) go further from `rest` (36, 2) than their `room` (2, 2), at their ends to each side."""
    low = np.minimum(contours.min(axis=1) - rest.min(axis=0), 0)
    high = np.maximum(contours.max(axis=1) - rest.max(axis=0), 0)
    return np.asarray(sum(end - soft_limit(end, room[0], room[1], FREE_FACE_ROOM_SHARE) for end in (low, high)))
