"""Seamless cloning by the membrane that interpolates boundary differences (Perez et al. 2003)."""

from __future__ import annotations

import numba
import numpy as np
from numpy.typing import NDArray


def membrane(boundary_difference: NDArray[np.float32], mask: NDArray[np.bool_]) -> NDArray[np.float32]:
    """Laplace interpolation into `mask` (H, W) of the values (H, W, C) found just outside it; 0 elsewhere.

    The mask must not touch the array's border.
    """
    values = np.where(mask[..., None], 0, boundary_difference).astype(np.float32)
    ring = np.zeros(mask.shape, bool)
    ring[1:-1, 1:-1] = ~mask[1:-1, 1:-1] & (mask[:-2, 1:-1] | mask[2:, 1:-1] | mask[1:-1, :-2] | mask[1:-1, 2:])
    values[mask] = values[ring].mean(axis=0) if ring.any() else 0
    _relax(values, mask, 80, 2 / (1 + np.pi / max(8.0, float(np.sqrt(mask.sum())))))
    return np.where(mask[..., None], values, 0).astype(np.float32)


@numba.njit(cache=True, fastmath=True)
def _relax(values, mask, sweeps, omega):  # type: ignore[no-untyped-def]
    """Successive over-relaxation in place."""
    height, width, channels = values.shape
    for _ in range(sweeps):
        for y in range(1, height - 1):
            for x in range(1, width - 1):
                if mask[y, x]:
                    for k in range(channels):
                        mean = (
                            values[y - 1, x, k] + values[y + 1, x, k] + values[y, x - 1, k] + values[y, x + 1, k]
                        ) / 4
                        values[y, x, k] += omega * (mean - values[y, x, k])
