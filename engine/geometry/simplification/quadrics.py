"""What it costs to take a point out of a surface: quadrics, and how differently its neighbours move.

Source: M. Garland, P. Heckbert, Surface simplification using quadric error metrics, SIGGRAPH 1997. A quadric is the
upper triangle of a symmetric 4x4 matrix, row by row: 10 numbers.
"""

from __future__ import annotations

import numpy as np

from engine.compiled import njit


@njit(nogil=True, forceinline=True)
def _add_plane(quadrics: np.ndarray, p: int, a: float, b: float, c: float, d: float, w: float) -> None:
    q = quadrics[p]
    q[0] += w * a * a
    q[1] += w * a * b
    q[2] += w * a * c
    q[3] += w * a * d
    q[4] += w * b * b
    q[5] += w * b * c
    q[6] += w * b * d
    q[7] += w * c * c
    q[8] += w * c * d
    q[9] += w * d * d


@njit(nogil=True, forceinline=True)
def _error(quadrics: np.ndarray, p: int, x: float, y: float, z: float) -> float:
    q = quadrics
    return (
        x * (q[p, 0] * x + 2 * (q[p, 1] * y + q[p, 2] * z + q[p, 3]))
        + y * (q[p, 4] * y + 2 * (q[p, 5] * z + q[p, 6]))
        + z * (q[p, 7] * z + 2 * q[p, 8]) + q[p, 9]
    )  # fmt: skip


@njit(nogil=True)
def _bend(u: int, v: int, bones: np.ndarray, weights: np.ndarray) -> float:
    """The squared difference of two points' influences."""
    total = 0.0
    for i in range(bones.shape[1]):
        total += weights[u, i] * weights[u, i] + weights[v, i] * weights[v, i]
        for j in range(bones.shape[1]):
            if bones[u, i] == bones[v, j]:
                total -= 2 * weights[u, i] * weights[v, j]
    return max(total, 0.0)


@njit(nogil=True)
def collapse_cost(
    u: int, v: int, places: np.ndarray, quadrics: np.ndarray, bones: np.ndarray, weights: np.ndarray, bending: float
) -> float:
    """What it costs that `u` goes to `v`, before its importance is counted."""
    x, y, z = places[v, 0], places[v, 1], places[v, 2]
    length = (places[u, 0] - x) ** 2 + (places[u, 1] - y) ** 2 + (places[u, 2] - z) ** 2
    cost = max(_error(quadrics, u, x, y, z) + _error(quadrics, v, x, y, z), 0.0)
    # flat places have no error: there, short edges go first
    return cost + 1e-9 * length + bending * length * length * _bend(u, v, bones, weights)


@njit(nogil=True)
def cheapest_collapses(
    ends: np.ndarray,
    places: np.ndarray,
    quadrics: np.ndarray,
    bones: np.ndarray,
    weights: np.ndarray,
    factors: np.ndarray,
    bending: float,
) -> np.ndarray:
    """(P,) what each point's cheapest collapse would cost, allowed or not."""
    least = np.empty(len(places))
    least[:] = np.inf
    for e in range(len(ends)):
        for k in range(2):
            u, v = ends[e, k], ends[e, 1 - k]
            if factors[u] < np.inf:
                least[u] = min(least[u], factors[u] * collapse_cost(u, v, places, quadrics, bones, weights, bending))
    return least


@njit(nogil=True, error_model="numpy")
def surface_quadrics(
    places: np.ndarray, faces: np.ndarray, corners: np.ndarray, edges: np.ndarray, hold: np.ndarray
) -> np.ndarray:
    """Each point's own: the planes of its triangles, by their area, and upright planes on borders and seams."""
    quadrics = np.zeros((len(places), 10))
    for t in range(len(faces)):
        a, b, c = faces[t, 0], faces[t, 1], faces[t, 2]
        ux, uy, uz = places[b, 0] - places[a, 0], places[b, 1] - places[a, 1], places[b, 2] - places[a, 2]
        vx, vy, vz = places[c, 0] - places[a, 0], places[c, 1] - places[a, 1], places[c, 2] - places[a, 2]
        nx, ny, nz = uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx
        length = np.sqrt(nx * nx + ny * ny + nz * nz)
        if length == 0:
            continue
        nx, ny, nz = nx / length, ny / length, nz / length
        d = -(nx * places[a, 0] + ny * places[a, 1] + nz * places[a, 2])
        for k in range(3):
            p, q = faces[t, k], faces[t, (k + 1) % 3]
            _add_plane(quadrics, p, nx, ny, nz, d, length / 6)
            weight = hold[edges[t, k]]
            if weight > 0:
                ex, ey, ez = places[q, 0] - places[p, 0], places[q, 1] - places[p, 1], places[q, 2] - places[p, 2]
                mx, my, mz = ey * nz - ez * ny, ez * nx - ex * nz, ex * ny - ey * nx
                size = np.sqrt(mx * mx + my * my + mz * mz)
                if size > 0:
                    mx, my, mz = mx / size, my / size, mz / size
                    e = -(mx * places[p, 0] + my * places[p, 1] + mz * places[p, 2])
                    for r in (p, q):
                        _add_plane(quadrics, r, mx, my, mz, e, weight * size * size)
    return quadrics


@njit(nogil=True)
def texture_seams(faces: np.ndarray, corners: np.ndarray, edges: np.ndarray, count: int) -> np.ndarray:
    """(E,) where the triangles at an edge name different vertices at one of its ends."""
    ends = np.empty((count, 2), np.int32)
    ends[:] = -1
    seams = np.zeros(count, np.bool_)
    for t in range(len(faces)):
        for k in range(3):
            low, high = corners[t, k], corners[t, (k + 1) % 3]
            if faces[t, k] > faces[t, (k + 1) % 3]:
                low, high = high, low
            e = edges[t, k]
            if ends[e, 0] < 0:
                ends[e, 0], ends[e, 1] = low, high
            elif ends[e, 0] != low or ends[e, 1] != high:
                seams[e] = True
    return seams
