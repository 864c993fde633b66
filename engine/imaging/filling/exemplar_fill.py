"""A first filling of a hole, patch by patch from its edge inward, lines first.

Criminisi, Pérez, Toyama, "Region filling and object removal by exemplar-based image inpainting", IEEE
Transactions on Image Processing 2004. The next patch is the one on the front whose surroundings are best
known and into which a line runs; so lines grow into the hole before the areas beside them close over them.
Greedy and exhaustive: for small pictures, as the start of `engine.imaging.filling.inpaint`.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from engine.compiled import njit
from engine.imaging.filling.patchmatch import (
    PATCH_RADIUS_PIXELS,
    PATCH_SIDE_PIXELS,
    colour_image,
    colour_planes,
    patch_distance,
    patch_shift,
    take_target,
)

DISTANCE_COST = 0.02
"""Cost, in grey levels squared for each pixel squared, of fetching a patch from afar."""


def exemplar_fill(
    image: NDArray[np.float32], hole: NDArray[np.bool_], sources: NDArray[np.bool_], known: NDArray[np.bool_]
) -> NDArray[np.float32]:
    """`image` (H, W, 3) with `hole` (H, W) filled from patches centred on `sources` (H, W). What is neither a hole nor `known` (H, W) has
    no say and stays.

    Returns float32 (H, W, 3). Hole pixels that no whole patch reaches (in the picture's corners) are left.
    """
    ys, xs = np.nonzero(sources)
    # every other source, like the white squares of a chessboard: straight lines still find their like
    half = (ys + xs) % 2 == 0 if len(ys) > 500 else np.ones(len(ys), bool)
    ys, xs = ys[half], xs[half]
    planes = colour_planes(image)
    _fill(planes, hole.copy(), known.astype(np.float32), ys.astype(np.int32), xs.astype(np.int32))
    return colour_image(planes)


@njit(fastmath=True, nogil=True)
def _fill(planes, hole, known, source_ys, source_xs):  # type: ignore[no-untyped-def]
    confidence = known.copy()
    target = np.zeros((4, PATCH_SIDE_PIXELS, 8), np.float32)
    while True:
        ty, tx = _next_centre(planes, hole, known, confidence)
        if ty < 0:
            return
        mass = take_target(planes, known, ty, tx, target)
        best = np.float32(np.inf)
        by = bx = np.int64(0)
        for i in range(len(source_ys)):
            sy, sx = np.int64(source_ys[i]), np.int64(source_xs[i])
            away = np.float32((sy - ty) * (sy - ty) + (sx - tx) * (sx - tx))
            found = patch_distance(planes, target, mass, sy, sx) + np.float32(DISTANCE_COST) * away
            if found < best:
                best, by, bx = found, sy, sx
        shift = patch_shift(planes, target, mass, by, bx)
        trust = _mean_over_patch(confidence, ty, tx)
        for dy in range(-PATCH_RADIUS_PIXELS, PATCH_RADIUS_PIXELS + 1):
            for dx in range(-PATCH_RADIUS_PIXELS, PATCH_RADIUS_PIXELS + 1):
                y, x = ty + dy, tx + dx
                if hole[y, x]:
                    for c in range(3):
                        planes[c, y, x] = min(max(planes[c, by + dy, bx + dx] + shift[c], 0.0), 255.0)
                    confidence[y, x] = trust
                    known[y, x] = 1
                    hole[y, x] = False


@njit(fastmath=True, nogil=True)
def _next_centre(planes, hole, known, confidence):  # type: ignore[no-untyped-def]
    """The centre (y, x) of highest priority on the hole's front, or (-1, -1) when there is none."""
    height, width = hole.shape
    best = np.float32(-1)
    by = bx = -1
    for y in range(PATCH_RADIUS_PIXELS, height - PATCH_RADIUS_PIXELS):
        for x in range(PATCH_RADIUS_PIXELS, width - PATCH_RADIUS_PIXELS):
            if not hole[y, x] and not (
                y == PATCH_RADIUS_PIXELS
                or x == PATCH_RADIUS_PIXELS
                or y == height - PATCH_RADIUS_PIXELS - 1
                or x == width - PATCH_RADIUS_PIXELS - 1
            ):
                continue
            open_sides = (not hole[y - 1, x]) + (not hole[y + 1, x]) + (not hole[y, x - 1]) + (not hole[y, x + 1])
            if hole[y, x] and open_sides == 0:
                continue
            if not hole[y, x] and not _touches(hole, y, x):
                continue
            trust = _mean_over_patch(confidence, y, x)
            if trust <= 0:
                continue
            line = np.float32(0)
            for dy in range(-PATCH_RADIUS_PIXELS + 1, PATCH_RADIUS_PIXELS):
                for dx in range(-PATCH_RADIUS_PIXELS + 1, PATCH_RADIUS_PIXELS):
                    py, px = y + dy, x + dx
                    if (
                        known[py, px] * known[py - 1, px] * known[py + 1, px] * known[py, px - 1] * known[py, px + 1]
                        == 0
                    ):
                        continue
                    for c in range(3):
                        gy = (planes[c, py + 1, px] - planes[c, py - 1, px]) / 2
                        gx = (planes[c, py, px + 1] - planes[c, py, px - 1]) / 2
                        # strength of the isophote (turned gradient) along the hole's normal
                        ny = known[y - 1, x] - known[y + 1, x]
                        nx = known[y, x - 1] - known[y, x + 1]
                        size = np.sqrt(ny * ny + nx * nx) + 1e-6
                        line = max(line, abs(-gx * ny + gy * nx) / size)
            priority = trust * (line + 1)
            if priority > best:
                best, by, bx = priority, y, x
    return by, bx


@njit(fastmath=True, nogil=True)
def _touches(hole, y, x):  # type: ignore[no-untyped-def]
    """Whether the patch around a known centre at the picture's rim holds hole pixels that no other centre fills."""
    for dy in range(-PATCH_RADIUS_PIXELS, PATCH_RADIUS_PIXELS + 1):
        for dx in range(-PATCH_RADIUS_PIXELS, PATCH_RADIUS_PIXELS + 1):
            if hole[y + dy, x + dx]:
                py, px = y + dy, x + dx
                height, width = hole.shape
                if (
                    py < PATCH_RADIUS_PIXELS
                    or px < PATCH_RADIUS_PIXELS
                    or py >= height - PATCH_RADIUS_PIXELS
                    or px >= width - PATCH_RADIUS_PIXELS
                ):
                    return True
    return False


@njit(fastmath=True, nogil=True)
def _mean_over_patch(values, y, x):  # type: ignore[no-untyped-def]
    total = np.float32(0)
    for dy in range(-PATCH_RADIUS_PIXELS, PATCH_RADIUS_PIXELS + 1):
        for dx in range(-PATCH_RADIUS_PIXELS, PATCH_RADIUS_PIXELS + 1):
            total += values[y + dy, x + dx]
    return total / (2 * PATCH_RADIUS_PIXELS + 1) ** 2
