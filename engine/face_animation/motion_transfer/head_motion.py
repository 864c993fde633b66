"""The driver's motion taken apart: how the head moves as a whole, and what the face does on it."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from engine.geometry.registration.rigid import fit_similarities
from engine.perception.face.landmarks import RIGID_VERTICES

SOFT_WEIGHT = 0.01
"""What a vertex that expressions move counts for, against 1 for one of the rigid set."""


@dataclass(frozen=True)
class HeadMotion:
    """For each frame: mesh = scale * rotation @ (neutral + expression) + shift.

    neutral : (478, 3) pixels of the neutral frame.
    scale : (N,).
    rotation : (N, 3, 3).
    shift : (N, 3) pixels.
    expression : (N, 478, 3) pixels of the neutral frame.
    """

    neutral: NDArray[np.float64]
    scale: NDArray[np.float64]
    rotation: NDArray[np.float64]
    shift: NDArray[np.float64]
    expression: NDArray[np.float32]


def turn_angles(meshes: NDArray[np.floating], neutral: NDArray[np.floating]) -> NDArray[np.float64]:
    """(N,) angle in radians between each mesh's line of sight and the neutral's: turns out of the picture plane."""
    chosen = list(RIGID_VERTICES)
    rotation = fit_similarities(neutral[chosen].astype(float), meshes[:, chosen], np.ones(len(chosen)))[1]
    return np.asarray(np.arccos(np.clip(rotation[:, 2, 2], -1, 1)), float)


def split_motion(meshes: NDArray[np.floating], neutral: NDArray[np.floating]) -> HeadMotion:
    """Separate the head's rigid motion from the expression.

    Parameters
    ----------
    meshes : (N, 478, 3) tracked meshes, pixels. neutral : (478, 3) the mesh of the neutral frame.
    """
    weights = np.full(len(neutral), SOFT_WEIGHT)
    weights[list(RIGID_VERTICES)] = 1.0
    scale, rotation, shift = fit_similarities(neutral, meshes, weights)
    still = np.zeros(meshes.shape, np.float32)
    motion = HeadMotion(neutral.astype(float), scale, rotation, shift, still)
    return with_expression(motion, meshes)


def with_expression(motion: HeadMotion, meshes: NDArray[np.floating]) -> HeadMotion:
    """A motion whose expression is all that meshes (N, 478, 3) do beyond its rigid part."""
    at_rest = (meshes - motion.shift[:, None]) @ motion.rotation / motion.scale[:, None, None]
    return replace(motion, expression=(at_rest - motion.neutral).astype(np.float32))
