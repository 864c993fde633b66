"""Soles: what a foot stands on is flat.

Beyond the paper. A picture shows shoes from before and above. Their undersides are the back sheet's, which follows the
template's bare foot. A foot that the fit has turned a little wrong, or that stands on a heel, comes out pointed.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from engine.geometry.mesh.surface import vertex_normals

MAX_SOLE_NORMAL_HEIGHT = -0.35
"""The upward part of the normal, at most, of what is an underside."""
GROUND_PERCENTILE = 3.0
"""Percent of a foot's vertices that may lie beneath the ground it is given: toes are round."""
MAX_SOLE_HEIGHT_METRES = 0.07
"""Metres above the ground from which on nothing is an underside: heels of shoes are not higher."""
TRIED_DROP_SHARES = (1.0, 0.75, 0.5, 0.25)
"""How far an underside goes down, if it would be seen further down."""


def with_soles(
    rest: NDArray[np.float64],
    triangles: NDArray[np.integer],
    foot: NDArray[np.integer],
    hidden: NDArray[np.bool_],
    covered: Callable[[NDArray[np.intp], NDArray[np.float64]], NDArray[np.bool_]],
) -> NDArray[np.float64]:
    """Vertices (V, 3) in T-pose, metres, with the undersides of feet brought down to the ground of each foot.

    `foot` (V,): 0 for those of one foot, 1 for those of the other, -1 for the rest. Only those are moved that are `hidden`
    (V,) in the picture, and only as far as they stay so: `covered(which, places)` tells it of some vertices (n,) in
    other places (n, 3).
    """
    moved = rest.copy()
    under = hidden & (vertex_normals(rest, triangles)[:, 1] < MAX_SOLE_NORMAL_HEIGHT)
    for side in (0, 1):
        own = foot == side
        if not own.any():
            continue
        ground = np.percentile(rest[own, 1], GROUND_PERCENTILE)
        waiting = np.flatnonzero(own & under & (rest[:, 1] - ground < MAX_SOLE_HEIGHT_METRES))
        for share in TRIED_DROP_SHARES:
            places = rest[waiting].copy()
            places[:, 1] += share * (ground - places[:, 1])
            free = covered(waiting, places)
            moved[waiting[free]] = places[free]
            waiting = waiting[~free]
    return moved
