"""Feet in shoes: toes under one smooth cap, soles flat.

Bare toes that are laid on a shoe become claws. What a cloud of shoes is fitted with is this shape instead; its vertices are the
template's, so that nothing else need know.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from engine.body.garments.toe_cap import ToeCap
from engine.geometry.surface import vertex_normals

CAP_BLUNTNESS = 2.6
"""Exponent of the superellipse along a cap: 2 is an ellipsoid, more is blunter."""
CAP_REACH = 1.1
"""How far caps reach before the rim, in lengths of the toes there."""
SIDE_NORMAL, SOLE_NORMAL = -0.2, -0.7
"""The vertical part of the normals where the sides of a foot end, and where all is sole."""
SOLE_RISE = 0.035
"""Metres above the lowest point within which what faces down is sole, the arch included."""


def shod(
    vertices: NDArray[np.floating],
    triangles: NDArray[np.integer],
    feet: Sequence[NDArray[np.bool_]],
    caps: Sequence[ToeCap],
) -> NDArray[np.float64]:
    """The skin (S, 3), standing with y up, with both `feet` (S,) in shoes that end in `caps`."""
    out = np.array(vertices, np.float64)
    for foot, cap in zip(feet, caps, strict=True):
        ground = out[foot, 1].min()
        out[cap.inside] = _cap_places(out, cap, ground)
        facing = vertex_normals(out, triangles)[:, 1]
        flat = np.clip((SIDE_NORMAL - facing) / (SIDE_NORMAL - SOLE_NORMAL), 0, 1)
        flat = np.where(foot & (out[:, 1] < ground + SOLE_RISE), flat * flat * (3 - 2 * flat), 0)
        out[:, 1] += flat * (ground - out[:, 1])
    return out


def _cap_places(vertices: NDArray[np.float64], cap: ToeCap, ground: float) -> NDArray[np.float64]:
    """(M, 3) of the toes' vertices: half an ellipsoid before the rim, on the ground below."""
    rim, toes = vertices[cap.rim], vertices[cap.inside]
    middle = rim.mean(0)
    ahead = (toes.mean(0) - middle) * [1, 0, 1]
    ahead /= np.linalg.norm(ahead)
    reach = CAP_REACH * ((toes - middle) @ ahead).max()
    radius = np.minimum(np.linalg.norm(cap.disk, axis=1), 1)
    turn = np.mod(np.arctan2(cap.disk[:, 1], cap.disk[:, 0]), 2 * np.pi)
    lengths = np.linalg.norm(np.roll(rim, -1, 0) - rim, axis=1)
    stations = 2 * np.pi * np.concatenate([[0], np.cumsum(lengths)]) / lengths.sum()
    closed = np.concatenate([rim, rim[:1]])
    border = np.stack([np.interp(turn, stations, closed[:, axis]) for axis in range(3)], 1)
    across = np.sin(radius * np.pi / 2)
    ahead_by = (1 - across**CAP_BLUNTNESS) ** (1 / CAP_BLUNTNESS)
    places = middle + (border - middle) * across[:, None] + ahead * (reach * ahead_by)[:, None]
    lift = (middle[1] - ground) * 0.35
    places[:, 1] -= lift * ahead_by
    places[:, 1] = np.maximum(places[:, 1], ground)
    return places
