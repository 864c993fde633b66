"""A sheet that cannot tear: where a warp would fold it, its vertices give way.

Neighbours may be carried past each other where head, neck and body meet, and where a jaw opens onto a neck. The picture
then shows the edge of a fold, which looks torn. So no triangle beside or outside the face keeps less than a share of
its area. Each that would is brought back to it by the smallest move of its free vertices, round after round
(position-based dynamics: M. Mueller and others, 2007, "Position Based Dynamics", section 3.3, with the area as the
constraint). What is within bounds stays, and the moves grow with the violation, so frame follows frame evenly. Where an
edge that cannot give way has become short, as between lips that close, the area beside it may go with it. To be kept it
would have to be as high as the edge is narrow, and a vertex be thrown out of the face. And none moves further at once
than its triangle is wide.
"""

from __future__ import annotations

import numpy as np

from engine.compiled import njit

MIN_AREA_SHARE, MIN_LIP_AREA_SHARE = 0.2, 0.03
"""Share of its area that a triangle keeps, and in and around lips: these press one another thin, and what more they kept would be steps in their border."""
AREA_TOLERANCE_SHARE = 0.05
"""Share of its area by which a triangle may fall short of that."""
MAX_UNFOLDING_ROUNDS = 40
"""After so many rounds what is left folded stays so: where the face itself leaves no room."""


@njit(fastmath=True, nogil=True)
def unfold(offsets, rest, triangles, held, least):  # type: ignore[no-untyped-def]
    """Change offsets (V, 2 or more) of vertices `rest` (V, 2), in place, until no triangle (T, 3) with a free one keeps less than a share of its
    area, the `least` (T,); those that are `held` (V,) stay. Returns the rounds that it took."""
    place, gradient = np.zeros((3, 2)), np.zeros((3, 2))
    for turn in range(MAX_UNFOLDING_ROUNDS):
        clean = True
        for t in range(len(triangles)):
            a, b, c = triangles[t]
            if held[a] and held[b] and held[c]:
                continue
            for k in range(3):
                v = triangles[t, k]
                for d in range(2):
                    place[k, d] = rest[v, d] + offsets[v, d]
            whole = (rest[b, 0] - rest[a, 0]) * (rest[c, 1] - rest[a, 1]) - (rest[b, 1] - rest[a, 1]) * (
                rest[c, 0] - rest[a, 0]
            )
            sign = 1.0 if whole > 0 else -1.0
            area = (place[1, 0] - place[0, 0]) * (place[2, 1] - place[0, 1]) - (place[1, 1] - place[0, 1]) * (
                place[2, 0] - place[0, 0]
            )
            size = sign * whole
            kept = size  # of which it keeps its share: of what an edge between held vertices leaves of it
            total, longest = 1e-6, 0.0
            for k in range(3):
                one, other = place[(k + 1) % 3], place[(k + 2) % 3]
                gradient[k] = sign * (one[1] - other[1]), sign * (other[0] - one[0])
                square = gradient[k, 0] ** 2 + gradient[k, 1] ** 2
                if not held[triangles[t, k]]:
                    total += square
                    longest = max(longest, square)
                    p, q = triangles[t, (k + 1) % 3], triangles[t, (k + 2) % 3]
                    if held[p] and held[q]:
                        before = (rest[p, 0] - rest[q, 0]) ** 2 + (rest[p, 1] - rest[q, 1]) ** 2
                        kept = size * min(1.0, np.sqrt(square / max(before, 1e-6)))
            lack = least[t] * kept - sign * area
            if lack <= AREA_TOLERANCE_SHARE * kept:
                continue
            clean = False
            step = min(lack / total, np.sqrt(size / max(longest, 1e-6)))
            for k in range(3):
                v = triangles[t, k]
                if not held[v]:
                    for d in range(2):
                        offsets[v, d] += step * gradient[k, d]
        if clean:
            return turn
    return MAX_UNFOLDING_ROUNDS
