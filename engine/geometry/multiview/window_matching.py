"""How well a small plane before one camera explains what others see: the correlation of slanted windows.

Source: M. Bleyer, C. Rhemann, C. Rother, PatchMatch Stereo, BMVC 2011; the best of several sources as S. Galliani, K. Lasinger,
K. Schindler, Massively Parallel Multiview Stereopsis by Surface Normal Diffusion, ICCV 2015.
"""

from __future__ import annotations

import numpy as np

from engine.compiled import njit

Plane = tuple[np.float32, np.float32, np.float32, np.float32]
"""Of a pixel: metres along the view axis to it, and its unit normal, x right, y down, z forwards."""
Ray = tuple[np.float32, np.float32]
"""Where a pixel's line of sight meets the plane at distance 1: x right, y down."""
WINDOW_RADIUS, WINDOW_STEP = 4, 2
"""Pixels from the middle of a window to its sides, and from one sample to the next."""
BEST_SOURCES = 2
"""Sources that count of those given: those that agree best; from the others the place may be hidden."""
NOISE_GREY_LEVELS = 1.0
"""Grey levels by which windows without texture differ: keeps those from matching anything."""
UNSEEN_COST = 2.0
"""Cost of a plane that a source does not see: that of pictures that are each other's negatives."""


@njit(boundscheck=False, error_model="numpy", fastmath=True)
def fill_window(grey: np.ndarray, figure: np.ndarray, x: int, y: int, window: np.ndarray) -> tuple[int, np.float32]:
    """Fill `window` (3, n) with the body's samples about a pixel: offsets in x and y and grey levels less their mean. Their
    number, and their variance."""
    count, mean = 0, np.float32(0)
    for dy in range(-WINDOW_RADIUS, WINDOW_RADIUS + 1, WINDOW_STEP):
        for dx in range(-WINDOW_RADIUS, WINDOW_RADIUS + 1, WINDOW_STEP):
            px, py = x + dx, y + dy
            if 0 <= px < grey.shape[1] and 0 <= py < grey.shape[0] and figure[py, px]:
                window[0, count], window[1, count], window[2, count] = dx, dy, grey[py, px]
                mean += grey[py, px]
                count += 1
    mean /= np.float32(count)
    variance = np.float32(0)
    for k in range(count):
        window[2, k] -= mean
        variance += window[2, k] * window[2, k]
    return count, variance / np.float32(count)


@njit(boundscheck=False, error_model="numpy", fastmath=True)
def plane_cost(
    plane: Plane,
    ray: Ray,
    lens: np.ndarray,
    window: np.ndarray,
    samples: int,
    variance: np.float32,
    greys: np.ndarray,
    figures: np.ndarray,
    relative: np.ndarray,
) -> np.float32:
    """Mean over the best sources of one less the correlation of the window with what the plane sees there."""
    one, half, reach = np.float32(1), np.float32(0.5), np.float32(WINDOW_RADIUS)
    first, second = np.float32(UNSEEN_COST), np.float32(UNSEEN_COST)
    height, width = greys.shape[1:]
    offset = plane[0] * (plane[1] * ray[0] + plane[2] * ray[1] + plane[3])
    a, b, c = plane[1] / offset, plane[2] / offset, plane[3] / offset
    total, floor = np.float32(samples), np.float32(NOISE_GREY_LEVELS * NOISE_GREY_LEVELS)
    for s in range(len(greys)):
        m = relative[s]
        # the homography of the plane, applied to the ray of the pixel and to the steps of a pixel in x and y
        xx, yx, wx = (m[0, 0] + m[0, 3] * a), (m[1, 0] + m[1, 3] * a), (m[2, 0] + m[2, 3] * a)
        xy, yy, wy = (m[0, 1] + m[0, 3] * b), (m[1, 1] + m[1, 3] * b), (m[2, 1] + m[2, 3] * b)
        x0 = xx * ray[0] + xy * ray[1] + m[0, 2] + m[0, 3] * c
        y0 = yx * ray[0] + yy * ray[1] + m[1, 2] + m[1, 3] * c
        w0 = wx * ray[0] + wy * ray[1] + m[2, 2] + m[2, 3] * c
        if w0 <= 0:
            continue
        px, py = int(x0 / w0 + half), int(y0 / w0 + half)
        if not (0 <= px < width and 0 <= py < height and figures[s, py, px]):
            continue
        xx, yx, wx = xx / lens[0], yx / lens[0], wx / lens[0]
        xy, yy, wy = xy / lens[1], yy / lens[1], wy / lens[1]
        inside = True
        for corner in range(4):
            dx, dy = (reach if corner & 1 else -reach), (reach if corner & 2 else -reach)
            w = w0 + dx * wx + dy * wy
            u, v = (x0 + dx * xx + dy * xy) / w, (y0 + dx * yx + dy * yy) / w
            inside = inside and w > 0 and 0 <= u < width - 1 and 0 <= v < height - 1
        if not inside:
            continue
        sum_h, sum_hh, sum_gh = np.float32(0), np.float32(0), np.float32(0)
        grey = greys[s].ravel()
        for k in range(samples):
            dx, dy, g = window[0, k], window[1, k], window[2, k]
            inverse = one / (w0 + dx * wx + dy * wy)
            u, v = (x0 + dx * xx + dy * xy) * inverse, (y0 + dx * yx + dy * yy) * inverse
            i, j = np.int32(u), np.int32(v)
            fu, fv = u - np.float32(i), v - np.float32(j)
            at = np.uint32(j * np.int32(width) + i)
            below = np.uint32(at + np.uint32(width))
            upper = grey[at] + fu * (grey[at + np.uint32(1)] - grey[at])
            lower = grey[below] + fu * (grey[below + np.uint32(1)] - grey[below])
            h = upper + fv * (lower - upper)
            sum_h += h
            sum_hh += h * h
            sum_gh += g * h
        mean = sum_h / total
        spread = max(sum_hh / total - mean * mean, np.float32(0))
        value = one - sum_gh / total / np.sqrt((variance + floor) * (spread + floor))
        if value < first:
            first, second = value, first
        elif value < second:
            second = value
    return (first + second) / np.float32(BEST_SOURCES)
