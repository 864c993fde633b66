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
WINDOW_SAMPLE_PIXELS = (-4, -2, 0, 2, 4)
"""Pixels from the middle of a window to its samples, in x and in y."""
WINDOW_RADIUS_PIXELS = max(WINDOW_SAMPLE_PIXELS)
"""Pixels from the middle of a window to its sides."""
WINDOW_OFFSETS = np.array(
    [(x, y) for y in WINDOW_SAMPLE_PIXELS for x in WINDOW_SAMPLE_PIXELS if (x, y) != (0, 0)], np.float32
)
"""(n, 2) x and y of the samples. Without the middle they are three times eight, and a processor does eight at once."""
SAMPLE_COUNT = len(WINDOW_OFFSETS)
(
    RIGHT_START,
    DOWN_START,
    GREY_START,
    COUNTED_START,
    PART_X_START,
    PART_Y_START,
    ABOVE_START,
    ABOVE_RIGHT_START,
    BELOW_START,
    BELOW_RIGHT_START,
) = range(0, 10 * SAMPLE_COUNT, SAMPLE_COUNT)
"""Where in the memory of a window its samples' values begin: offsets, grey levels less their mean, and 1 for those of
the body, 0 for others. Of the picture that the window is compared with, there are the places between four pixels, and
these."""
WINDOW_MEMORY = 10 * SAMPLE_COUNT
"""Values in the memory of a window: one array, so that a compiler knows what lies apart in it."""
BEST_SOURCE_COUNT = 2
"""Sources that count of those given: those that agree best; from the others the place may be hidden."""
NOISE_GREY_LEVELS = 1.0
"""Grey levels by which windows without texture differ: keeps those from matching anything."""
UNSEEN_COST = 2.0
"""Cost of a plane that a source does not see: that of pictures that are each other's negatives."""


@njit(boundscheck=False, error_model="numpy", fastmath=True)
def fill_window(grey: np.ndarray, figure: np.ndarray, x: int, y: int, window: np.ndarray) -> tuple[int, np.float32]:
    """Fill a window's memory (`WINDOW_MEMORY`,) with the body's samples about a pixel. Their number, and their variance."""
    count, mean = 0, np.float32(0)
    for k in range(SAMPLE_COUNT):
        right, down = WINDOW_OFFSETS[k, 0], WINDOW_OFFSETS[k, 1]
        px, py = x + int(right), y + int(down)
        counted = 0 <= px < grey.shape[1] and 0 <= py < grey.shape[0] and figure[py, px]
        window[RIGHT_START + k], window[DOWN_START + k], window[COUNTED_START + k] = right, down, counted
        window[GREY_START + k] = grey[py, px] if counted else np.float32(0)
        mean += window[GREY_START + k]
        count += counted
    count = max(count, 1)
    mean /= np.float32(count)
    variance = np.float32(0)
    for k in range(SAMPLE_COUNT):
        window[GREY_START + k] = window[COUNTED_START + k] * (window[GREY_START + k] - mean)
        variance += window[GREY_START + k] * window[GREY_START + k]
    return count, variance / np.float32(count)


@njit(boundscheck=False, error_model="numpy", fastmath=True)
def plane_cost(
    plane: Plane,
    ray: Ray,
    lens: np.ndarray,
    window: np.ndarray,
    places: np.ndarray,
    count: int,
    variance: np.float32,
    greys: np.ndarray,
    figures: np.ndarray,
    relative: np.ndarray,
) -> np.float32:
    """Mean over the best sources of one less the correlation of the window with what the plane sees there.

    `greys` are the sources' pictures in one row; `places` (`SAMPLE_COUNT`,) int32 is overwritten. Across a window the homography of the
    plane is taken as affine.
    """
    half, reach = np.float32(0.5), np.float32(WINDOW_RADIUS_PIXELS)
    first, second = np.float32(UNSEEN_COST), np.float32(UNSEEN_COST)
    sources, height, width = figures.shape
    offset = plane[0] * (plane[1] * ray[0] + plane[2] * ray[1] + plane[3])
    a, b, c = plane[1] / offset, plane[2] / offset, plane[3] / offset
    for s in range(sources):
        far_x, far_y, far_w = relative[s, 0, 3], relative[s, 1, 3], relative[s, 2, 3]
        # the homography of the plane, applied to the ray of the pixel, and what it makes of steps in x and y
        xx, yx, wx = relative[s, 0, 0] + far_x * a, relative[s, 1, 0] + far_y * a, relative[s, 2, 0] + far_w * a
        xy, yy, wy = relative[s, 0, 1] + far_x * b, relative[s, 1, 1] + far_y * b, relative[s, 2, 1] + far_w * b
        w = wx * ray[0] + wy * ray[1] + relative[s, 2, 2] + far_w * c
        if w <= 0:
            continue
        u = (xx * ray[0] + xy * ray[1] + relative[s, 0, 2] + far_x * c) / w
        v = (yx * ray[0] + yy * ray[1] + relative[s, 1, 2] + far_y * c) / w
        px, py = int(u + half), int(v + half)
        if not (0 <= px < width and 0 <= py < height and figures[s, py, px]):
            continue
        ux, vx = (xx - u * wx) / (w * lens[0]), (yx - v * wx) / (w * lens[0])
        uy, vy = (xy - u * wy) / (w * lens[1]), (yy - v * wy) / (w * lens[1])
        reach_u, reach_v = reach * (abs(ux) + abs(uy)), reach * (abs(vx) + abs(vy))
        if u < reach_u or v < reach_v or u + reach_u >= width - 1 or v + reach_v >= height - 1:
            continue
        begin = np.int32(s * height * width)
        value = _unlikeness(window, places, count, variance, greys, begin, np.int32(width), (u, ux, uy), (v, vx, vy))
        if value < first:
            first, second = value, first
        elif value < second:
            second = value
    return (first + second) / np.float32(BEST_SOURCE_COUNT)


@njit(boundscheck=False, error_model="numpy", fastmath=True)
def _unlikeness(
    window: np.ndarray,
    places: np.ndarray,
    count: int,
    variance: np.float32,
    greys: np.ndarray,
    begin: np.int32,
    width: np.int32,
    across: tuple[np.float32, np.float32, np.float32],
    along: tuple[np.float32, np.float32, np.float32],
) -> np.float32:
    """One less the correlation of a window with the picture that begins at `begin`. `across` and `along` say in which
    column and in which row the window's middle lies, and how these change by a pixel to the right and by one down.

    In three loops: only the one between, which fetches, is not done for eight samples at once.
    """
    for k in range(SAMPLE_COUNT):
        right, down = window[RIGHT_START + k], window[DOWN_START + k]
        u, v = across[0] + right * across[1] + down * across[2], along[0] + right * along[1] + down * along[2]
        i, j = np.int32(u), np.int32(v)
        window[PART_X_START + k], window[PART_Y_START + k] = u - np.float32(i), v - np.float32(j)
        places[k] = begin + j * width + i
    for k in range(SAMPLE_COUNT):
        at = np.uint32(places[k])
        below = np.uint32(at + np.uint32(width))
        window[ABOVE_START + k], window[ABOVE_RIGHT_START + k] = greys[at], greys[at + np.uint32(1)]
        window[BELOW_START + k], window[BELOW_RIGHT_START + k] = greys[below], greys[below + np.uint32(1)]
    total, squares, product = np.float32(0), np.float32(0), np.float32(0)
    for k in range(SAMPLE_COUNT):
        part = window[PART_X_START + k]
        upper = window[ABOVE_START + k] + part * (window[ABOVE_RIGHT_START + k] - window[ABOVE_START + k])
        lower = window[BELOW_START + k] + part * (window[BELOW_RIGHT_START + k] - window[BELOW_START + k])
        seen = upper + window[PART_Y_START + k] * (lower - upper)
        counted = window[COUNTED_START + k] * seen
        total += counted
        squares += counted * seen
        product += window[GREY_START + k] * seen
    samples, floor = np.float32(count), np.float32(NOISE_GREY_LEVELS * NOISE_GREY_LEVELS)
    mean = total / samples
    spread = max(squares / samples - mean * mean, np.float32(0))
    return np.float32(1) - product / samples / np.sqrt((variance + floor) * (spread + floor))
