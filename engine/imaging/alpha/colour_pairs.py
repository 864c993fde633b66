"""Alpha from pairs of colours: a mixed pixel lies on the line between a front and a back colour.

After Gastal and Oliveira, "Shared sampling for real-time alpha matting", Eurographics 2010: from each unknown pixel
rays run in all directions. The first known pixels they meet, a little inside of either side, are the candidates. The
pair that explains the colour best, and is near, gives alpha.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from engine.compiled import njit

SEARCH_DIRECTIONS = 8
"""Directions searched; neighbouring pixels use different sets of them, so that together they see more."""

COLOUR_NOISE_GREY_LEVELS = 6.0
"""Grey levels by which a mixed colour may miss the line between its pair without losing confidence."""


def alpha_from_colour_pairs(
    rgb: NDArray[np.uint8], trimap: NDArray[np.float32], reach: int | None = None
) -> tuple[NDArray[np.float32], NDArray[np.float32]]:
    """Alpha and its confidence, both (H, W) in [0, 1], for the pixels where the trimap is neither 0 nor 1.

    `reach` is how far the rays run, in pixels (default: a quarter of the longer side). Confidence is low
    where no pair explains the colour, and where front and back have nearly the same colour.
    """
    alpha = trimap.astype(np.float32)
    confidence = np.zeros(trimap.shape, np.float32)
    _search(np.ascontiguousarray(rgb), trimap, reach or max(rgb.shape) // 4, alpha, confidence)
    return alpha, confidence


@njit(fastmath=True, nogil=True)
def _search(rgb, trimap, reach, alpha_out, confidence_out):  # type: ignore[no-untyped-def]
    height, width = trimap.shape
    front = np.empty((2 * SEARCH_DIRECTIONS, 4), np.float32)
    back = np.empty((2 * SEARCH_DIRECTIONS, 4), np.float32)
    for y in range(height):
        for x in range(width):
            if trimap[y, x] <= 0 or trimap[y, x] >= 1:
                continue
            fronts = backs = 0
            turn = ((x % 3) * 3 + y % 3) / 9.0
            for ray in range(SEARCH_DIRECTIONS):
                angle = 2 * np.pi * (ray + turn) / SEARCH_DIRECTIONS
                dx, dy = np.cos(angle), np.sin(angle)
                has_front = has_back = False
                steps = 1.0
                while steps < reach and not (has_front and has_back):
                    px, py = int(x + dx * steps + 0.5), int(y + dy * steps + 0.5)
                    if px < 0 or py < 0 or px >= width or py >= height:
                        break
                    side = trimap[py, px]
                    if side >= 1 and not has_front:
                        has_front = True
                        for c in range(3):
                            front[fronts, c] = rgb[py, px, c]
                        front[fronts, 3] = steps
                        fronts += 1
                    elif side <= 0 and not has_back:
                        has_back = True
                        for c in range(3):
                            back[backs, c] = rgb[py, px, c]
                        back[backs, 3] = steps
                        backs += 1
                    steps += 1.0 if steps < 24 else steps / 24
            if fronts == 0 or backs == 0:
                continue
            near_front = near_back = np.float32(1e9)
            for i in range(fronts):
                near_front = min(near_front, front[i, 3])
            for j in range(backs):
                near_back = min(near_back, back[j, 3])
            best = np.float32(1e9)
            best_alpha = best_miss = best_gap = np.float32(0)
            r, g, b = np.float32(rgb[y, x, 0]), np.float32(rgb[y, x, 1]), np.float32(rgb[y, x, 2])
            for i in range(fronts):
                for j in range(backs):
                    d0, d1, d2 = front[i, 0] - back[j, 0], front[i, 1] - back[j, 1], front[i, 2] - back[j, 2]
                    gap = d0 * d0 + d1 * d1 + d2 * d2
                    a = ((r - back[j, 0]) * d0 + (g - back[j, 1]) * d1 + (b - back[j, 2]) * d2) / max(gap, 1.0)
                    a = min(max(a, 0.0), 1.0)
                    m0, m1, m2 = r - back[j, 0] - a * d0, g - back[j, 1] - a * d1, b - back[j, 2] - a * d2
                    miss = m0 * m0 + m1 * m1 + m2 * m2
                    cost = miss / (COLOUR_NOISE_GREY_LEVELS * COLOUR_NOISE_GREY_LEVELS) + 0.5 * (
                        front[i, 3] / near_front + back[j, 3] / near_back
                    )
                    if cost < best:
                        best, best_alpha, best_miss, best_gap = cost, a, miss, gap
            alpha_out[y, x] = best_alpha
            certain = np.exp(-best_miss / (2 * COLOUR_NOISE_GREY_LEVELS * COLOUR_NOISE_GREY_LEVELS))
            distinct = 1 - np.exp(-best_gap / (2 * (4 * COLOUR_NOISE_GREY_LEVELS) ** 2))
            confidence_out[y, x] = certain * distinct
