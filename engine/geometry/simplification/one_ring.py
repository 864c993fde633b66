"""The triangles around a point of a mesh whose edges are being collapsed, and whether they bear its going away.

The corners that meet at a point hang on a linked list (`head` of each point, `following` of each corner); corner
`3 t + k` is that of triangle `t` at its place `k`. `faces` (T, 3) name points, `corners` (T, 3) vertices.
"""

from __future__ import annotations

import numpy as np

from engine.compiled import njit

MIN_COLLAPSE_NORMAL_COSINE = 0.2
"""A collapse may not turn a triangle's normal by more than this."""

MIN_TRIANGLE_QUALITY = 1e-3
"""The area of a triangle over that of a square on its longest edge, below which it may not get."""


@njit(nogil=True)
def one_ring(
    p: int,
    faces: np.ndarray,
    alive: np.ndarray,
    head: np.ndarray,
    following: np.ndarray,
    found: np.ndarray,
    seen: np.ndarray,
) -> int:
    """The points around `p` in `found[:, 0]`, how many triangles each shares with it in `found[:, 1]`; their number,
    or -1 if they are too many. Dead corners are unhooked on the way. `seen` is all -1 before and after."""
    count = 0
    before = -1
    corner = head[p]
    while corner >= 0:
        after = following[corner]
        t = corner // 3
        if not alive[t]:
            if before < 0:
                head[p] = after
            else:
                following[before] = after
            corner = after
            continue
        before = corner
        for k in range(1, 3):
            other = faces[t, (corner - 3 * t + k) % 3]
            if seen[other] < 0:
                if count == len(found):
                    for i in range(count):
                        seen[found[i, 0]] = -1
                    return -1
                seen[other] = count
                found[count, 0], found[count, 1] = other, 0
                count += 1
            found[seen[other], 1] += 1
        corner = after
    for i in range(count):
        seen[found[i, 0]] = -1
    return count


@njit(nogil=True, error_model="numpy")
def corner_successors(
    u: int,
    v: int,
    places: np.ndarray,
    faces: np.ndarray,
    corners: np.ndarray,
    uv: np.ndarray,
    alive: np.ndarray,
    head: np.ndarray,
    following: np.ndarray,
    wedges: np.ndarray,
) -> int:
    """Whether the triangles around `u` bear its going to `v`: the number of copies of `u`, or 0 if not. `wedges`
    then say which vertex of `v` takes the place of each copy of `u`."""
    count = 0
    corner = head[u]
    while corner >= 0:  # the triangles on the edge say which copy becomes which
        t = corner // 3
        if alive[t]:
            k = corner - 3 * t
            for step in range(1, 3):
                j = (k + step) % 3
                if faces[t, j] == v:
                    mine, theirs = corners[t, k], corners[t, j]
                    known = False
                    for i in range(count):
                        if wedges[i, 0] == mine:
                            if wedges[i, 1] != theirs:
                                return 0
                            known = True
                    if not known:
                        if count == len(wedges):
                            return 0
                        wedges[count, 0], wedges[count, 1] = mine, theirs
                        count += 1
        corner = following[corner]
    x, y, z = places[v, 0], places[v, 1], places[v, 2]
    corner = head[u]
    while corner >= 0:
        t = corner // 3
        if alive[t]:
            k = corner - 3 * t
            b, c = faces[t, (k + 1) % 3], faces[t, (k + 2) % 3]
            successor = -1
            for i in range(count):
                if wedges[i, 0] == corners[t, k]:
                    successor = wedges[i, 1]
            if successor < 0:
                return 0
            if b != v and c != v:
                ex, ey, ez = places[c, 0] - places[b, 0], places[c, 1] - places[b, 1], places[c, 2] - places[b, 2]
                ux, uy, uz = places[u, 0] - places[b, 0], places[u, 1] - places[b, 1], places[u, 2] - places[b, 2]
                vx, vy, vz = x - places[b, 0], y - places[b, 1], z - places[b, 2]
                ax, ay, az = ey * uz - ez * uy, ez * ux - ex * uz, ex * uy - ey * ux
                bx, by, bz = ey * vz - ez * vy, ez * vx - ex * vz, ex * vy - ey * vx
                before, after = np.sqrt(ax * ax + ay * ay + az * az), np.sqrt(bx * bx + by * by + bz * bz)
                longest = max(
                    ex * ex + ey * ey + ez * ez,
                    vx * vx + vy * vy + vz * vz,
                    (vx - ex) ** 2 + (vy - ey) ** 2 + (vz - ez) ** 2,
                )
                if (
                    after <= MIN_TRIANGLE_QUALITY * longest
                    or ax * bx + ay * by + az * bz < MIN_COLLAPSE_NORMAL_COSINE * before * after
                ):
                    return 0
                mine, right, left = corners[t, k], corners[t, (k + 1) % 3], corners[t, (k + 2) % 3]
                fx, fy = uv[left, 0] - uv[right, 0], uv[left, 1] - uv[right, 1]
                was = fx * (uv[mine, 1] - uv[right, 1]) - fy * (uv[mine, 0] - uv[right, 0])
                now = fx * (uv[successor, 1] - uv[right, 1]) - fy * (uv[successor, 0] - uv[right, 0])
                if was * now < 0 or (now == 0 and was != 0):
                    return 0
        corner = following[corner]
    return count
