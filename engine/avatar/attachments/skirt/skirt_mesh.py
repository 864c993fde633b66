"""The surface of cloth around both legs: one ring, outside and inside, that comes out of the skin of the hips and ends in a hem."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from engine.avatar.attachments.piece_mesh import Mesh
from engine.avatar.attachments.skirt.skirt import LEVEL_STEP_METRES, Skirt, directions
from engine.avatar.attachments.solid import SKIN_COVER_METRES, SKIN_OVERLAP_METRES
from engine.face_animation.smoothstep import smoothstep

ROW_COUNT = 14
"""Rows of vertices from the hem to the upper end, outside as inside."""
RING_THICKNESS_METRES = 0.004
"""Metres from the outside of cloth to its inside."""
HEM_ROUND_METRES = 0.002
"""Metres by which a hem's edge is lower than both its sides."""


def skirt_mesh(skirt: Skirt) -> Mesh:
    """The closed surface, vertices (V, 3) and triangles (T, 3), counter-clockwise from outside. Its upper end is hidden within the hips."""
    top = skirt.heights[-1]
    up = np.linspace(0, 1, ROW_COUNT)
    heights = skirt.hem[:, None] + up * (top - skirt.hem[:, None])
    outside = _outside(skirt, heights)
    inside = outside - RING_THICKNESS_METRES
    middle = (skirt.hem - HEM_ROUND_METRES)[:, None]
    ring_heights = np.concatenate([heights[:, ::-1], middle, heights], 1)
    ring_radii = np.concatenate([outside[:, ::-1], (outside[:, :1] + inside[:, :1]) / 2, inside], 1)
    ways = directions(skirt.legs, skirt.turns)
    level = skirt.legs.axis + ring_radii[..., None] * ways[:, None]
    places = np.stack([level[..., 0], ring_heights, level[..., 1]], 2)
    count, around = ring_radii.shape
    turn, along = (one.ravel() for one in np.meshgrid(np.arange(count), np.arange(around), indexing="ij"))
    following, ahead = (turn + 1) % count, (along + 1) % around
    a, b, c, d = turn * around + along, following * around + along, following * around + ahead, turn * around + ahead
    triangles = np.concatenate([np.stack([a, b, c], 1), np.stack([a, c, d], 1)])
    return places.reshape(-1, 3), triangles.astype(np.int32)


def _outside(skirt: Skirt, heights: NDArray[np.float64]) -> NDArray[np.float64]:
    """(A, N) metres from the axis to the outside of the cloth at `heights` (A, N): over the skin up to the crotch, and from there on into
    it."""
    rows = (heights - skirt.heights[0]) / LEVEL_STEP_METRES
    columns = np.broadcast_to(np.arange(len(heights))[:, None], heights.shape)
    cloth, skin = (
        ndimage.map_coordinates(of, [columns, rows], order=1, mode="nearest") for of in (skirt.radii, skirt.skin)
    )
    into = smoothstep(heights, skirt.legs.crotch, skirt.heights[-1])
    over = np.maximum(cloth, skin + SKIN_COVER_METRES)
    return np.asarray(over + into * (skin - SKIN_OVERLAP_METRES - over))
