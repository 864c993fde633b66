"""A smooth warp that takes one outline to another and everything inside along.

Source: M. S. Floater, Mean value coordinates, Computer Aided Geometric Design, 2003; used as in C.-Y. Weng et al., Photo
Wake-Up, CVPR 2019, equations 6 and 8.
"""

from __future__ import annotations

import numpy as np
from numba import prange
from numpy.typing import NDArray

from engine.compiled import njit

ON_BOUNDARY = 1e-9
"""Points nearer to the outline than this, in its own unit, squared, lie on it."""


def mean_value_warp(
    points: NDArray[np.floating], polygon: NDArray[np.floating], values: NDArray[np.floating]
) -> NDArray[np.float64]:
    """What the `values` (m, C) at the corners of a closed `polygon` (m, 2) become at `points` (N, 2): (N, C).

    Linear functions are reproduced; at a corner the corner's own value comes out, on an edge the line between its two.
    Works for any polygon without self-intersections, and outside of it, too.
    """
    return np.asarray(
        _warp(
            np.ascontiguousarray(points, np.float64),
            np.ascontiguousarray(polygon, np.float64),
            np.ascontiguousarray(values, np.float64),
        )
    )


@njit(parallel=True, nogil=True, error_model="numpy")
def _warp(points, polygon, values):  # type: ignore[no-untyped-def]
    count, corners, channels = len(points), len(polygon), values.shape[1]
    out = np.zeros((count, channels))
    for k in prange(count):
        x, y = points[k, 0], points[k, 1]
        total = 0.0
        sums = np.zeros(channels)
        ax, ay = polygon[corners - 1, 0] - x, polygon[corners - 1, 1] - y
        ar = np.sqrt(ax * ax + ay * ay)
        settled = False
        last = corners - 1
        for i in range(corners):
            bx, by = polygon[i, 0] - x, polygon[i, 1] - y
            br = np.sqrt(bx * bx + by * by)
            cross = ax * by - ay * bx
            dot = ax * bx + ay * by
            if br * br < ON_BOUNDARY:
                for c in range(channels):
                    out[k, c] = values[i, c]
                settled = True
                break
            if cross * cross < ON_BOUNDARY * ON_BOUNDARY and dot <= 0:
                share = ar / (ar + br)
                for c in range(channels):
                    out[k, c] = (1 - share) * values[last, c] + share * values[i, c]
                settled = True
                break
            # tan(angle / 2) = (1 - cos) / sin, without any trigonometry; sin = cross / (ar br)
            tangent = cross / (ar * br + dot)
            wa, wb = tangent / ar, tangent / br
            total += wa + wb
            for c in range(channels):
                sums[c] += wa * values[last, c] + wb * values[i, c]
            ax, ay, ar = bx, by, br
            last = i
        if not settled:
            for c in range(channels):
                out[k, c] = sums[c] / total
    return out
