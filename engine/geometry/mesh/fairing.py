"""Closed surfaces made fair: without the ripples of what they were measured or cut from, and no smaller for it.

Source: G. Taubin, A signal processing approach to fair surface design, SIGGRAPH 1995.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from engine.geometry.mesh.adjacency import neighbours

TAUBIN_LAMBDA, TAUBIN_MU = 0.5, -0.53
"""Taubin's lambda and mu: ripples shorter than some six edges go, and the rest stays."""


def fair(vertices: NDArray[np.floating], triangles: NDArray[np.integer], rounds: int) -> NDArray[np.float64]:
    """The vertices (V, 3) of `triangles` (T, 3), each drawn `rounds` times to the mean of its neighbours and back."""
    beside = neighbours(triangles, len(vertices))
    number = np.maximum(np.asarray(beside.sum(1)).reshape(-1, 1), 1)
    moved = np.asarray(vertices, np.float64)
    for _ in range(rounds):
        for share in (TAUBIN_LAMBDA, TAUBIN_MU):
            moved = moved + share * (beside @ moved / number - moved)
    return moved
