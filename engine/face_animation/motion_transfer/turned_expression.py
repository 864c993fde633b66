"""Expressions of heads that are turned aside: as even as faces are.

What a tracker guesses of a face's depth it guesses wrong by a tenth of the eyes' distance and more. By as much as a
head turns, that is seen as an expression: chin and nose slide aside, one corner of the mouth rises, one eye narrows.
All of it differs from left to right, and is the driver's own: on another face, whose depth is otherwise wrong, it is a
sheared mask. Nobody's expression is known to be lopsided in a face of which one half is hardly seen. So with the turn
the two halves take their mean; seen from the front a smirk or a wink stays what it is.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from engine.face_animation.motion_transfer.head_motion import HeadMotion
from engine.face_animation.smoothstep import smoothstep
from engine.geometry.registration.rigid import fit_similarities
from engine.perception.face.head_pose import canonical_face, mirror_vertices
from engine.perception.face.landmarks import RIGID_VERTICES

EVENING_START_RADIANS, EVENING_END_RADIANS = np.deg2rad(5.0), np.deg2rad(18.0)
"""Turns aside, radians, from which a face's halves take their mean, and from which on they do so fully."""


def even_out_turned(motion: HeadMotion) -> NDArray[np.float32]:
    """(N, 478, 3) the expression, pixels of the neutral frame, with what differs between the halves of the face taken out as far as the head is
    turned aside from the camera."""
    upright = _from_canonical(motion.neutral)
    facing = motion.rotation @ upright[:, 2]
    share = smoothstep(np.abs(np.arctan2(facing[:, 0], facing[:, 2])), EVENING_START_RADIANS, EVENING_END_RADIANS)
    frontal = motion.expression @ upright
    mirrored = frontal[:, mirror_vertices()] * (-1, 1, 1)
    even = frontal + 0.5 * share[:, None, None] * (mirrored - frontal)
    return np.asarray(even @ upright.T, np.float32)


def _from_canonical(mesh: NDArray[np.floating]) -> NDArray[np.float64]:
    """(3, 3) how a face (478, 3) is turned against the canonical one."""
    chosen = list(RIGID_VERTICES)
    source, seen = canonical_face()[chosen].astype(float), mesh[None][:, chosen]
    return np.asarray(fit_similarities(source, seen, np.ones(len(chosen)))[1][0], float)
