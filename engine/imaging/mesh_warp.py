"""Inverse mapping of a deformed triangle mesh: where in the source each output pixel comes from."""

from __future__ import annotations

import numba
import numpy as np
from numpy.typing import NDArray


@numba.njit(cache=True, nogil=True, inline="always")
def _span(start: float, slope: float, first: int, last: int) -> tuple[int, int]:
    """The part of first..last where start + x * slope is not negative (by more than rounding)."""
    if slope > 1e-12:
        first = max(first, int(np.ceil((-1e-4 - start) / slope)))
    elif slope < -1e-12:
        last = min(last, int(np.floor((-1e-4 - start) / slope)))
    elif start < -1e-4:
        last = first - 1
    return first, last


@numba.njit(cache=True, fastmath=True, nogil=True)
def _rasterise(
    out_xy: NDArray[np.float32],
    depth: NDArray[np.float32],
    source: NDArray[np.float32],
    triangles: NDArray[np.int32],
    field: NDArray[np.float32],
    nearest: NDArray[np.float32],
) -> None:
    height, width = nearest.shape
    channels = field.shape[2]
    for t in range(triangles.shape[0]):
        a, b, c = triangles[t, 0], triangles[t, 1], triangles[t, 2]
        ax, ay = out_xy[a, 0], out_xy[a, 1]
        bx, by = out_xy[b, 0], out_xy[b, 1]
        cx, cy = out_xy[c, 0], out_xy[c, 1]
        area = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
        if abs(area) < 1e-9:
            continue
        y0 = max(0, int(np.ceil(min(ay, by, cy) - 1e-3)))
        y1 = min(height - 1, int(np.floor(max(ay, by, cy) + 1e-3)))
        x0 = max(0, int(np.ceil(min(ax, bx, cx) - 1e-3)))
        x1 = min(width - 1, int(np.floor(max(ax, bx, cx) + 1e-3)))
        if y0 > y1 or x0 > x1:
            continue
        inverse = 1.0 / area
        # barycentric coordinates are affine in x: wb = wb0 + x * wbx
        wbx, wcx = (cy - ay) * inverse, (ay - by) * inverse
        for y in range(y0, y1 + 1):
            wb0 = ((cx - ax) * -(y - ay) + (cy - ay) * -ax) * inverse
            wc0 = ((bx - ax) * (y - ay) - (by - ay) * -ax) * inverse
            first, last = _span(wb0, wbx, x0, x1)
            first, last = _span(wc0, wcx, first, last)
            first, last = _span(1.0 - wb0 - wc0, -wbx - wcx, first, last)
            for x in range(first, last + 1):
                wb, wc = wb0 + x * wbx, wc0 + x * wcx
                wa = 1.0 - wb - wc
                z = wa * depth[a] + wb * depth[b] + wc * depth[c]
                if z >= nearest[y, x]:
                    continue
                nearest[y, x] = z
                for k in range(channels):
                    field[y, x, k] = wa * source[a, k] + wb * source[b, k] + wc * source[c, k]


def inverse_map(
    out_xy: NDArray[np.float32],
    source: NDArray[np.float32],
    triangles: NDArray[np.int32],
    shape: tuple[int, int],
    depth: NDArray[np.float32] | None = None,
    outside: float = -1.0e4,
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
    nearest = np.full(shape, np.inf, np.float32)
    if depth is None:
        depth = np.zeros(len(out_xy), np.float32)
    _rasterise(
        np.ascontiguousarray(out_xy, np.float32),
        np.ascontiguousarray(depth, np.float32),
        np.ascontiguousarray(source, np.float32),
        np.ascontiguousarray(triangles, np.int32),
        field,
        nearest,
    )
    return field
