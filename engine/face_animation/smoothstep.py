"""Smoothstep: from 0 to 1 between two edges, level at both."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray


def smoothstep(value: ArrayLike, begin: float = 0.0, end: float = 1.0) -> NDArray[np.float64]:
    """Values of any shape, from 0 at `begin` and before to 1 at `end` and beyond; `end` may be the smaller one."""
    t = np.clip((np.asarray(value, float) - begin) / (end - begin), 0, 1)
    return np.asarray(t * t * (3 - 2 * t))
