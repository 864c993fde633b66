"""PatchMatch: for each patch of a hole the most similar patch of the known picture, and the vote of all.

Barnes, Shechtman, Finkelstein, Goldman, "PatchMatch: a randomized correspondence algorithm for structural
image editing", SIGGRAPH 2009. Patches are compared up to a small shift of colour (Darabi et al., "Image
melding", SIGGRAPH 2012), so that a gradually lit wall can be continued from a darker part of itself.
"""

from __future__ import annotations

import cv2
import numba
import numpy as np
from numpy.typing import NDArray

RADIUS = 3
"""Patches are 7x7."""

LARGEST_SHIFT = 24.0
"""Grey levels by which a patch's mean colour may be shifted to fit ..."""
SHIFT_COST = 0.15
"""... and what a shift costs, as a share of what the same difference would cost unshifted."""


@numba.njit(cache=True, fastmath=True, nogil=True, inline="always")
def _allowed_shift(mean):  # type: ignore[no-untyped-def]
    return min(max(mean, -LARGEST_SHIFT), LARGEST_SHIFT)


@numba.njit(cache=True, fastmath=True, nogil=True, inline="always")
def _distance(image, weight, ty, tx, sy, sx):  # type: ignore[no-untyped-def]
    """Weighted mean squared difference of two patches after the best allowed shift (grey levels squared)."""
    total = np.float32(0)
    s0 = s1 = s2 = np.float32(0)
    mass = np.float32(0)
    for dy in range(-RADIUS, RADIUS + 1):
        for dx in range(-RADIUS, RADIUS + 1):
            w = weight[ty + dy, tx + dx]
            d0 = image[ty + dy, tx + dx, 0] - image[sy + dy, sx + dx, 0]
            d1 = image[ty + dy, tx + dx, 1] - image[sy + dy, sx + dx, 1]
            d2 = image[ty + dy, tx + dx, 2] - image[sy + dy, sx + dx, 2]
            total += w * (d0 * d0 + d1 * d1 + d2 * d2)
            s0 += w * d0
            s1 += w * d1
            s2 += w * d2
            mass += w
    for s in (s0, s1, s2):
        shift = _allowed_shift(s / mass)
        total -= (2 * s - mass * shift) * shift * (1 - SHIFT_COST)
    return total / mass


@numba.njit(cache=True, fastmath=True, nogil=True)
def match_patches(image, weight, targets, sources, field, cost, sweeps, first, random_tries, seed):  # type: ignore[no-untyped-def]
    """Improve `field` (H, W, 2) int32, the centre (y, x) of the source of each target patch, in place.

    `image` (H, W, 3) float32 holds the present guess inside the hole; `weight` (H, W) is how much each
    of its pixels counts; `targets`, `sources` (H, W) bool mark centres; `cost` (H, W) float32 is written.
    `first` evaluates the given field before improving it.
    """
    height, width = cost.shape
    state = np.uint32(seed * 2654435761 + 12345)
    if first:
        for y in range(height):
            for x in range(width):
                if targets[y, x]:
                    cost[y, x] = _distance(image, weight, y, x, field[y, x, 0], field[y, x, 1])
    for sweep in range(sweeps):
        step = 1 if sweep % 2 == 0 else -1
        for row in range(height):
            y = row if step == 1 else height - 1 - row
            for column in range(width):
                x = column if step == 1 else width - 1 - column
                if not targets[y, x]:
                    continue
                best, by, bx = cost[y, x], field[y, x, 0], field[y, x, 1]
                for k in range(2):
                    ny, nx = (y - step, x) if k == 0 else (y, x - step)
                    if ny < 0 or nx < 0 or ny >= height or nx >= width or not targets[ny, nx]:
                        continue
                    sy, sx = field[ny, nx, 0] + y - ny, field[ny, nx, 1] + x - nx
                    if 0 <= sy < height and 0 <= sx < width and sources[sy, sx] and not (sy == by and sx == bx):
                        found = _distance(image, weight, y, x, sy, sx)
                        if found < best:
                            best, by, bx = found, sy, sx
                reach = max(height, width)
                for _ in range(random_tries):
                    if reach < 1:
                        break
                    state = np.uint32(state * np.uint32(1664525) + np.uint32(1013904223))
                    sy = by + int((state >> np.uint32(8)) % np.uint32(2 * reach + 1)) - reach
                    state = np.uint32(state * np.uint32(1664525) + np.uint32(1013904223))
                    sx = bx + int((state >> np.uint32(8)) % np.uint32(2 * reach + 1)) - reach
                    reach //= 2
                    if 0 <= sy < height and 0 <= sx < width and sources[sy, sx]:
                        found = _distance(image, weight, y, x, sy, sx)
                        if found < best:
                            best, by, bx = found, sy, sx
                cost[y, x], field[y, x, 0], field[y, x, 1] = best, by, bx


@numba.njit(cache=True, fastmath=True, nogil=True)
def vote(image, weight, hole, targets, field, cost, sharpness, result):  # type: ignore[no-untyped-def]
    """Each pixel of `hole` becomes the mean of what the patches over it say, the better ones counting more.

    `sharpness` is the cost at which a patch counts for little (grey levels squared); `result` (H, W, 3)
    float32 is written inside the hole only.
    """
    height, width = cost.shape
    shift = np.zeros((height, width, 3), np.float32)
    trust = np.zeros((height, width), np.float32)
    for y in range(height):
        for x in range(width):
            if not targets[y, x]:
                continue
            sy, sx = field[y, x, 0], field[y, x, 1]
            mass = np.float32(0)
            s0 = s1 = s2 = np.float32(0)
            for dy in range(-RADIUS, RADIUS + 1):
                for dx in range(-RADIUS, RADIUS + 1):
                    w = weight[y + dy, x + dx]
                    mass += w
                    s0 += w * (image[y + dy, x + dx, 0] - image[sy + dy, sx + dx, 0])
                    s1 += w * (image[y + dy, x + dx, 1] - image[sy + dy, sx + dx, 1])
                    s2 += w * (image[y + dy, x + dx, 2] - image[sy + dy, sx + dx, 2])
            shift[y, x, 0] = _allowed_shift(s0 / mass) * (1 - SHIFT_COST)
            shift[y, x, 1] = _allowed_shift(s1 / mass) * (1 - SHIFT_COST)
            shift[y, x, 2] = _allowed_shift(s2 / mass) * (1 - SHIFT_COST)
            trust[y, x] = mass * np.exp(-cost[y, x] / sharpness) + 1e-6
    for y in range(height):
        for x in range(width):
            if not hole[y, x]:
                continue
            mass = np.float32(0)
            s0 = s1 = s2 = np.float32(0)
            for cy in range(max(0, y - RADIUS), min(height, y + RADIUS + 1)):
                for cx in range(max(0, x - RADIUS), min(width, x + RADIUS + 1)):
                    w = trust[cy, cx]
                    if w == 0:
                        continue
                    sy, sx = field[cy, cx, 0] + y - cy, field[cy, cx, 1] + x - cx
                    mass += w
                    s0 += w * (image[sy, sx, 0] + shift[cy, cx, 0])
                    s1 += w * (image[sy, sx, 1] + shift[cy, cx, 1])
                    s2 += w * (image[sy, sx, 2] + shift[cy, cx, 2])
            if mass > 0:
                result[y, x, 0] = min(max(s0 / mass, 0.0), 255.0)
                result[y, x, 1] = min(max(s1 / mass, 0.0), 255.0)
                result[y, x, 2] = min(max(s2 / mass, 0.0), 255.0)


def valid_centres(usable: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Where a whole patch lies inside `usable` (H, W) and inside the picture."""
    side = 2 * RADIUS + 1
    padded = np.pad(usable.astype(np.uint8), 1)
    eroded = cv2.erode(padded, np.ones((side, side), np.uint8), borderType=cv2.BORDER_CONSTANT, borderValue=0)
    return np.asarray(eroded[1:-1, 1:-1] > 0)
