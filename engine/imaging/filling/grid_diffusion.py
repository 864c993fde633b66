"""Values of pixels that spread within a mask and never across a gap in it."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from engine.compiled import njit

NEIGHBOURS_8 = ((-1, -1), (-1, 0), (-1, 1), (0, -1), (0, 1), (1, -1), (1, 0), (1, 1))
"""Rows and columns from a pixel to those that share a side or a corner with it."""


def diffuse(values: NDArray[np.float32], mask: NDArray[np.bool_], rounds: int) -> NDArray[np.float32]:
    """`values` (N, C) of the N pixels of `mask` (H, W), in their order, each replaced by the mean of itself and its
    neighbours (of eight) in the mask, `rounds` times: on open ground a blur with a standard deviation of
    sqrt(2 / 3 rounds) pixels."""
    number = np.full(np.add(mask.shape, 2), -1, np.int32)
    number[1:-1, 1:-1][mask] = np.arange(len(values))
    height, width = mask.shape
    beside = [number[1 + dy : 1 + dy + height, 1 + dx : 1 + dx + width][mask] for dy, dx in NEIGHBOURS_8]
    return np.asarray(_diffuse(np.ascontiguousarray(values), np.ascontiguousarray(np.stack(beside, 1)), rounds))


@njit(nogil=True, fastmath=True, boundscheck=False, error_model="numpy")
def _diffuse(values, beside, rounds):  # type: ignore[no-untyped-def]
    now, then = values.copy(), np.empty_like(values)
    count, channels = values.shape
    for _ in range(rounds):
        for i in range(count):
            for c in range(channels):
                then[i, c] = now[i, c]
            met = 1
            for k in range(beside.shape[1]):
                j = beside[i, k]
                if j >= 0:
                    met += 1
                    for c in range(channels):
                        then[i, c] += now[j, c]
            share = np.float32(1.0) / np.float32(met)
            for c in range(channels):
                then[i, c] *= share
        now, then = then, now
    return now
