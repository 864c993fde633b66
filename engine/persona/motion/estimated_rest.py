"""A face at rest, estimated from one picture of it with an expression.

Of all faces at rest and all that face units make of them, the most probable: people at rest differ from the general face by so much,
and units are as a rule at little. The paper has many pictures of everybody and needs no such thing.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import lsq_linear

from engine.perception.expression.features import frontalise
from engine.perception.face.head_pose import canonical_face
from engine.persona.motion.mesh_units import load_mesh_units

REST_SPREAD_EYE_DISTANCES = 0.06
"""Eye distances by which vertices at rest differ from the general face's: of the rest frames of seventeen drivers, 0.04 to 0.06."""
FREE_VERTICES = 30
"""Vertices move with those about them: all of them together tell as much as so many would that move by themselves."""
USUAL_ACTIVATION = 0.5
"""Standard deviation of a unit's activation about none."""


def estimated_rest(front: NDArray[np.floating]) -> NDArray[np.float64]:
    """(478, 3) the face at rest of which `front` (478, 3), turned to the front, in eye distances, shows an expression."""
    units = load_mesh_units()
    general = frontalise(canonical_face()[None].astype(np.float64))[0]
    weight = np.sqrt(FREE_VERTICES / len(front)) / REST_SPREAD_EYE_DISTANCES
    told = weight * units.moved.reshape(len(units.moved), -1).T
    system = np.vstack([told, np.eye(len(units.moved)) / USUAL_ACTIVATION])
    shown = np.concatenate([weight * (front - general).ravel(), np.zeros(len(units.moved))])
    activations = lsq_linear(system, shown, (0, 1)).x
    return np.asarray(front - np.einsum("u,uvc->vc", activations, units.moved), np.float64)
