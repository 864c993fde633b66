"""Chosen pixels looked at closely: which triangle covers each of several samples in them.

Samples lie on the grid to which vertices are snapped, so that all agree with the pixels' centres and with each other to
the last bit about which triangle covers what (`engine.render.rasterisation.rasteriser`).

Source: K. Akeley, RealityEngine graphics, SIGGRAPH 1993: coverage by the sample, colour by the triangle.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from engine.compiled import njit
from engine.render.rasterisation.rasteriser import RASTER_SUBPIXEL_BITS, SUBPIXEL_STEPS, edge_bias, snap_to_subpixels

BLOCK_SHIFT = 3
"""Binary logarithm of the side, in pixels, of the blocks by which triangles find the chosen pixels that they touch."""


class PixelSelection(NamedTuple):
    """The pixels of a picture of size (H, W) that are to be looked at.

    places : (N, 2) int32, rows and columns, block by block.
    starts : (B + 1,) int64 where each block's begin, the blocks row by row.
    size : (height, width).
    """

    places: NDArray[np.int32]
    starts: NDArray[np.int64]
    size: tuple[int, int]


def select_pixels(marks: NDArray[np.bool_]) -> PixelSelection:
    """The pixels that are set in `marks` (H, W)."""
    height, width = marks.shape
    places = np.stack(np.divmod(np.flatnonzero(marks), width), 1).astype(np.int32)
    down, across = (((side - 1) >> BLOCK_SHIFT) + 1 for side in (height, width))
    block = (places[:, 0] >> BLOCK_SHIFT) * across + (places[:, 1] >> BLOCK_SHIFT)
    starts = np.concatenate([[0], np.cumsum(np.bincount(block, minlength=down * across))])
    return PixelSelection(places[np.argsort(block, kind="stable")], starts, (height, width))


def sample_offsets(samples: int) -> NDArray[np.int64]:
    """(samples * samples, 2) x and y of the samples of a pixel, evenly apart: `SUBPIXEL_STEPS` from its centre."""
    along = np.rint(SUBPIXEL_STEPS * ((np.arange(samples) + 0.5) / samples - 0.5)).astype(np.int64)
    return np.stack([np.tile(along, samples), np.repeat(along, samples)], 1)


@njit(nogil=True, boundscheck=False, error_model="numpy")
def draw_samples(
    points: np.ndarray,
    faces: np.ndarray,
    facing: np.ndarray,
    cull: bool,
    pixels: np.ndarray,
    starts: np.ndarray,
    size: tuple[int, int],
    offsets: np.ndarray,
) -> np.ndarray:
    """(N, S) int32: the nearest triangle at each sample of the `PixelSelection` pixels; -1 where there is none.

    `points`, `faces` and `cull` as in `rasteriser.draw_into`, with perspective; `facing` from `outline.facings`;
    `offsets` (S, 2) from `sample_offsets`.
    """
    height, width = size
    blocks, samples = ((width - 1) >> BLOCK_SHIFT) + 1, len(offsets)
    ids, depths = np.empty((len(pixels), samples), np.int32), np.empty((len(pixels), samples), np.float32)
    ids[:], depths[:] = -1, np.inf
    reach = 0
    for s in range(samples):
        reach = max(reach, abs(int(offsets[s, 0])), abs(int(offsets[s, 1])))
    places = snap_to_subpixels(points)
    for t in range(faces.shape[0]):
        if facing[t] == 0 or (cull and facing[t] < 0):
            continue
        a, b, c = faces[t, 0], faces[t, 1], faces[t, 2]
        if facing[t] > 0:  # the inside is to the right of each edge from here on
            b, c = c, b
        ax, ay = int(places[a, 0]), int(places[a, 1])
        bx, by = int(places[b, 0]), int(places[b, 1])
        cx, cy = int(places[c, 0]), int(places[c, 1])
        left = max((min(ax, bx, cx) - reach + SUBPIXEL_STEPS - 1) >> RASTER_SUBPIXEL_BITS, 0)
        right = min((max(ax, bx, cx) + reach) >> RASTER_SUBPIXEL_BITS, width - 1)
        top = max((min(ay, by, cy) - reach + SUBPIXEL_STEPS - 1) >> RASTER_SUBPIXEL_BITS, 0)
        bottom = min((max(ay, by, cy) + reach) >> RASTER_SUBPIXEL_BITS, height - 1)
        if left > right or top > bottom or not _any(starts, blocks, top, bottom, left, right):
            continue
        step_a, step_b, step_c = by - cy, cy - ay, ay - by
        down_a, down_b, down_c = cx - bx, ax - cx, bx - ax
        own_a, own_b, own_c = edge_bias(down_a, -step_a), edge_bias(down_b, -step_b), edge_bias(down_c, -step_c)
        far_a, far_b, far_c = (
            reach * (abs(step_a) + abs(down_a)),
            reach * (abs(step_b) + abs(down_b)),
            reach * (abs(step_c) + abs(down_c)),
        )
        area = np.float32(down_c * (cy - ay) + step_c * (cx - ax))
        za, zb, zc = 1 / (area * points[a, 2]), 1 / (area * points[b, 2]), 1 / (area * points[c, 2])
        for i in range(top >> BLOCK_SHIFT, (bottom >> BLOCK_SHIFT) + 1):
            for j in range(left >> BLOCK_SHIFT, (right >> BLOCK_SHIFT) + 1):
                for k in range(starts[i * blocks + j], starts[i * blocks + j + 1]):
                    y, x = pixels[k, 0], pixels[k, 1]
                    if y < top or y > bottom or x < left or x > right:
                        continue
                    px, py = np.int64(x) << RASTER_SUBPIXEL_BITS, np.int64(y) << RASTER_SUBPIXEL_BITS
                    pa = down_a * (py - by) + step_a * (px - bx)
                    pb = down_b * (py - cy) + step_b * (px - cx)
                    pc = down_c * (py - ay) + step_c * (px - ax)
                    if pa + far_a < 0 or pb + far_b < 0 or pc + far_c < 0:
                        continue
                    for s in range(samples):
                        dx, dy = offsets[s, 0], offsets[s, 1]
                        wa = pa + down_a * dy + step_a * dx
                        wb = pb + down_b * dy + step_b * dx
                        wc = pc + down_c * dy + step_c * dx
                        if ((wa + own_a) | (wb + own_b) | (wc + own_c)) >= 0:
                            z = np.float32(1 / (np.float32(wa) * za + np.float32(wb) * zb + np.float32(wc) * zc))
                            if z < depths[k, s]:
                                depths[k, s] = z
                                ids[k, s] = t
    return ids


@njit(nogil=True, boundscheck=False, inline="always")
def _any(starts: np.ndarray, blocks: int, top: int, bottom: int, left: int, right: int) -> bool:
    """Whether any pixel is chosen in the blocks that these rows and columns of pixels reach into."""
    for i in range(top >> BLOCK_SHIFT, (bottom >> BLOCK_SHIFT) + 1):
        if starts[i * blocks + (left >> BLOCK_SHIFT)] < starts[i * blocks + (right >> BLOCK_SHIFT) + 1]:
            return True
    return False
