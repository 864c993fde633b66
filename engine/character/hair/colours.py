"""The colours of hair around a head: the picture's in front, and around the back those of its rows, with strands.

Laid behind, what a picture shows of the front is a second face of hair.
"""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import gaussian_filter1d, median_filter

from engine.character.shell.colours.hair import strand_noise
from engine.character.shell.colours.unrolled import ROW_METRES, UNROLLED_COLUMNS
from engine.imaging.filling.nearest import nearest_colours
from engine.imaging.masks.mask_distance import dilate_mask, distance_inside

COLUMNS, INSIDE_COLUMNS, MAX_ROWS = 512, 64, 512
"""Texels around a head, the same of hair's inside, and from its crown to the ends of its hair at most."""
ODD_ROWS_SHARE = 0.5
"""Height, as a share of the head's, over which a row's colour is the median of its neighbours': an ear among hair is lower than half of it."""
INSIDE_LIGHT_SHARE = 0.6
"""Share of the light on hair that falls on what of it faces the head."""
HEAD_METRES = 0.23
"""Height of a head."""
HANGING_STRAND_RATIO = 2.0
"""How much longer strands are alike in hair that hangs than in hair that keeps to the head."""
PICTURED_MARGIN_PIXELS = 3
"""Pixels of the grid around hair in which its surface shows whatever the picture does."""
OUTLINE_INSET_PIXELS = 2.0
"""Pixels of the grid within hair's border from which on its colours are its alone."""
PICTURED_COSINES = (0.15, 0.5)
"""Cosines to the viewer from which on colours are more and more, and all, the picture's."""
ROW_SMOOTHING_PIXELS, FINE_PIXELS = 2.5, 3.0
"""Pixels of the grid along hair over which its rows' colours are averaged, and over which strands average out."""
MIN_ROW_WEIGHT = 1e-3
"""Pixels of hair in a row, averaged over rows, from which it tells what it is like."""
CARRIED_RADIANS, MAX_CARRIED_LEVELS = 0.5, 25.0
"""Radians over which what the picture's last colours have beside their row's goes over into that, and grey levels of it at most."""
MAX_STRAND_DEVIATION_LEVELS = 8.0
"""Standard deviation of strands, sRGB levels, at most."""


def hair_round(
    rgb: NDArray[np.uint8],
    to_grid: NDArray[np.float64],
    hair: NDArray[np.bool_],
    person: NDArray[np.bool_],
    ring: NDArray[np.float64],
    head: float,
) -> tuple[NDArray[np.uint8], NDArray[np.uint8]]:
    """What hair is coloured like outside (A, `COLUMNS`, 3) and inside (A, `INSIDE_COLUMNS`, 3), from its first row to its last, at even angles from behind over
    the left, the front and the right to behind.

    Parameters
    ----------
    rgb : (H, W, 3), the picture; `to_grid` (2, 3) takes its pixels to those of the grid.
    hair, person : (h, w), what of the grid shows hair, and what shows anything else of the person.
    ring : (R, N, 2) places on the grid of its surface at even angles.
    head : the height of the head, pixels of the grid.
    """
    size, scale = (rgb.shape[1], rgb.shape[0]), 1 / float(to_grid[0, 0])
    there, around, whole = (
        cv2.warpAffine(one.astype(np.float32), to_grid, size, flags=cv2.INTER_LINEAR | cv2.WARP_INVERSE_MAP) > 0.5
        for one in (hair, dilate_mask(hair, PICTURED_MARGIN_PIXELS), hair | person)
    )
    clean = distance_inside(there) > OUTLINE_INSET_PIXELS * scale
    clean = clean if clean.any() else there
    height = int(np.clip(round(scale * len(ring)), 16, MAX_ROWS))
    places = _enlarged(ring, (COLUMNS, height))
    turn = np.broadcast_to(np.linspace(-np.pi, np.pi, COLUMNS) % (2 * np.pi), (height, COLUMNS))
    pixels = (places - to_grid[:, 2]) / np.diag(to_grid)
    first, last = pixels.min((0, 1)), pixels.max((0, 1))
    left, upper = (max(int(value) - 2, 0) for value in first)
    right, lower = int(last[0]) + 3, int(last[1]) + 3
    seen, own = rgb[upper:lower, left:right], clean[upper:lower, left:right]
    if not own.any():
        even = np.broadcast_to(np.median(rgb[clean], 0), (height, COLUMNS, 3))
        return even.astype(np.uint8), (INSIDE_LIGHT_SHARE * even[:, :INSIDE_COLUMNS]).astype(np.uint8)
    in_front = clean | (around & (distance_inside(whole) > OUTLINE_INSET_PIXELS * scale))
    x, y = ((pixels[..., k] - start).astype(np.float32) for k, start in enumerate((left, upper)))
    colours = nearest_colours(seen, in_front[upper:lower, left:right])
    pictured = cv2.remap(colours, x, y, cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE).astype(np.float32)
    model = _rows(seen, own, y.mean(1), x.mean(), scale, turn, ODD_ROWS_SHARE * head * scale)
    share = np.clip((np.cos(turn) - PICTURED_COSINES[0]) / (PICTURED_COSINES[1] - PICTURED_COSINES[0]), 0, 1)
    of_hair = cv2.remap(nearest_colours(seen, own), x, y, cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE)
    model = model + _carried(of_hair - model, share, turn, ROW_SMOOTHING_PIXELS * scale)
    levels = _strand_levels(seen, own, FINE_PIXELS * scale)
    model = model + levels * _strands((height, COLUMNS), len(ring) * HEAD_METRES / head)[..., None]
    outside = model + share[..., None] * (pictured - model)
    inside = cv2.resize(
        np.clip(INSIDE_LIGHT_SHARE * model, 0, 255), (INSIDE_COLUMNS, height), interpolation=cv2.INTER_AREA
    )
    return np.clip(outside + 0.5, 0, 255).astype(np.uint8), np.asarray(inside + 0.5, np.uint8)


def _strand_levels(seen: NDArray[np.uint8], own: NDArray[np.bool_], sigma: float) -> float:
    """How strong strands are, sRGB levels: what is fine about the pixels (h, w) that are hair's own."""
    light = seen.mean(-1).astype(np.float32)
    weight = own.astype(np.float32)
    around = cv2.GaussianBlur(light * weight, (0, 0), sigma) / np.maximum(cv2.GaussianBlur(weight, (0, 0), sigma), 1e-3)
    return min(1.4826 * float(np.median(np.abs(light - around)[own])), MAX_STRAND_DEVIATION_LEVELS)


def _strands(shape: tuple[int, int], metres: float) -> NDArray[np.float32]:
    """Noise along strands of hair that hangs (A, `COLUMNS`) and is so many metres long, of mean 0 and deviation 1."""
    rows = max(int(metres / ROW_METRES / HANGING_STRAND_RATIO), 8)
    noise = strand_noise((rows, UNROLLED_COLUMNS))
    return np.asarray(cv2.resize(noise, (shape[1], shape[0]), interpolation=cv2.INTER_CUBIC), np.float32)


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
    odd: float,
) -> NDArray[np.float32]:
    """What the hair of a row is like (A, `COLUMNS`, 3) at angles (A, `COLUMNS`): the median of what is its own (h, w) on either side,
    going over from one to the other behind. What is seen over fewer than half of so many `odd` rows is no hair, as an ear."""
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
        usual = median_filter(smooth, (min(2 * round(odd / 2) + 1, len(known)), 1), mode="nearest")
        found.append(np.stack([np.interp(rows, known, usual[:, k]) for k in range(3)], 1))
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
