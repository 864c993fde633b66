"""The avatar's face driven by a video of anybody's (the paper's figure 11): face units and the head's turn, frame by frame."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cache

import numpy as np
from numpy.typing import NDArray

from engine.body.body_space import load_body_space
from engine.body.face.face_capture import (
    CAPTURED_UNITS,
    FaceUnitModel,
    capture_face_units,
    face_unit_model,
    head_rotations,
)
from engine.body.template import load_template
from engine.errors import InputError
from engine.face_animation.driver_tracking.neutral import choose_neutral_frame
from engine.geometry.rigging.morph_target import MorphTrack
from engine.geometry.rigging.skeleton import Skeleton
from engine.media.excerpt import Excerpt
from engine.motion import rotation
from engine.motion.clip import Clip
from engine.motion.edit import repeat_loop
from engine.perception.face.head_pose import canonical_face
from engine.perception.face_track.track import NoFaceSeen, track_face

NECK_SHARE = 0.4
"""Of a head's turn: what the neck takes of it."""
REFERENCE_EYE_DISTANCE_PIXELS = 100.0
"""Pixels between the eyes of the face with which the driver's rest is compared."""


@dataclass(frozen=True)
class FacePerformance:
    """What a face does in F frames at `fps` frames a second.

    `units`: the weights of ARKit's face units.
    `head` (F, 4) float64: the head's turns, unit quaternions (x, y, z, w) in the axes of the T-pose.
    """

    fps: float
    units: MorphTrack
    head: NDArray[np.float64]


def capture_performance(
    excerpt: Excerpt,
    tick: Callable[[float], None] = lambda fraction: None,
    warn: Callable[[str, str], None] = lambda code, message: None,
) -> FacePerformance:
    """What the largest face of a video does, against its own face at rest.

    Raises
    ------
    InputError : `no_face_in_driver` where no frame shows one, and what reading the video may raise.
    """
    try:
        track = track_face(excerpt, tick=tick, warn=warn)
    except NoFaceSeen:
        raise InputError(
            "no_face_in_driver", "The driver shows no face: film one from the front, large enough.", ("driver",)
        ) from None
    reference = canonical_face() * np.float32(REFERENCE_EYE_DISTANCE_PIXELS)
    rest = track.meshes[choose_neutral_frame(track, reference, None).frame]
    weights = capture_face_units(load_face_units(), track.meshes, rest)
    head = rotation.from_matrix(head_rotations(track.meshes, rest))
    return FacePerformance(track.fps, MorphTrack(CAPTURED_UNITS, weights.astype(np.float32)), head)


def acting_clip(skeleton: Skeleton, performance: FacePerformance, body: Clip) -> Clip:
    """`body` going on for as long as the performance lasts, at its rate, with head and neck turned as it turns its head.

    Raises ValueError where `body` has another rate.
    """
    if abs(body.fps - performance.fps) > 1e-6 * body.fps:
        raise ValueError(f"a performance at {performance.fps} frames a second, and a body at {body.fps}")
    clip = repeat_loop(body, len(performance.head))
    rotations = clip.rotations.astype(np.float64)
    straight = np.broadcast_to(rotation.identity(), performance.head.shape)
    for joint, share in (("Neck", NECK_SHARE), ("Head", 1 - NECK_SHARE)):
        at = skeleton.index(joint)
        rotations[:, at] = rotation.multiply(rotation.slerp(straight, performance.head, share), rotations[:, at])
    return replace(clip, name="driver", rotations=rotations.astype(np.float32), loops=False)


@cache
def load_face_units() -> FaceUnitModel:
    """What the face units do to the landmarks of a face, once."""
    return face_unit_model(load_template(), load_body_space())
