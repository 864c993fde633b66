"""PatchMatch: for each patch of a hole the most similar patch of the known picture, and the vote of all.

Barnes, Shechtman, Finkelstein, Goldman, "PatchMatch: a randomized correspondence algorithm for structural
image editing", SIGGRAPH 2009. Patches are compared up to a small shift of colour (Darabi et al., "Image
melding", SIGGRAPH 2012), so that a gradually lit wall can be continued from a darker part of itself.
"""

from __future__ import annotations

import os
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.compiled import njit

PATCH_RADIUS_PIXELS = 3
"""Pixels from a patch's centre to its border."""
PATCH_SIDE_PIXELS = 2 * PATCH_RADIUS_PIXELS + 1
"""Pixels of a patch's side."""

MAX_COLOUR_SHIFT_GREY_LEVELS = 24.0
"""Grey levels by which a patch's mean colour may be shifted to fit, at most."""
SHIFT_COST = 0.15
"""What a shift of a patch's mean colour costs, as a share of what the same difference would cost unshifted."""
GRAIN_POWER = 8
"""Power of a patch's inverse cost by which it counts where grain is to be kept: enough for the best patch to
stand alone where it is clearly best, and for seams between equals to blend."""

BAND_PATCHES = 6000
"""Patches that make a band of their own worth while."""
MAX_BANDS = 4
"""Bands of a picture, at most."""


def colour_planes(image: NDArray[np.float32]) -> NDArray[np.float32]:
    """`image` (H, W, 3) as (3, H, W + 1): a row of a patch is then eight numbers in a row, the last unused."""
    height, width = image.shape[:2]
    planes = np.zeros((3, height, width + 1), np.float32)
    planes[:, :, :-1] = image.transpose(2, 0, 1)
    return planes


def colour_image(planes: NDArray[np.float32]) -> NDArray[np.float32]:
    """The image (H, W, 3) of `colour_planes`."""
    return np.ascontiguousarray(planes[:, :, :-1].transpose(1, 2, 0))


@njit(fastmath=True, nogil=True, forceinline=True)
def _allowed_shift(mean):  # type: ignore[no-untyped-def]
    return min(max(mean, np.float32(-MAX_COLOUR_SHIFT_GREY_LEVELS)), np.float32(MAX_COLOUR_SHIFT_GREY_LEVELS))


@njit(fastmath=True, nogil=True, forceinline=True)
def take_target(planes, weight, y, x, target):  # type: ignore[no-untyped-def]
    """Copy the patch at (y, x) into `target` (4, 7, 8): colours and weights. Returns the sum of the weights."""
    mass = np.float32(0)
    for dy in range(PATCH_SIDE_PIXELS):
        for dx in range(PATCH_SIDE_PIXELS):
            target[0, dy, dx] = planes[0, y + dy - PATCH_RADIUS_PIXELS, x + dx - PATCH_RADIUS_PIXELS]
            target[1, dy, dx] = planes[1, y + dy - PATCH_RADIUS_PIXELS, x + dx - PATCH_RADIUS_PIXELS]
            target[2, dy, dx] = planes[2, y + dy - PATCH_RADIUS_PIXELS, x + dx - PATCH_RADIUS_PIXELS]
            target[3, dy, dx] = weight[y + dy - PATCH_RADIUS_PIXELS, x + dx - PATCH_RADIUS_PIXELS]
            mass += target[3, dy, dx]
    return max(mass, np.float32(1e-6))


@njit(fastmath=True, nogil=True, forceinline=True)
def patch_distance(planes, target, mass, sy, sx):  # type: ignore[no-untyped-def]
    """Weighted mean squared difference, after the best allowed shift, of the taken patch and the one at
    (sy, sx) (grey levels squared)."""
    total = s0 = s1 = s2 = np.float32(0)
    # unsigned indices need no wrap-around, without which the inner loop becomes vector instructions
    oy, ox = np.uintp(sy - PATCH_RADIUS_PIXELS), np.uintp(sx - PATCH_RADIUS_PIXELS)
    for dy in range(np.uintp(PATCH_SIDE_PIXELS)):
        for dx in range(np.uintp(8)):
            w = target[3, dy, dx]
            d0 = target[0, dy, dx] - planes[0, oy + dy, ox + dx]
            d1 = target[1, dy, dx] - planes[1, oy + dy, ox + dx]
            d2 = target[2, dy, dx] - planes[2, oy + dy, ox + dx]
            total += w * (d0 * d0 + d1 * d1 + d2 * d2)
            s0 += w * d0
            s1 += w * d1
            s2 += w * d2
    saved = np.float32(0)
    for s in (s0, s1, s2):
        shift = _allowed_shift(s / mass)
        saved += (2 * s - mass * shift) * shift
    return (total - saved * np.float32(1 - SHIFT_COST)) / mass


@njit(fastmath=True, nogil=True)
def patch_shift(planes, target, mass, sy, sx):  # type: ignore[no-untyped-def]
    """The colour (3 numbers) to add to the patch at (sy, sx) so that it fits the taken one."""
    s0 = s1 = s2 = np.float32(0)
    for dy in range(PATCH_SIDE_PIXELS):
        for dx in range(PATCH_SIDE_PIXELS):
            w = target[3, dy, dx]
            s0 += w * (target[0, dy, dx] - planes[0, sy + dy - PATCH_RADIUS_PIXELS, sx + dx - PATCH_RADIUS_PIXELS])
            s1 += w * (target[1, dy, dx] - planes[1, sy + dy - PATCH_RADIUS_PIXELS, sx + dx - PATCH_RADIUS_PIXELS])
            s2 += w * (target[2, dy, dx] - planes[2, sy + dy - PATCH_RADIUS_PIXELS, sx + dx - PATCH_RADIUS_PIXELS])
    share = np.float32(1 - SHIFT_COST)
    return _allowed_shift(s0 / mass) * share, _allowed_shift(s1 / mass) * share, _allowed_shift(s2 / mass) * share


@njit(fastmath=True, nogil=True)
def _match_band(planes, weight, targets, sources, field, cost, sweeps, random_tries, seed, top, bottom):  # type: ignore[no-untyped-def]
    height, width = cost.shape
    state = np.uint32((seed + top) * 2654435761 + 12345)
    target = np.zeros((4, PATCH_SIDE_PIXELS, 8), np.float32)
    for sweep in range(sweeps):
        step = 1 if sweep % 2 == 0 else -1
        for row in range(bottom - top):
            y = top + row if step == 1 else bottom - 1 - row
            for column in range(width):
                x = column if step == 1 else width - 1 - column
                if not targets[y, x]:
                    continue
                mass = take_target(planes, weight, y, x, target)
                by, bx = np.int64(field[y, x, 0]), np.int64(field[y, x, 1])
                best = patch_distance(planes, target, mass, by, bx) if sweep == 0 else cost[y, x]
                for k in range(2):
                    ny, nx = (y - step, x) if k == 0 else (y, x - step)
                    if ny < top or nx < 0 or ny >= bottom or nx >= width or not targets[ny, nx]:
                        continue
                    sy, sx = field[ny, nx, 0] + y - ny, field[ny, nx, 1] + x - nx
                    if 0 <= sy < height and 0 <= sx < width and sources[sy, sx] and not (sy == by and sx == bx):
                        found = patch_distance(planes, target, mass, sy, sx)
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
                        found = patch_distance(planes, target, mass, sy, sx)
                        if found < best:
                            best, by, bx = found, sy, sx
                cost[y, x], field[y, x, 0], field[y, x, 1] = best, by, bx


@dataclass(frozen=True)
class PatchField:
    """The nearest-neighbour field of PatchMatch: for each target patch the source patch that is most like it.

    targets : (H, W) bool, the centres of patches to be matched.
    sources : (H, W) bool, the centres of patches to choose from.
    nearest : (H, W, 2) int32, the centre (y, x) of each target's source.
    cost : (H, W) float32, how unlike the two are, grey levels squared; 0 before the first match.
    """

    targets: NDArray[np.bool_]
    sources: NDArray[np.bool_]
    nearest: NDArray[np.int32]
    cost: NDArray[np.float32]

    @classmethod
    def start(
        cls, targets: NDArray[np.bool_], sources: NDArray[np.bool_], seed: int, coarse: PatchField | None = None
    ) -> PatchField:
        """A first field: that of the picture of half the size where it points to a source, else anywhere. `sources` is not empty."""
        nearest = np.zeros((*targets.shape, 2), np.int32)
        rows, columns = np.nonzero(targets)
        lost = np.ones(len(rows), bool)
        if coarse is not None:
            half = coarse.nearest
            up_y, up_x = np.minimum(rows // 2, half.shape[0] - 1), np.minimum(columns // 2, half.shape[1] - 1)
            found = half[up_y, up_x]
            y = np.clip(2 * found[:, 0] + rows - 2 * up_y, 0, targets.shape[0] - 1)
            x = np.clip(2 * found[:, 1] + columns - 2 * up_x, 0, targets.shape[1] - 1)
            nearest[rows, columns, 0], nearest[rows, columns, 1] = y, x
            lost = ~sources[y, x]
        anywhere = np.argwhere(sources)
        pick = np.random.default_rng(seed).integers(0, len(anywhere), lost.sum())
        nearest[rows[lost], columns[lost]] = anywhere[pick]
        return cls(targets, sources, nearest, np.zeros(targets.shape, np.float32))

    def match(
        self, planes: NDArray[np.float32], weight: NDArray[np.float32], sweeps: int, random_tries: int, seed: int
    ) -> None:
        """Improve `nearest` and set `cost`, in place. `planes` (`colour_planes`) hold the present guess inside the hole;
        `weight` (H, W) is how much each pixel counts."""
        given = planes, weight, self.targets, self.sources, self.nearest, self.cost, sweeps, random_tries, seed
        _side_by_side(_match_band, given, _bands(self.targets))

    def vote(
        self, planes: NDArray[np.float32], weight: NDArray[np.float32], hole: NDArray[np.bool_], sharpness: float
    ) -> NDArray[np.float32]:
        """Colours (H, W, 3) in which each pixel of `hole` is the mean of what the patches over it say, the better ones
        counting more; elsewhere those of `planes`.

        `sharpness` is the cost at which a patch counts for little (grey levels squared); at 0 hardly any but the best
        counts, which keeps grain and fine texture that a mean would wash out.
        """
        result = colour_image(planes)
        shift = np.zeros((*self.cost.shape, 3), np.float32)
        trust = np.zeros(self.cost.shape, np.float32)
        bands = _bands(self.targets)
        given = planes, weight, self.targets, self.nearest, self.cost, sharpness, shift, trust
        _side_by_side(_weigh_band, given, bands)
        _side_by_side(_vote_band, (planes, hole, self.nearest, sharpness, shift, trust, result), bands)
        return result


@njit(fastmath=True, nogil=True)
def _weigh_band(planes, weight, targets, field, cost, sharpness, shift, trust, top, bottom):  # type: ignore[no-untyped-def]
    """Each patch's colour `shift` and its `trust`."""
    target = np.zeros((4, PATCH_SIDE_PIXELS, 8), np.float32)
    for y in range(top, bottom):
        for x in range(cost.shape[1]):
            if targets[y, x]:
                mass = take_target(planes, weight, y, x, target)
                sy, sx = np.int64(field[y, x, 0]), np.int64(field[y, x, 1])
                shift[y, x, 0], shift[y, x, 1], shift[y, x, 2] = patch_shift(planes, target, mass, sy, sx)
                if sharpness > 0:
                    trust[y, x] = mass * np.exp(-cost[y, x] / sharpness) + np.float32(1e-6)
                else:
                    trust[y, x] = 1 / (np.float32(1) + cost[y, x])


@njit(fastmath=True, nogil=True)
def _vote_band(planes, hole, field, sharpness, shift, trust, result, top, bottom):  # type: ignore[no-untyped-def]
    height, width = trust.shape
    for y in range(top, bottom):
        for x in range(width):
            if not hole[y, x]:
                continue
            best = np.float32(0)
            if sharpness == 0:
                for cy in range(max(0, y - PATCH_RADIUS_PIXELS), min(height, y + PATCH_RADIUS_PIXELS + 1)):
                    for cx in range(max(0, x - PATCH_RADIUS_PIXELS), min(width, x + PATCH_RADIUS_PIXELS + 1)):
                        best = max(best, trust[cy, cx])
            mass = np.float32(0)
            s0 = s1 = s2 = np.float32(0)
            for cy in range(max(0, y - PATCH_RADIUS_PIXELS), min(height, y + PATCH_RADIUS_PIXELS + 1)):
                for cx in range(max(0, x - PATCH_RADIUS_PIXELS), min(width, x + PATCH_RADIUS_PIXELS + 1)):
                    w = trust[cy, cx]
                    if w == 0:
                        continue
                    if sharpness == 0:
                        w = (w / best) ** GRAIN_POWER
                    sy, sx = field[cy, cx, 0] + y - cy, field[cy, cx, 1] + x - cx
                    mass += w
                    s0 += w * (planes[0, sy, sx] + shift[cy, cx, 0])
                    s1 += w * (planes[1, sy, sx] + shift[cy, cx, 1])
                    s2 += w * (planes[2, sy, sx] + shift[cy, cx, 2])
            if mass > 0:
                result[y, x, 0] = min(max(s0 / mass, 0.0), 255.0)
                result[y, x, 1] = min(max(s1 / mass, 0.0), 255.0)
                result[y, x, 2] = min(max(s2 / mass, 0.0), 255.0)


def _bands(targets: NDArray[np.bool_]) -> list[int]:
    """Rows between which large pictures are worked on side by side; the same ones on every machine, so that the result
    is too."""
    so_far = np.cumsum(targets.sum(axis=1))
    bands = int(np.clip(so_far[-1] // BAND_PATCHES, 1, MAX_BANDS))
    return [0, *(int(np.searchsorted(so_far, so_far[-1] * k / bands)) for k in range(1, bands)), len(targets)]


def _side_by_side(function: Callable[..., None], given: tuple[Any, ...], cuts: list[int]) -> None:
    """Call the function with what is `given` and the two rows that bound each band."""
    with ThreadPoolExecutor(os.cpu_count() or 1) as pool:
        for band in [pool.submit(function, *given, top, bottom) for top, bottom in pairwise(cuts)]:
            band.result()


def valid_centres(usable: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Where a whole patch lies inside `usable` (H, W) and inside the picture."""
    padded = np.pad(usable.astype(np.uint8), 1)
    eroded = cv2.erode(
        padded, np.ones((PATCH_SIDE_PIXELS, PATCH_SIDE_PIXELS), np.uint8), borderType=cv2.BORDER_CONSTANT, borderValue=0
    )
    return np.asarray(eroded[1:-1, 1:-1] > 0)
