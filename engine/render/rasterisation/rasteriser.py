"""Triangles to pixels on the CPU: which triangle covers a pixel, where in the triangle, and how far away.

The rasteriser keeps to the rules of graphics hardware (pixel centres, top-left fill rule, vertices
snapped to 1/256 pixel, exact integer edge functions), so that neighbouring triangles share no pixel
and leave no gap. It knows no colour: shading is done afterwards, per pixel, on arrays
(`engine.render.rasterisation.attributes`).

Source of the edge-function formulation: J. Pineda, A Parallel Algorithm for Polygon Rasterization,
SIGGRAPH 1988.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import get_num_threads, prange
from numpy.typing import NDArray

from engine.compiled import njit

RASTER_SUBPIXEL_BITS = 8
"""Bits of a coordinate's fraction of a pixel."""
SUBPIXEL_STEPS = 1 << RASTER_SUBPIXEL_BITS
"""Steps of a pixel to which vertices are snapped, as graphics hardware does."""

MAX_NARROW_WIDTH_PIXELS = 6
"""Pixels up to which a triangle's rows are walked from its box's left end."""

MAX_COORDINATE_PIXELS = 2.0**21
"""Pixels beyond which a vertex is too far out and its triangles are dropped: their edge functions could overflow."""

OUT_OF_RANGE = -(1 << 31)
"""The x of a vertex that is too far out."""


class Raster(NamedTuple):
    """What covers each pixel of a picture of size (H, W).

    triangle : (H, W) int32, index of the nearest triangle, -1 where there is none.
    barycentrics : (H, W, 3) float32, weights of the triangle's three vertices, summing to one; zero where none.
    depth : (H, W) float32, depth at the pixel's centre, +inf where there is none.
    """

    triangle: NDArray[np.int32]
    barycentrics: NDArray[np.float32]
    depth: NDArray[np.float32]


def rasterise(
    vertices: NDArray[np.floating],
    triangles: NDArray[np.integer],
    size: tuple[int, int],
    perspective: bool = False,
    cull: bool = False,
) -> Raster:
    """Find the nearest triangle at each pixel's centre.

    Parameters
    ----------
    vertices : (V, 3) x and y in pixels, the centre of the top-left pixel at (0, 0), and depth, smaller is nearer.
    triangles : (T, 3) indices into `vertices`.
    size : (height, width) of the picture.
    perspective : depth is the distance along the view axis: depth and barycentrics are then interpolated
        perspectively, and triangles that reach behind the eye (depth <= 0) are left out. Otherwise all is
        linear on the screen.
    cull : leave out triangles that turn clockwise on the screen (y down): the backs of a mesh whose faces turn
        counter-clockwise seen from outside.

    Equal depths go to the triangle of the lower index.
    """
    points = np.ascontiguousarray(vertices, dtype=np.float32)
    faces = np.ascontiguousarray(triangles, dtype=np.int32)
    triangle, depth = _nearest(points, faces, size[0], size[1], perspective, cull, get_num_threads())
    return Raster(triangle, _barycentrics(points, faces, triangle, perspective), depth)


def triangle_map(
    vertices: NDArray[np.floating], triangles: NDArray[np.integer], size: tuple[int, int], perspective: bool = False
) -> NDArray[np.int32]:
    """(H, W) int32, the nearest triangle at each pixel's centre, -1 where there is none: all of a `Raster` that outlines need, in half
    the time. Parameters are those of `rasterise`."""
    points = np.ascontiguousarray(vertices, dtype=np.float32)
    faces = np.ascontiguousarray(triangles, dtype=np.int32)
    return _nearest(points, faces, size[0], size[1], perspective, False, get_num_threads())[0]


def barycentrics_at(
    vertices: NDArray[np.floating],
    corners: NDArray[np.integer],
    pixels: NDArray[np.integer],
    perspective: bool = False,
) -> NDArray[np.float32]:
    """(N, 3) float32, what a `Raster` of `vertices` (V, 3) has as barycentrics at `pixels` (N, 2), row and column, that triangles with
    `corners` (N, 3) cover."""
    points = np.asarray(vertices, np.float32).astype(np.float64)[corners]
    snapped = np.floor(points[..., :2] * SUBPIXEL_STEPS + 0.5)
    off = snapped - SUBPIXEL_STEPS * pixels[:, None, ::-1]
    after, last = np.roll(off, -1, 1), np.roll(off, -2, 1)
    weights = after[..., 1] * last[..., 0] - after[..., 0] * last[..., 1]
    if perspective:
        weights = weights / points[..., 2]
    return np.asarray(weights / weights.sum(1, keepdims=True), np.float32)


def depth_map(
    vertices: NDArray[np.floating], triangles: NDArray[np.integer], size: tuple[int, int], perspective: bool = False
) -> NDArray[np.float32]:
    """Depth alone, (H, W) float32, +inf where nothing is: what a light or a camera sees of a surface. Parameters are those of
    `rasterise`."""
    points = np.ascontiguousarray(vertices, dtype=np.float32)
    faces = np.ascontiguousarray(triangles, dtype=np.int32)
    return _nearest(points, faces, size[0], size[1], perspective, False, get_num_threads())[1]


@njit(nogil=True, boundscheck=False, error_model="numpy")
def draw_into(
    points: np.ndarray, faces: np.ndarray, perspective: bool, cull: bool, ids: np.ndarray, depths: np.ndarray
) -> None:
    """Draw triangles into what is already there, in the calling thread alone: for callers that draw several pictures
    side by side. Arrays are as in `rasterise` and `Raster`: float32 (V, 3), int32 (T, 3), int32 and float32 (H, W)."""
    places = snap_to_subpixels(points)
    first, last = np.int64(0), ids.shape[0] - 1
    for t in range(faces.shape[0]):
        _draw(places, points, faces, t, first, last, perspective, cull, ids, depths)


@njit(boundscheck=False, error_model="numpy", forceinline=True)
def _snap(value: float) -> int:
    return int(np.floor(value * SUBPIXEL_STEPS + 0.5))


@njit(nogil=True, boundscheck=False, error_model="numpy")
def snap_to_subpixels(points: np.ndarray) -> np.ndarray:
    """(V, 2) int32: x and y of `points` (V, 3) in whole `SUBPIXEL_STEPS`; x is `OUT_OF_RANGE` where a vertex is too far out."""
    places = np.empty((len(points), 2), np.int32)
    for v in range(len(points)):
        x, y = points[v, 0], points[v, 1]
        if abs(x) < MAX_COORDINATE_PIXELS and abs(y) < MAX_COORDINATE_PIXELS:
            places[v, 0], places[v, 1] = _snap(x), _snap(y)
        else:
            places[v, 0], places[v, 1] = OUT_OF_RANGE, 0
    return places


@njit(boundscheck=False, error_model="numpy", forceinline=True)
def edge_bias(dx: int, dy: int) -> int:
    """0 for a top or left edge, which owns the pixel centres lying on it; -1 for the others.

    The edge runs along (dx, dy) and the inside is to its right on the screen (y down).
    """
    return 0 if dy < 0 or (dy == 0 and dx > 0) else -1


@njit(parallel=True, boundscheck=False, error_model="numpy")
def _nearest(
    points: np.ndarray, faces: np.ndarray, height: int, width: int, perspective: bool, cull: bool, bands: int
) -> tuple[np.ndarray, np.ndarray]:
    ids, depths = np.empty((height, width), np.int32), np.empty((height, width), np.float32)
    ids[:], depths[:] = -1, np.inf
    places = snap_to_subpixels(points)
    for number in prange(bands):  # each band of rows walks all triangles in their order: bands do not change the result
        band = np.int64(number)  # not the unsigned one of `prange`, for which `_draw` would be compiled once more
        first, last = height * band // bands, height * (band + 1) // bands - 1
        for t in range(faces.shape[0]):
            _draw(places, points, faces, t, first, last, perspective, cull, ids, depths)
    return ids, depths


@njit(boundscheck=False, error_model="numpy")
def _draw(
    places: np.ndarray,
    points: np.ndarray,
    faces: np.ndarray,
    t: int,
    first: int,
    last: int,
    perspective: bool,
    cull: bool,
    ids: np.ndarray,
    depths: np.ndarray,
) -> None:
    a, b, c = faces[t, 0], faces[t, 1], faces[t, 2]
    ay, by, cy = int(places[a, 1]), int(places[b, 1]), int(places[c, 1])
    ax, bx, cx = int(places[a, 0]), int(places[b, 0]), int(places[c, 0])
    za, zb, zc = points[a, 2], points[b, 2], points[c, 2]
    if min(ax, bx, cx) == OUT_OF_RANGE or (perspective and not min(za, zb, zc) > 0):
        return
    left = max((min(ax, bx, cx) + SUBPIXEL_STEPS - 1) >> RASTER_SUBPIXEL_BITS, 0)
    right = min(max(ax, bx, cx) >> RASTER_SUBPIXEL_BITS, ids.shape[1] - 1)
    top = max((min(ay, by, cy) + SUBPIXEL_STEPS - 1) >> RASTER_SUBPIXEL_BITS, first)
    bottom = min(max(ay, by, cy) >> RASTER_SUBPIXEL_BITS, last)
    if left > right or top > bottom:
        return
    area = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
    if area == 0 or (cull and area > 0):
        return
    if area < 0:  # the inside is to the right of each edge from here on
        bx, by, zb, cx, cy, zc = cx, cy, zc, bx, by, zb
        area = -area
    if perspective:
        za, zb, zc = 1 / za, 1 / zb, 1 / zc
    px, py = left << RASTER_SUBPIXEL_BITS, top << RASTER_SUBPIXEL_BITS
    row_a = (cx - bx) * (py - by) - (cy - by) * (px - bx)
    row_b = (ax - cx) * (py - cy) - (ay - cy) * (px - cx)
    row_c = (bx - ax) * (py - ay) - (by - ay) * (px - ax)
    scale = np.float32(SUBPIXEL_STEPS) / np.float32(area)
    right_z = ((by - cy) * za + (cy - ay) * zb + (ay - by) * zc) * scale
    down_z = ((cx - bx) * za + (ax - cx) * zb + (bx - ax) * zc) * scale
    row_z = (row_a * za + row_b * zb + row_c * zc) / np.float32(area)
    row_a += edge_bias(cx - bx, cy - by)
    row_b += edge_bias(ax - cx, ay - cy)
    row_c += edge_bias(bx - ax, by - ay)
    step_a, step_b, step_c = (
        (by - cy) << RASTER_SUBPIXEL_BITS,
        (cy - ay) << RASTER_SUBPIXEL_BITS,
        (ay - by) << RASTER_SUBPIXEL_BITS,
    )
    # where a row begins is estimated for wide triangles, which are mostly slanted slivers, and then found exactly
    wide = right - left > MAX_NARROW_WIDTH_PIXELS
    to_a = -1 / np.float64(step_a) if wide and step_a > 0 else np.float64(0)
    to_b = -1 / np.float64(step_b) if wide and step_b > 0 else np.float64(0)
    to_c = -1 / np.float64(step_c) if wide and step_c > 0 else np.float64(0)
    for y in range(top, bottom + 1):
        wa, wb, wc, x = row_a, row_b, row_c, left
        if wide:
            outside = max(np.float64(row_a) * to_a, np.float64(row_b) * to_b, np.float64(row_c) * to_c)
            skipped = int(min(max(outside - 0.01, 0.0), np.float64(right + 1 - left)))
            wa, wb, wc, x = wa + skipped * step_a, wb + skipped * step_b, wc + skipped * step_c, x + skipped
        while x <= right and (wa | wb | wc) < 0:
            wa, wb, wc, x = wa + step_a, wb + step_b, wc + step_c, x + 1
        w = row_z + np.float32(x - left) * right_z
        while x <= right and (wa | wb | wc) >= 0:
            z = np.float32(1) / w if perspective else w
            if z < depths[y, x]:
                depths[y, x] = z
                ids[y, x] = t
            wa, wb, wc, x, w = wa + step_a, wb + step_b, wc + step_c, x + 1, w + right_z
        row_a += (cx - bx) << RASTER_SUBPIXEL_BITS
        row_b += (ax - cx) << RASTER_SUBPIXEL_BITS
        row_c += (bx - ax) << RASTER_SUBPIXEL_BITS
        row_z += down_z


@njit(parallel=True, boundscheck=False, error_model="numpy")
def _barycentrics(points: np.ndarray, faces: np.ndarray, ids: np.ndarray, perspective: bool) -> np.ndarray:
    height, width = ids.shape
    out = np.zeros((height, width, 3), np.float32)
    for y in prange(height):
        for x in range(width):
            t = ids[y, x]
            if t < 0:
                continue
            a, b, c = faces[t, 0], faces[t, 1], faces[t, 2]
            ax, ay = _snap(points[a, 0]), _snap(points[a, 1])
            bx, by = _snap(points[b, 0]), _snap(points[b, 1])
            cx, cy = _snap(points[c, 0]), _snap(points[c, 1])
            px, py = x * SUBPIXEL_STEPS, y * SUBPIXEL_STEPS
            wa = np.float64((cx - bx) * (py - by) - (cy - by) * (px - bx))
            wb = np.float64((ax - cx) * (py - cy) - (ay - cy) * (px - cx))
            wc = np.float64((bx - ax) * (py - ay) - (by - ay) * (px - ax))
            if perspective:
                wa /= points[a, 2]
                wb /= points[b, 2]
                wc /= points[c, 2]
            total = wa + wb + wc
            out[y, x, 0] = wa / total
            out[y, x, 1] = wb / total
            out[y, x, 2] = wc / total
    return out
