"""A heap of priced items in two arrays, cheapest first, for loops that numba compiles."""

from __future__ import annotations

import numpy as np

from engine.compiled import njit


@njit(nogil=True)
def sift_up(keys: np.ndarray, items: np.ndarray, at: int) -> None:
    key, item = keys[at], items[at]
    while at > 0:
        above = (at - 1) // 2
        if keys[above] <= key:
            break
        keys[at], items[at] = keys[above], items[above]
        at = above
    keys[at], items[at] = key, item


@njit(nogil=True)
def sift_down(keys: np.ndarray, items: np.ndarray, size: int) -> None:
    """Restore the heap after its first entry was replaced."""
    key, item = keys[0], items[0]
    at = 0
    while True:
        below = 2 * at + 1
        if below >= size:
            break
        if below + 1 < size and keys[below + 1] < keys[below]:
            below += 1
        if keys[below] >= key:
            break
        keys[at], items[at] = keys[below], items[below]
        at = below
    keys[at], items[at] = key, item
