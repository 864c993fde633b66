"""Shoulders in T-pose, which nobody was filmed in.

Blended turns lose volume where arm and trunk share the skin. Whoever was filmed with hanging arms has it, and undoing the
blend makes a point above the shoulder of what it lacked. So there the T-pose is the space of bodies' own, changed as
smoothly as what is around it asks for.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from engine.avatar.registration.models import HumanModels
from engine.avatar.registration.template_skin.skin import grown
from engine.geometry.deformation.smooth_field import smooth_field
from engine.geometry.rigging.joint_names import SIDE_NAMES

MIN_SHARED_WEIGHT = 0.01
"""What arm and trunk each move of the skin, at least, where they share it."""

SURROUNDING_RINGS = 3
"""Rings of vertices about that, over which the rim of the point runs out."""


def with_resting_shoulders(
    models: HumanModels, flat: NDArray[np.floating], coefficients: NDArray[np.floating]
) -> NDArray[np.float64]:
    """The template's vertices (V, 3) in T-pose, metres, from those whose blend was undone, `flat` (V, 3). `coefficients` (K,): the
    person's in the space of bodies."""
    skin = models.skin
    shared = np.zeros(len(skin.vertices), np.bool_)
    for side in SIDE_NAMES:
        by_arm = models.rig.weights_below(f"{side}Arm")[skin.vertices]
        shared |= (by_arm > MIN_SHARED_WEIGHT) & (by_arm < 1 - MIN_SHARED_WEIGHT)
    shared = grown(shared, skin.triangles, SURROUNDING_RINGS)
    known = models.space.vertices(coefficients)[skin.vertices]
    out = np.array(flat, np.float64)
    change = smooth_field(skin.triangles, shared, out[skin.vertices] - known)
    out[skin.vertices[shared]] = (known + change)[shared]
    return out
