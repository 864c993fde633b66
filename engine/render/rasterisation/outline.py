"""Where a drawn surface may cover a pixel in part: along its outline, wherever that can be seen.

The outline runs along those edges of the mesh where the surface turns from the viewer, or ends. Whatever lies between
them hides what is behind it whole pixels at a time.
"""

from __future__ import annotations

import numpy as np

from engine.compiled import njit
from engine.render.rasterisation.rasteriser import OUT_OF_RANGE, snap_to_subpixels

HIDDEN_DEPTH_RATIO = 0.998
"""An edge counts as hidden where all that is seen about it is nearer than this share of its own distance."""


@njit(nogil=True, boundscheck=False, error_model="numpy")
def facings(points: np.ndarray, faces: np.ndarray) -> np.ndarray:
    """(T,) int8: 1 for triangles seen from the front, -1 from behind, 0 for those that the rasteriser leaves out.
    `points` (V, 3) as `rasteriser.draw_into` takes them with perspective."""
    places = snap_to_subpixels(points)
    found = np.zeros(faces.shape[0], np.int8)
    for t in range(faces.shape[0]):
        a, b, c = faces[t, 0], faces[t, 1], faces[t, 2]
        ax, bx, cx = int(places[a, 0]), int(places[b, 0]), int(places[c, 0])
        if min(ax, bx, cx) == OUT_OF_RANGE or not min(points[a, 2], points[b, 2], points[c, 2]) > 0:
            continue
        ay = int(places[a, 1])
        area = (bx - ax) * (places[c, 1] - ay) - (places[b, 1] - ay) * (cx - ax)
        found[t] = 1 if area < 0 else -1 if area > 0 else 0
    return found


@njit(nogil=True, boundscheck=False, error_model="numpy")
def mark_outline(
    points: np.ndarray, edges: np.ndarray, facing: np.ndarray, depths: np.ndarray, marks: np.ndarray
) -> None:
    """Set `marks` (H, W) bool where the outline touches a pixel and is not hidden by what `depths` (H, W) float32
    shows at the pixels' centres."""
    height, width = marks.shape
    half, slack = np.float32(0.5), np.float32(0.01)
    for e in range(edges.shape[0]):
        there = edges[e, 3]
        one, other = facing[edges[e, 2]], facing[there] if there >= 0 else 0
        if one == other and one != 0:
            continue
        a, b = edges[e, 0], edges[e, 1]
        xa, ya, za, xb, yb, zb = points[a, 0], points[a, 1], points[a, 2], points[b, 0], points[b, 1], points[b, 2]
        if not min(za, zb) > 0:
            continue
        if max(xa, xb) < -1 or min(xa, xb) > width or max(ya, yb) < -1 or min(ya, yb) > height:
            continue
        seen = min(za, zb) * np.float32(HIDDEN_DEPTH_RATIO)
        upright = abs(yb - ya) > abs(xb - xa)
        if upright:  # walk along the longer side; p runs, q follows
            pa, qa, pb, qb, plimit, qlimit = ya, xa, yb, xb, height, width
        else:
            pa, qa, pb, qb, plimit, qlimit = xa, ya, xb, yb, width, height
        if pa > pb:
            pa, qa, pb, qb = pb, qb, pa, qa
        slope = (qb - qa) / max(pb - pa, np.float32(1e-6))
        first = max(int(np.floor(pa - slack + half)), 0)
        last = min(int(np.floor(pb + slack + half)), plimit - 1)
        for p in range(first, last + 1):
            q1 = qa + slope * (min(max(np.float32(p) - half, pa), pb) - pa)
            q2 = qa + slope * (min(max(np.float32(p) + half, pa), pb) - pa)
            low = max(int(np.floor(min(q1, q2) - slack + half)), 0)
            high = min(int(np.floor(max(q1, q2) + slack + half)), qlimit - 1)
            for q in range(low, high + 1):
                y, x = (p, q) if upright else (q, p)
                if not marks[y, x] and _open_to_view(depths, y, x, seen):
                    marks[y, x] = True


@njit(nogil=True, boundscheck=False, inline="always")
def _open_to_view(depths: np.ndarray, y: int, x: int, distance: float) -> bool:
    """Whether anything at this distance may be seen in a pixel, or in one beside it."""
    for i in range(max(y - 1, 0), min(y + 2, depths.shape[0])):
        for j in range(max(x - 1, 0), min(x + 2, depths.shape[1])):
            if depths[i, j] >= distance:
                return True
    return False
