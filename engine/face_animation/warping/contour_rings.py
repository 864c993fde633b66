"""Rings around a face's contour, along which both control points and the mesh that follows them lie.

What a head does that turns changes fast across the contour, where the face ends and hair, ears and neck begin. Points of a regular
grid lie there at another distance from the contour everywhere, and what is interpolated between them gets waves along it.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from engine.perception.face.landmarks import FACE_OVAL, eye_distance

RING_EYE_DISTANCES = (0.06, 0.14, 0.26, 0.42)
"""How far outside the contour rings lie, in eye distances."""
CURVE_STEPS = 4
"""Points of the round contour for each of its vertices: where the picture stretches on one side of it alone, corners would show."""


def contour_rings(mesh: NDArray[np.floating], shape: tuple[int, int]) -> NDArray[np.float64]:
    """(R, 2) points around the face of a mesh (478, 2 or 3), pixels, within a picture of `shape` (height, width). Three
    lie on its contour, which is round, between each two of its vertices. The others are rings around it."""
    curve = round_contour(mesh[list(FACE_OVAL), :2].astype(float))
    between = curve[np.arange(len(curve)) % CURVE_STEPS > 0]
    forward = np.roll(curve, -1, axis=0) - np.roll(curve, 1, axis=0)
    outward = forward[:, ::-1] * (1, -1) / np.linalg.norm(forward, axis=1, keepdims=True)
    reach = np.array(RING_EYE_DISTANCES) * float(eye_distance(mesh[:, :2]))
    around = (curve[::2] + reach[:, None, None] * outward[::2]).reshape(-1, 2)
    points = np.concatenate([between, around])
    return points[((points > 1) & (points < (shape[1] - 2, shape[0] - 2))).all(axis=1)]


def round_contour(oval: NDArray[np.float64]) -> NDArray[np.float64]:
    """(36 `CURVE_STEPS`, 2) points of the closed Catmull-Rom spline through the contour's vertices (36, 2), beginning with the first."""
    before, after, later = (np.roll(oval, shift, axis=0) for shift in (1, -1, -2))
    t = (np.arange(CURVE_STEPS) / CURVE_STEPS)[:, None, None]
    linear, square, cube = (
        after - before,
        2 * before - 5 * oval + 4 * after - later,
        3 * (oval - after) + later - before,
    )
    return np.asarray((oval + t * (linear + t * (square + t * cube)) / 2).transpose(1, 0, 2).reshape(-1, 2))


def rings_end(mesh: NDArray[np.floating]) -> float:
    """How far outside the contour the outermost ring lies, pixels."""
    return RING_EYE_DISTANCES[-1] * float(eye_distance(mesh[:, :2]))
