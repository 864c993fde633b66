"""How much of each lamp's light makes its way through the hair."""

from __future__ import annotations

import numpy as np
from numba import prange
from numpy.typing import NDArray

from engine.compiled import njit
from engine.performances.modelling.chart import smooth_step
from engine.render.lighting.light import Lamps

VOXEL_METRES = 0.0016
"""Metres."""

HAIR_ABSORPTION = 0.75
"""How much of the light that meets a hair it keeps; the rest scatters on."""


def light_through(
    points: NDArray[np.floating], normals: NDArray[np.floating], widths: NDArray[np.floating], lamps: Lamps
) -> NDArray[np.float32]:
    """The share of each lamp's light that reaches points on hairs, (S, K, L) float32 in [0, 1].

    `points` (S, K, 3) and `widths` (S, K) are the hairs in the rest pose, `normals` (S, 3) the scalp at their roots:
    lamps behind the head do not reach them.
    """
    low = points.reshape(-1, 3).min(0) - 2 * VOXEL_METRES
    shape = tuple(np.ceil((points.reshape(-1, 3).max(0) - low) / VOXEL_METRES).astype(int) + 2)
    middles = 0.5 * (points[:, 1:] + points[:, :-1])
    area = np.linalg.norm(points[:, 1:] - points[:, :-1], axis=2) * 0.5 * (widths[:, 1:] + widths[:, :-1])
    density = np.zeros(shape, np.float32)
    cell = ((middles.reshape(-1, 3) - low) / VOXEL_METRES).astype(int)
    np.add.at(density, tuple(cell.T), (area.ravel() / VOXEL_METRES**3).astype(np.float32))
    facing = smooth_step(normals @ lamps.directions.T, -0.35, 0.25)
    passed = _march(
        density,
        np.ascontiguousarray(((points - low) / VOXEL_METRES).reshape(-1, 3), np.float32),
        lamps.directions,
        HAIR_ABSORPTION * VOXEL_METRES,
    )
    return passed.reshape(*points.shape[:2], -1) * facing[:, None]


@njit(parallel=True, fastmath=True)
def _march(density: np.ndarray, places: np.ndarray, directions: np.ndarray, weight: float) -> np.ndarray:
    out = np.empty((len(places), len(directions)), np.float32)
    for i in prange(len(places)):
        for k in range(len(directions)):
            total = np.float32(0)
            # the first voxel and a half is left out: a hair does not shade itself
            x = places[i, 0] + 1.5 * directions[k, 0]
            y = places[i, 1] + 1.5 * directions[k, 1]
            z = places[i, 2] + 1.5 * directions[k, 2]
            for _ in range(28):
                a, b, c = int(x), int(y), int(z)
                if a < 0 or b < 0 or c < 0 or a >= density.shape[0] or b >= density.shape[1] or c >= density.shape[2]:
                    break
                total += density[a, b, c]
                x += directions[k, 0]
                y += directions[k, 1]
                z += directions[k, 2]
            out[i, k] = np.exp(-weight * total)
    return out
