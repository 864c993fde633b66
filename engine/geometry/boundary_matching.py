"""Which point of one closed outline belongs to which of another: near, in order, and without large jumps.

Source: C.-Y. Weng et al., Photo Wake-Up, CVPR 2019, section 4.1.1, equations 9 to 11.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from engine.compiled import njit

MAX_ADVANCE_POINTS = 32
"""By how many points the match may advance from one point to the next (the paper's value)."""


def match_boundaries(
    outline: NDArray[np.floating], reference: NDArray[np.floating], kappa: int = MAX_ADVANCE_POINTS
) -> NDArray[np.intp]:
    """The index in `reference` (n, 2) that each point of `outline` (m, 2) belongs to: (m,).

    Both are closed polygons that turn the same way. Going once around the outline goes once around the reference, never
    backwards and never by more than `kappa` points at once (more where n is so large that it could not get around).

    The sum of distances is minimised by dynamic programming. Where the circle is cut open matters, so it is cut twice:
    at the point with the nearest partner, and again opposite, where the first round has found the partner.
    """
    points = np.ascontiguousarray(outline, np.float64)
    partners = np.ascontiguousarray(reference, np.float64)
    m, n = len(points), len(partners)
    kappa = max(kappa, -(-2 * n // m))
    nearest = np.array([((partners - point) ** 2).sum(1).min() for point in points])
    cut = int(np.argmin(nearest))
    start = int(np.argmin(((partners - points[cut]) ** 2).sum(1)))
    for _ in range(2):
        path = _path(np.roll(points, -cut, 0), np.roll(partners, -start, 0), kappa)
        matched = np.empty(m, np.intp)
        matched[(np.arange(m) + cut) % m] = (path[:m] + start) % n
        cut = (cut + m // 2) % m
        start = int(matched[cut])
    return matched


def match_curves(
    curve: NDArray[np.floating], reference: NDArray[np.floating], kappa: int = MAX_ADVANCE_POINTS
) -> NDArray[np.intp]:
    """Match two open curves whose ends belong together: (m,) indices, the first 0, the last n - 1."""
    points = np.ascontiguousarray(curve, np.float64)
    partners = np.ascontiguousarray(reference, np.float64)
    kappa = max(kappa, -(-2 * len(partners) // max(len(points) - 1, 1)))
    return _open_path(points, partners, kappa)


def _path(points: NDArray[np.float64], partners: NDArray[np.float64], kappa: int) -> NDArray[np.intp]:
    """Match the closed curves, point 0 with partner 0: an open match to where both have come around."""
    return _open_path(np.vstack([points, points[:1]]), np.vstack([partners, partners[:1]]), kappa)


@njit(nogil=True)
def _open_path(points, partners, kappa):  # type: ignore[no-untyped-def]
    m, n = len(points), len(partners)
    steps = np.zeros((m, n), np.int32)
    cost = np.full(n, np.inf)
    cost[0] = np.hypot(points[0, 0] - partners[0, 0], points[0, 1] - partners[0, 1])
    window = np.empty(n, np.int64)
    for i in range(1, m):
        head, tail = 0, 0
        fresh = np.full(n, np.inf)
        for j in range(n):
            while tail > head and cost[window[tail - 1]] >= cost[j]:
                tail -= 1
            window[tail] = j
            tail += 1
            while window[head] < j - kappa:
                head += 1
            best = window[head]
            if np.isfinite(cost[best]):
                fresh[j] = cost[best] + np.hypot(points[i, 0] - partners[j, 0], points[i, 1] - partners[j, 1])
                steps[i, j] = j - best
        cost = fresh
    path = np.zeros(m, np.int64)
    at = n - 1
    for i in range(m - 1, -1, -1):
        path[i] = at
        at -= steps[i, at]
    return path
