"""The edges of lips and lids, along which a face's mesh parts: no triangle spans them.

Where lips are closed in the picture both inner edges lie on one another, and a lip's border is as near to the skin beside it as to its own next vertex. Triangles
across them tear the border of an opening mouth into teeth, and draw its corners out to knots.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from engine.perception.face.landmarks import (
    CHIN_VERTEX,
    FOREHEAD_VERTEX,
    LEFT_EYE,
    LIPS_INNER,
    LIPS_OUTER,
    RIGHT_EYE,
    eye_distance,
)

MIN_LIP_GAP_PIXELS = 0.5
"""Pixels between the inner edges of lips that are closed, in the mesh: it has two edges there."""
PARTING_CONTOURS = (LIPS_OUTER, LIPS_INNER, RIGHT_EYE, LEFT_EYE)
GIVING_WAY_EYE_DISTANCES = 0.4
"""Eye distances from the lips' border up to which the face gives way where it would fold."""


def parted_lips(face: NDArray[np.floating]) -> NDArray[np.float64]:
    """A face (478, 2 or 3), pixels, its inner lips in their order and `MIN_LIP_GAP_PIXELS` apart at least."""
    out = np.array(face, np.float64)
    half = len(LIPS_INNER) // 2
    top, bottom = np.array(LIPS_INNER[1:half]), np.array(LIPS_INNER[:half:-1])  # which face one another
    down = out[CHIN_VERTEX, :2] - out[FOREHEAD_VERTEX, :2]
    down /= np.linalg.norm(down)
    lack = np.maximum(MIN_LIP_GAP_PIXELS - (out[bottom, :2] - out[top, :2]) @ down, 0)[:, None] * down / 2
    out[top, :2] -= lack
    out[bottom, :2] += lack
    return out


def parting_edges(usable: NDArray[np.integer]) -> NDArray[np.int32]:
    """(L, 2) the edges along which a face parts, as places among its `usable` vertices (U,)."""
    place = {int(vertex): k for k, vertex in enumerate(usable)}
    pairs = [
        (place[a], place[b])
        for contour in PARTING_CONTOURS
        for a, b in zip(contour, contour[1:] + contour[:1], strict=True)
        if a in place and b in place
    ]
    return np.array(pairs, np.int32).reshape(-1, 2)


def gives_way_around_lips(face: NDArray[np.floating]) -> NDArray[np.bool_]:
    """(V,) which of the first vertices of a face (V, 2 or 3), V at least 468, lie around the lips' border, within them or on it, and not on their inner edges. Where a mouth is carried over to
    a face of another shape, or its far corner is turned away, skin and lip would be folded over one another there, in steps as wide as a triangle."""
    border = face[list(LIPS_OUTER), :2]
    away = np.linalg.norm(face[:, None, :2] - border, axis=2).min(axis=1)
    gives = away < GIVING_WAY_EYE_DISTANCES * float(eye_distance(face[:, :2]))
    gives[list(LIPS_INNER)] = False
    return np.asarray(gives, np.bool_)
