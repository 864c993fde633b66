"""What of the front is on the back as well: cloth with a pattern that is all over.

Real checks and flowers are better than any made of them. Of plain cloth nothing is kept: its pockets, folds and seams would be the front's again.
"""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import median_filter

from engine.character.texture.plain_cloth import TRUNK_SIDE_RADIANS
from engine.imaging.masks.mask_distance import dilate_mask, distance_inside

USUAL_WINDOW_METRES = 0.2
"""Metres of rows to each side over which it is told what is usual."""
MIN_DIFFERENCE_RATIO, MIN_DIFFERENCE_LEVELS = 3.0, 24.0
"""How many times as far as is usual, and how many sRGB levels at least, something is off that is no part of a pattern."""
ALL_OVER_QUANTILE, MIN_ALL_OVER_SHARE, PATTERN_REPEAT_METRES = 0.2, 0.1, 0.06
"""A pattern is in a row where, of all columns but the poorest, so much is unlike theirs within its repeat, metres."""
MIN_PATTERNED_ROWS_SHARE, PATTERN_EXTENT_METRES = 0.45, 0.5
"""A pattern is all over where it is in such a share of the rows within so many metres: a word is in fewer."""
MIN_KNOWN_CELLS_SHARE = 0.5
"""Share of the cells about one that are known, below which it does not tell of a pattern."""
THREAD_METRES = 0.0025
"""Metres over which the front's colours are one for that."""
CLOTH_METRES, MOTIF_METRES = 0.015, 0.03
"""Metres about a cell whose mean its fine detail is off, and about which a pattern, or what is behind, is one colour."""
SHADE_DISCOUNT = 0.5
"""Share of what is lighter or darker that does not count: cloth has folds."""
MIN_PATTERN_CONTRAST, DARK_LEVELS = 0.2, 20.0
"""Contrast of a pattern in the shade: share of what it is on, with so many levels added."""
UNLIKE_MARGIN_METRES = 0.015
"""Metres around what is unlike that are not kept either: its rim is mixed with the cloth."""
KEPT_BLEND_METRES, MIN_KEPT_METRES = 0.015, 0.06
"""Metres over which what is kept begins, and that a piece of it is wide at least."""
LEVEL_METRES, MIN_LEVEL_SHARE = 0.05, 0.05
"""Metres over which what is not kept takes on the level of what is, and the share of what is kept there from which on it does by half."""

SMOOTHED_CELLS = 4.0
"""Cells of a standard deviation at which wide smoothing is done."""


def kept_front(
    front: NDArray[np.float32],
    known: NDArray[np.bool_],
    behind: NDArray[np.float32],
    angle: NDArray[np.floating],
    step: float,
) -> NDArray[np.float32]:
    """The share (A, N) of each cell's front that is on the back, from 0 to 1.

    Parameters
    ----------
    front, known : (A, N, 3), levels, rows of something round from before, and (A, N) which of it is shown.
    behind : (A, N, 3), levels, the plain cloth that is behind it (`cloth_behind`).
    angle : (N,) radians from the middle.
    step : metres from row to row.
    """
    side = np.abs(angle) > TRUNK_SIDE_RADIANS[0]
    sides = known & side
    cloth = _mean_of(front, known, CLOTH_METRES / step)
    fine = _weighed(cv2.GaussianBlur(front, (0, 0), THREAD_METRES / step) - cloth, cloth)
    contrast = np.minimum(MIN_DIFFERENCE_LEVELS, MIN_PATTERN_CONTRAST * (cloth.mean(-1) + DARK_LEVELS))
    patterned = patterned_rows((known & (fine > contrast)).astype(np.float32), known, step)[:, None]

    row = _mean_of(behind, known, MOTIF_METRES / step)
    motif = _weighed(_mean_of(front, known, MOTIF_METRES / step) - row, row)
    unlike = ~patterned | (motif > _most_off(motif, MIN_DIFFERENCE_LEVELS, sides, step)[:, None])
    kept = known & ~dilate_mask(unlike & known, max(1, round(UNLIKE_MARGIN_METRES / step)))
    wide = KEPT_BLEND_METRES / step
    kernel = cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (2 * round(MIN_KEPT_METRES / 2 / step) + 1,) * 2)
    kept = cv2.morphologyEx(kept.astype(np.uint8), cv2.MORPH_OPEN, kernel) > 0
    way = np.clip(distance_inside(np.pad(kept, ((0, 0), (round(wide),) * 2), mode="edge")) / wide, 0, 1)
    way = way[:, round(wide) : way.shape[1] - round(wide)]
    return np.asarray(way * way * (3 - 2 * way), np.float32)


def patterned_rows(odd: NDArray[np.float32], known: NDArray[np.bool_], step: float) -> NDArray[np.bool_]:
    """Which rows (A,) are of a pattern that is all over: what is `odd` (A, n), 1, in its row comes again in nearly every column of which
    enough is `known` (A, n)."""
    size = (2 * round(PATTERN_REPEAT_METRES / 4 / step) + 1, 2 * round(PATTERN_REPEAT_METRES / 2 / step) + 1)
    there = cv2.blur(known.astype(np.float32), size, borderType=cv2.BORDER_REPLICATE)
    share = cv2.blur(odd * known, size, borderType=cv2.BORDER_REPLICATE) / np.maximum(there, MIN_KNOWN_CELLS_SHARE)
    told = there >= MIN_KNOWN_CELLS_SHARE
    patterned = np.zeros(len(odd), np.float32)
    rows = np.flatnonzero(told.any(1))
    if len(rows):
        least = np.nanquantile(np.where(told, share, np.nan)[rows], ALL_OVER_QUANTILE, axis=1)
        patterned[rows] = least > MIN_ALL_OVER_SHARE
    telling = np.zeros(len(odd), np.float32)
    telling[rows] = 1
    size = (1, 2 * round(PATTERN_EXTENT_METRES / 2 / step) + 1)
    far, most = (cv2.blur(one[:, None], size)[:, 0] for one in (patterned, telling))
    return np.asarray(far > MIN_PATTERNED_ROWS_SHARE * np.maximum(most, 1 / len(odd)))


def levelled_to(
    behind: NDArray[np.float32], front: NDArray[np.float32], share: NDArray[np.float32], step: float
) -> NDArray[np.float32]:
    """What is behind (A, N, 3) at the level of the `front` (A, N, 3) where that is kept by a `share` (A, N) near by."""
    soft = LEVEL_METRES / step
    mass = _soft(share, soft, soft)[..., None]
    apart = _soft(share[..., None] * (front - behind), soft, soft)
    return np.asarray(behind + apart / (mass + MIN_LEVEL_SHARE), np.float32)


def _mean_of(front: NDArray[np.float32], known: NDArray[np.bool_], soft: float) -> NDArray[np.float32]:
    """The mean of what is `known` (A, N) of the front (A, N, 3) about each cell."""
    there = known.astype(np.float32)
    mass = _soft(there, soft, soft)[..., None]
    return np.asarray(_soft(front * there[..., None], soft, soft) / np.maximum(mass, 1e-3), np.float32)


def _soft(values: NDArray[np.float32], across: float, along: float) -> NDArray[np.float32]:
    """Values (A, N) or (A, N, C) smoothed over so many cells, as standard deviations; wide ones on fewer cells."""
    height, width = values.shape[:2]
    fewer = max(1, int(across / SMOOTHED_CELLS)), max(1, int(along / SMOOTHED_CELLS))
    size = max(1, width // fewer[0]), max(1, height // fewer[1])
    small = cv2.resize(values, size, interpolation=cv2.INTER_AREA) if fewer != (1, 1) else values
    soft = cv2.GaussianBlur(
        small, (0, 0), across * size[0] / width, sigmaY=along * size[1] / height, borderType=cv2.BORDER_REPLICATE
    )
    return np.asarray(cv2.resize(soft, (width, height)) if fewer != (1, 1) else soft, np.float32)


def _weighed(apart: NDArray[np.floating], colour: NDArray[np.floating | np.integer]) -> NDArray[np.float32]:
    """Lengths (A, N) of differences (A, N, 3) from a `colour` (A, N, 3), in which lighter and darker count half: cloth has folds."""
    light = colour / np.maximum(np.linalg.norm(colour, axis=-1, keepdims=True), 1)
    shade = np.sum(apart * light, -1, keepdims=True)
    return np.asarray(np.linalg.norm(apart - SHADE_DISCOUNT * shade * light, axis=-1), np.float32)


def _most_off(off: NDArray[np.float32], least: float, sides: NDArray[np.bool_], step: float) -> NDArray[np.float32]:
    """By how many levels (A,) the front may be `off` (A, N): as far as is usual at the `sides` (A, N) far around, and by `least`."""
    told = np.flatnonzero(sides.any(1))
    if not len(told):
        return np.full(len(off), least, np.float32)
    usual = np.interp(np.arange(len(off)), told, np.nanmedian(np.where(sides, off, np.nan)[told], 1))
    size = 2 * round(USUAL_WINDOW_METRES / step) + 1
    return np.asarray(np.maximum(MIN_DIFFERENCE_RATIO * median_filter(usual, size, mode="nearest"), least), np.float32)
