"""The colours of hair around a head: the picture's in front, and around the back those of its rows, with strands.

Laid behind, what a picture shows of the front is a second face of hair.
"""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import gaussian_filter1d

from engine.character.shell.colours.hair import strand_noise
from engine.imaging.filling.nearest import nearest_colours
from engine.imaging.masks.mask_distance import distance_inside

COLUMNS, MAX_ROWS = 256, 512
"""Texels around a head, and from its crown to the ends of its hair at most."""
OUTLINE_INSET_PIXELS = 2.0
"""Pixels of the grid within hair's border from which on its colours are its alone."""
PICTURED_COSINES = (0.15, 0.5)
"""Cosines to the viewer from which on colours are more and more, and all, the picture's."""
ROW_SMOOTHING_PIXELS, FINE_PIXELS = 5.0, 3.0
"""Pixels of the grid along hair over which its rows' colours are averaged, and over which strands average out."""
MIN_ROW_WEIGHT = 1e-3
"""Pixels of hair in a row, averaged over rows, from which it tells what it is like."""
CARRIED_RADIANS, MAX_CARRIED_LEVELS = 0.5, 25.0
"""Radians over which what the picture's last colours have beside their row's goes over into that, and grey levels of it at most."""
MAX_STRAND_DEVIATION_LEVELS = 12.0
"""Standard deviation of strands, sRGB levels, at most."""


def hair_round(
    rgb: NDArray[np.uint8],
    to_grid: NDArray[np.float64],
    hair: NDArray[np.bool_],
    ring: NDArray[np.float64],
    angles: NDArray[np.float64],
) -> NDArray[np.uint8]:
    """What a shell of hair is coloured like (A, `COLUMNS`, 3), from its first row to its last and from one end of its rings around the back
    to the other.

    Parameters
    ----------
    rgb : (H, W, 3), the picture; `to_grid` (2, 3) takes its pixels to those of the grid.
    hair : (h, w), what of the grid shows hair.
    ring, angles : (R, N, 2) places on the grid, and (R, N) radians from the front, of the shell's vertices.
    """
    size, scale = (rgb.shape[1], rgb.shape[0]), 1 / float(to_grid[0, 0])
    flags = cv2.INTER_LINEAR | cv2.WARP_INVERSE_MAP
    there = cv2.warpAffine(hair.astype(np.float32), to_grid, size, flags=flags) > 0.5
    clean = distance_inside(there) > OUTLINE_INSET_PIXELS * scale
    clean = clean if clean.any() else there
    height = int(np.clip(round(scale * len(ring)), 16, MAX_ROWS))
    wide = (COLUMNS, height)
    places, turn = (_enlarged(values, wide) for values in (ring, angles[..., None]))
    turn = turn[..., 0]
    pixels = (places - to_grid[:, 2]) / np.diag(to_grid)
    first, last = pixels.min((0, 1)), pixels.max((0, 1))
    left, upper = (max(int(value) - 2, 0) for value in first)
    right, lower = int(last[0]) + 3, int(last[1]) + 3
    seen, own = rgb[upper:lower, left:right], clean[upper:lower, left:right]
    if not own.any():
        return np.broadcast_to(np.median(rgb[clean], 0), (height, COLUMNS, 3)).astype(np.uint8)
    around = nearest_colours(seen, own)
    x, y = ((pixels[..., k] - start).astype(np.float32) for k, start in enumerate((left, upper)))
    pictured = cv2.remap(around, x, y, cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE).astype(np.float32)
    model = _rows(seen, own, y.mean(1), x.mean(), scale, turn)
    share = np.clip((np.cos(turn) - PICTURED_COSINES[0]) / (PICTURED_COSINES[1] - PICTURED_COSINES[0]), 0, 1)
    model = model + _carried(pictured - model, share, turn, ROW_SMOOTHING_PIXELS * scale)
    fine = seen.mean(-1) - cv2.GaussianBlur(around.mean(-1), (0, 0), FINE_PIXELS * scale)
    levels = min(1.4826 * float(np.median(np.abs(fine[own]))), MAX_STRAND_DEVIATION_LEVELS)
    model = model + levels * strand_noise((height, COLUMNS))[..., None]
    return np.clip(model + share[..., None] * (pictured - model) + 0.5, 0, 255).astype(np.uint8)


def _enlarged(values: NDArray[np.float64], size: tuple[int, int]) -> NDArray[np.float64]:
    """Values (R, N, C) of rows and columns at so many columns and rows."""
    rows, columns = values.shape[:2]
    x, y = np.meshgrid(np.linspace(0, columns - 1, size[0]), np.linspace(0, rows - 1, size[1]))
    flat = [
        cv2.remap(np.ascontiguousarray(values[..., k]), x.astype(np.float32), y.astype(np.float32), cv2.INTER_LINEAR)
        for k in range(values.shape[2])
    ]
    return np.stack(flat, 2)


def _rows(
    seen: NDArray[np.uint8],
    own: NDArray[np.bool_],
    rows: NDArray[np.float32],
    middle: float,
    scale: float,
    turn: NDArray[np.float64],
) -> NDArray[np.float32]:
    """What the hair of a row is like (A, `COLUMNS`, 3) at angles (A, `COLUMNS`): the median of what is its own (h, w) on either side,
    going over from one to the other behind."""
    found = []
    columns = np.arange(seen.shape[1])
    for aside in (columns >= middle, columns < middle):
        mine = own & aside if (own & aside).any() else own
        count = mine.sum(1)
        there = np.flatnonzero(count)
        told = np.zeros((len(count), 3))
        told[there] = [np.median(seen[row][mine[row]], 0) for row in there]
        total, weight = (
            gaussian_filter1d(one, ROW_SMOOTHING_PIXELS * scale, axis=0, mode="constant")
            for one in (told * count[:, None], count[:, None].astype(np.float64))
        )
        known = np.flatnonzero(weight[:, 0] > MIN_ROW_WEIGHT)
        smooth = total[known] / weight[known]
        found.append(np.stack([np.interp(rows, known, smooth[:, k]) for k in range(3)], 1))
    right, left = (one[:, None] for one in found)
    share = np.clip((turn - 0.5 * np.pi) / np.pi, 0, 1)[..., None]
    return np.asarray(right + share * (left - right), np.float32)


def _carried(
    change: NDArray[np.float32], share: NDArray[np.float64], turn: NDArray[np.float64], rows: float
) -> NDArray[np.float32]:
    """What a picture has beside its rows (A, N, 3) where it ends, averaged over so many `rows`, going over into nothing around the back."""
    edge = (share > 0) & (share < 1)
    out = np.zeros_like(change)
    for aside in (turn < np.pi, turn >= np.pi):
        weight = (edge & aside).astype(np.float32)[..., None]
        count = weight.sum(1)
        mean = (np.clip(change, -MAX_CARRIED_LEVELS, MAX_CARRIED_LEVELS) * weight).sum(1) / np.maximum(count, 1)
        mean = gaussian_filter1d(mean, rows, axis=0, mode="nearest")
        start = 0.5 * np.pi
        way = np.maximum(np.minimum(turn, 2 * np.pi - turn) - start, 0)
        out += np.where(aside[..., None], mean[:, None] * np.exp(-way / CARRIED_RADIANS)[..., None], 0)
    return np.asarray(out, np.float32)
