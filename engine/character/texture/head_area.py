"""Where a head is, and where on it each pixel is, seen from its face."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from engine.imaging.masks.mask_distance import distance_inside

LEVEL_BAND_HALF_AXES = 0.04
"""How far above and below a level pixels are on it, in half axes of the face's oval."""


@dataclass(frozen=True)
class Head:
    """Where a head is.

    mask : (h, w) its pixels.
    out : (h, w) how far they are from the face's middle, in half axes of its oval.
    up : (h, w) how far above it, as a share of the way to the top; below 0, to the chin.
    depth : (h, w) how far from the outline, pixels of the grid, each of which is `scale` pixels.
    across : (h, w) how far to the right of the face's middle, in half axes.
    """

    mask: NDArray[np.bool_]
    out: NDArray[np.float32]
    up: NDArray[np.float32]
    depth: NDArray[np.float32]
    scale: float
    across: NDArray[np.float32]

    def width_at(self, up: float) -> float:
        """How wide the head is so far above the face's middle, in widths of the face's oval; 0 where it is not."""
        row = self.across[self.mask & (np.abs(self.up - up) < LEVEL_BAND_HALF_AXES)]
        return float(np.ptp(row)) / 2 if len(row) else 0.0


def measure_head(own: NDArray[np.bool_], mask: NDArray[np.bool_], face: NDArray[np.floating], scale: float) -> Head:
    """The head with this `mask` and the oval of its `face`, of a person whose own colours are in `own` (h, w)."""
    x, y, wide, high, angle = (float(value) for value in face)
    rows, columns = np.indices(mask.shape, np.float32)
    turn = np.radians(angle)
    across = (np.cos(turn) * (columns - x) + np.sin(turn) * (rows - y)) / wide
    up = (np.sin(turn) * (columns - x) - np.cos(turn) * (rows - y)) / high
    depth = distance_inside(own) / scale
    return Head(mask, np.hypot(across, up), up, depth.astype(np.float32), scale, across.astype(np.float32))
