"""Inverse mapping of a deformed triangle mesh: where in the source each output pixel comes from."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from engine.compiled import njit

BARYCENTRIC_TOLERANCE = 1e-4
"""By how much a pixel may lie outside a triangle, in barycentric coordinates, and still count as in it."""
UNCOVERED_ORIGIN_PIXELS = -1.0e4
"""Pixels: where what no triangle covers is said to come from."""
UNBOUNDED_ROW_PIXELS = 1e9
"""Pixels: a bound that no row reaches."""


@njit(nogil=True, inline="always")
def _bounds(w: float, wx: float, wy: float) -> tuple[float, float, float, float]:
    """Where w + wx * dx + wy * dy is not negative: from a + b * dy to c + d * dy, as (a, b, c, d)."""
    if wx > 1e-12:
        return (-BARYCENTRIC_TOLERANCE - w) / wx, -wy / wx, UNBOUNDED_ROW_PIXELS, 0.0
    if wx < -1e-12:
        return -UNBOUNDED_ROW_PIXELS, 0.0, (-BARYCENTRIC_TOLERANCE - w) / wx, -wy / wx
    return (
        -UNBOUNDED_ROW_PIXELS,
        0.0,
        UNBOUNDED_ROW_PIXELS,
        0.0,
    )  # an edge along the row bounds rows, as the triangle's box does


@njit(nogil=True, inline="always")
def _triangle(out_xy, a, b, c, width, height):  # type: ignore[no-untyped-def]
    """A triangle's box (west, east, top, bottom) within the picture, and how the weights of corners b and c grow along
    x and y: (bdx, bdy, cdx, cdy). Its box is empty (west > east) where it covers nothing."""
    ax, ay = float(out_xy[a, 0]), float(out_xy[a, 1])
    bx, by = out_xy[b, 0] - ax, out_xy[b, 1] - ay
    cx, cy = out_xy[c, 0] - ax, out_xy[c, 1] - ay
    area = bx * cy - by * cx
    top, bottom = max(0.0, ay + min(0.0, by, cy) - 1e-3), min(height - 1.0, ay + max(0.0, by, cy) + 1e-3)
    west, east = max(0.0, ax + min(0.0, bx, cx) - 1e-3), min(width - 1.0, ax + max(0.0, bx, cx) + 1e-3)
    if abs(area) < 1e-9 or top > bottom:
        return (1.0, 0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 0.0)
    return (west, east, top, bottom), (cy / area, -cx / area, -by / area, bx / area)


@njit(nogil=True, inline="always")
def _edges(growth):  # type: ignore[no-untyped-def]
    """The bounds that a triangle's three edges set to its rows, relative to corner a."""
    bdx, bdy, cdx, cdy = growth
    return _bounds(1.0, -bdx - cdx, -bdy - cdy), _bounds(0.0, bdx, bdy), _bounds(0.0, cdx, cdy)


@njit(nogil=True, inline="always")
def _ceil(x: float) -> int:
    """Of what is not negative; faster than the library's, and called once a row."""
    whole = int(x)
    return whole + (whole < x)


@njit(nogil=True, inline="always")
def _row(edges, ax, dy, west, east):  # type: ignore[no-untyped-def]
    """The first and the last pixel of a triangle's row; the last is less where there is none."""
    (a, a_dy, a_end, a_end_dy), (b, b_dy, b_end, b_end_dy), (c, c_dy, c_end, c_end_dy) = edges
    left = max(west, ax + max(a + a_dy * dy, b + b_dy * dy, c + c_dy * dy))
    right = min(east, ax + min(a_end + a_end_dy * dy, b_end + b_end_dy * dy, c_end + c_end_dy * dy))
    return (_ceil(left), int(right)) if left <= right else (0, -1)


@njit(fastmath=True, nogil=True)
def _rasterise(
    out_xy: NDArray[np.float32],
    depth: NDArray[np.float32],
    source: NDArray[np.float32],
    triangles: NDArray[np.int32],
    field: NDArray[np.float32],
    nearest: NDArray[np.float32],
) -> None:
    """The nearest of all triangles at each pixel, of equally near ones the first."""
    height, width = nearest.shape
    channels = field.shape[2]
    along = np.zeros(channels)  # what a step along the row adds to each channel
    start = np.zeros(channels)
    for t in range(triangles.shape[0]):
        a, b, c = triangles[t, 0], triangles[t, 1], triangles[t, 2]
        (west, east, top, bottom), growth = _triangle(out_xy, a, b, c, width, height)
        if west > east:
            continue
        # all that is interpolated is affine in the place relative to corner a
        edges, (bdx, bdy, cdx, cdy) = _edges(growth), growth
        ax, ay = float(out_xy[a, 0]), float(out_xy[a, 1])
        zb, zc = depth[b] - depth[a], depth[c] - depth[a]
        zx, zy = zb * bdx + zc * cdx, zb * bdy + zc * cdy
        for k in range(channels):
            along[k] = (source[b, k] - source[a, k]) * bdx + (source[c, k] - source[a, k]) * cdx
        for y in range(_ceil(top), int(bottom) + 1):
            dy = y - ay
            first, last = _row(edges, ax, dy, west, east)
            dx = first - ax
            z = depth[a] + zx * dx + zy * dy
            wb, wc = bdx * dx + bdy * dy, cdx * dx + cdy * dy
            for k in range(channels):
                start[k] = source[a, k] + (source[b, k] - source[a, k]) * wb + (source[c, k] - source[a, k]) * wc
            for x in range(first, last + 1):
                step = x - first
                here = np.float32(z + step * zx)
                if here < nearest[y, x]:
                    nearest[y, x] = here
                    for k in range(channels):
                        field[y, x, k] = start[k] + step * along[k]


@njit(fastmath=True, nogil=True)
def _paint(
    out_xy: NDArray[np.float32],
    source: NDArray[np.float32],
    triangles: NDArray[np.int32],
    field: NDArray[np.float32],
) -> None:
    """What `_rasterise` does, for two channels and without depth, in half its time: the first triangle comes last."""
    height, width = field.shape[:2]
    for t in range(triangles.shape[0] - 1, -1, -1):
        a, b, c = triangles[t, 0], triangles[t, 1], triangles[t, 2]
        (west, east, top, bottom), growth = _triangle(out_xy, a, b, c, width, height)
        if west > east:
            continue
        edges, (bdx, bdy, cdx, cdy) = _edges(growth), growth
        ax, ay = float(out_xy[a, 0]), float(out_xy[a, 1])
        ub, uc = source[b, 0] - source[a, 0], source[c, 0] - source[a, 0]
        vb, vc = source[b, 1] - source[a, 1], source[c, 1] - source[a, 1]
        ux, uy, vx, vy = ub * bdx + uc * cdx, ub * bdy + uc * cdy, vb * bdx + vc * cdx, vb * bdy + vc * cdy
        along_u, along_v = np.float32(ux), np.float32(vx)
        for y in range(_ceil(top), int(bottom) + 1):
            dy = y - ay
            first, last = _row(edges, ax, dy, west, east)
            dx = first - ax
            u, v = np.float32(source[a, 0] + ux * dx + uy * dy), np.float32(source[a, 1] + vx * dx + vy * dy)
            for x in range(first, last + 1):
                field[y, x, 0] = u
                field[y, x, 1] = v
                u += along_u
                v += along_v


def inverse_map(
    out_xy: NDArray[np.float32],
    source: NDArray[np.float32],
    triangles: NDArray[np.int32],
    shape: tuple[int, int],
    depth: NDArray[np.float32] | None = None,
    outside: float = UNCOVERED_ORIGIN_PIXELS,
) -> NDArray[np.float32]:
    """Piecewise-linear inverse map of a mesh (Averbuch-Elor et al. 2017, section 4, "inverse mapping").

    Parameters
    ----------
    out_xy : (V, 2) vertex positions in the output, pixels.
    source : (V, C) what is interpolated: for a warp, the vertex positions in the source image, pixels.
    triangles : (T, 3) vertex indices; either orientation.
    shape : (height, width) of the output.
    depth : (V,) distance from the viewer; where triangles overlap the nearest is kept. None: the first is.
    outside : value where no triangle covers the pixel.

    Returns
    -------
    (H, W, C) float32, ready for `cv2.remap` where C is 2.
    """
    field = np.full((*shape, source.shape[1]), outside, np.float32)
    out_xy, source = np.ascontiguousarray(out_xy, np.float32), np.ascontiguousarray(source, np.float32)
    triangles = np.ascontiguousarray(triangles, np.int32)
    if depth is None and source.shape[1] == 2:
        _paint(out_xy, source, triangles, field)
    else:
        far = np.zeros(len(out_xy), np.float32) if depth is None else np.ascontiguousarray(depth, np.float32)
        _rasterise(out_xy, far, source, triangles, field, np.full(shape, np.inf, np.float32))
    return field
