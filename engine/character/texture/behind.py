"""What is behind something round: what is seen of its sides, drawn together over the middle.

Cloth goes round: what somebody wears on the back is what shows at their sides at the same height. So of each row only
the outer parts are ever a source, whatever the middle shows. Ties, prints, zips, openings and scarves cannot come to
the back. Belts, hems and collars, stripes, checks and creases that are at the sides stay at their height. Both sides
are stretched until they meet, cut where they are most alike (A. A. Efros, W. T. Freeman, Image Quilting for Texture
Synthesis and Transfer, SIGGRAPH 2001, section 2.1), and each takes on the other's light on the way there. What is
hidden of one side is as the other has it at the same height.
"""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import median_filter

SIDE_END_RADIANS = np.radians(34.0)
"""From the middle, where both sides end that are drawn together over it: beyond half of the way to the outline in the picture."""
BACK_SEAM_RADIANS = np.radians(9.0)
"""Radians on either side of the middle behind within which colours of both sides are to be had and the cut between them
runs."""
LIGHT_WINDOW_METRES = 0.2
"""Metres of rows to each side over which the light is one."""
MIN_DIFFERENCE_RATIO, MIN_DIFFERENCE_LEVELS = 3.0, 24.0
"""How many times as far as is usual, and how many sRGB levels at least, sides are apart where one has something of its own."""
ALL_OVER_QUANTILE, MIN_ALL_OVER_SHARE, PATTERN_REPEAT_METRES = 0.2, 0.05, 0.06
"""A pattern is in a row where, of all columns but the poorest, so much is unlike theirs within its repeat, metres."""
MIN_PATTERNED_ROWS_SHARE, PATTERN_EXTENT_METRES = 0.45, 0.5
"""A pattern is all over where it is in such a share of the rows within so many metres: a word is in fewer."""
MIN_KNOWN_CELLS_SHARE = 0.5
"""Share of the cells that are usually known in a row, below which it is not told by those that are."""
SEAM_LIGHT_METRES = 0.03
"""Metres of rows over which both sides are brought to one level where they meet."""
SIDE_BLEND_METRES = 0.01
"""Metres over which what is seen of a side goes over into what the other says of it."""


def seen_through(
    seen: NDArray[np.floating], known: NDArray[np.bool_], angle: NDArray[np.floating], step: float
) -> NDArray[np.float32]:
    """What is behind rows of something round, (A, N, 3), seen through from before.

    Parameters
    ----------
    seen, known : (A, N, 3), levels, what is before, and (A, N) which of it may be a source.
    angle : (N,) radians from the middle, from about -pi / 2 to pi / 2, evenly.
    step : metres from row to row.

    Where nothing is known of any side, it is what is before.
    """
    pace = (np.pi / 2 - SIDE_END_RADIANS) / (np.pi / 2)
    columns = int(np.searchsorted(angle, BACK_SEAM_RADIANS * pace - SIDE_END_RADIANS))
    left, right = seen[:, :columns].astype(np.float32), seen[:, ::-1][:, :columns].astype(np.float32)
    there = known[:, :columns], known[:, ::-1][:, :columns]
    if not (there[0] | there[1]).any():
        return np.asarray(seen, np.float32)
    aside = np.abs(np.sin(angle[:columns])).astype(np.float32)[None, :, None]
    inner = slice(int(np.searchsorted(angle, -BACK_SEAM_RADIANS * pace - SIDE_END_RADIANS)), columns)
    light = _light(left[:, inner], right[:, inner], (there[0] & there[1])[:, inner], aside[:, inner], step)[:, None]
    sides = _whole(left, right - light * aside, *there, step), _whole(right, left + light * aside, *there[::-1], step)
    sides = _agreed(*_without_prints(sides[0], sides[1], light * aside, step), light * aside, step)
    reach = int(np.searchsorted(angle, BACK_SEAM_RADIANS))
    down = np.ascontiguousarray(np.broadcast_to(np.arange(len(seen), dtype=np.float32)[:, None], (len(seen), reach)))
    across = np.ascontiguousarray(np.broadcast_to(np.arange(reach, dtype=np.float32) * np.float32(pace), down.shape))
    nearer = (np.sin(np.pi / 2 - (angle[:reach] + np.pi / 2) * pace) + np.sin(angle[:reach])) / 2
    halves = []
    for side, sign in zip(sides, (1, -1), strict=True):
        drawn = cv2.remap(side, across, down, cv2.INTER_LINEAR)
        halves.append(drawn + sign * nearer.astype(np.float32)[None, :, None] * light)
    join = 2 * reach - len(angle)
    return sewn(*_levelled(halves[0], halves[1][:, ::-1], join, step), join)


def _light(
    left: NDArray[np.float32],
    right: NDArray[np.float32],
    both: NDArray[np.bool_],
    aside: NDArray[np.float32],
    step: float,
) -> NDArray[np.float32]:
    """By how much (A, 3) the right side (A, n, 3) is lighter than the left at the outline, by what is known of `both`
    (A, n) within `LIGHT_WINDOW_METRES`. In between it is as much of that as cells are `aside` (1, n, 1)."""
    rows = np.flatnonzero(both.any(1))
    if not len(rows):
        return np.zeros((len(left), 3), np.float32)
    apart = np.nanmedian(np.where(both[rows][..., None], (right[rows] - left[rows]) / aside, np.nan), 1)
    size = 2 * round(LIGHT_WINDOW_METRES / step) + 1
    calm = median_filter(apart, (size, 1), mode="nearest")
    whole = np.stack([np.interp(np.arange(len(left)), rows, one) for one in calm.T], 1).astype(np.float32)
    soft = cv2.GaussianBlur(whole, (1, 0), 1, sigmaY=size / 4, borderType=cv2.BORDER_REPLICATE)
    return np.asarray(soft, np.float32)


def _whole(
    own: NDArray[np.float32],
    other: NDArray[np.float32],
    known: NDArray[np.bool_],
    of_other: NDArray[np.bool_],
    step: float,
) -> NDArray[np.float32]:
    """One side (A, n, 3). It has its `own` colours where they are `known` (A, n), and the `other`'s where they are not.
    Where neither are, it has those of the nearest of its row. Rows of which nothing is known have what lies between
    those before and after."""
    if known.all():
        return own
    either = known | of_other
    said = np.where(known[..., None], own, other)
    said = _in_its_row(said, either)
    share = cv2.GaussianBlur(known.astype(np.float32), (0, 0), SIDE_BLEND_METRES / step)
    share = np.where(known, np.clip(2 * share - 1, 0, 1), 0)[..., None]
    behind = np.where(of_other[..., None], other, said)
    return np.asarray(share * own + (1 - share) * behind, np.float32)


def _in_its_row(colours: NDArray[np.float32], known: NDArray[np.bool_]) -> NDArray[np.float32]:
    """Colours (A, n, 3) where they are `known` (A, n), which they are somewhere; elsewhere the nearest of the row, or between rows."""
    columns = np.arange(known.shape[1])[None]
    before = np.maximum.accumulate(np.where(known, columns, -1), 1)
    after = np.minimum.accumulate(np.where(known, columns, known.shape[1])[:, ::-1], 1)[:, ::-1]
    nearer = (before >= 0) & ((columns - before <= after - columns) | (after >= known.shape[1]))
    nearest = np.clip(np.where(nearer, before, after), 0, known.shape[1] - 1)
    whole = np.take_along_axis(colours, nearest[..., None], 1)
    count, rows = known.sum(1), np.arange(len(known))
    told = np.flatnonzero(count >= max(1.0, MIN_KNOWN_CELLS_SHARE * float(np.median(count[count > 0]))))
    at = np.interp(rows, told, np.arange(len(told)))
    low = np.floor(at).astype(np.intp)
    share = (at - low).astype(np.float32)[:, None, None]
    between = (1 - share) * whole[told[low]] + share * whole[told[np.minimum(low + 1, len(told) - 1)]]
    return np.where(known[..., None], colours, between).astype(np.float32)


def _without_prints(
    left: NDArray[np.float32], right: NDArray[np.float32], light: NDArray[np.float32], step: float
) -> tuple[NDArray[np.float32], NDArray[np.float32]]:
    """Both sides (A, n, 3) without what is unlike most of its row and more so than is usual far around, as letters that reach there; stripes and
    checks are all over."""
    row = np.median(np.concatenate([left, right - light], 1), 1)
    row = median_filter(row, (2 * round(SIDE_BLEND_METRES / step) + 1, 1), mode="nearest")[:, None]
    size = 2 * round(LIGHT_WINDOW_METRES / step) + 1
    off = np.linalg.norm(np.concatenate([left - row, right - light - row], 1), axis=-1).astype(np.float32)
    usual = median_filter(np.median(off, 1), size, mode="nearest")[:, None]
    odd = (off > np.maximum(MIN_DIFFERENCE_RATIO * usual, MIN_DIFFERENCE_LEVELS)).astype(np.float32)
    odd[patterned_rows(odd, np.ones(odd.shape, np.bool_), step)] = 0
    found, columns = [], left.shape[1]
    for one, most, which in ((left, row, odd[:, :columns]), (right, row + light, odd[:, columns:])):
        soft = cv2.GaussianBlur(which, (0, 0), SIDE_BLEND_METRES / step / 2)
        share = np.clip(3 * soft, 0, 1)[..., None]
        found.append(np.asarray((1 - share) * one + share * most, np.float32))
    return found[0], found[1]


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
    far = cv2.blur(patterned[:, None], (1, 2 * round(PATTERN_EXTENT_METRES / 2 / step) + 1))[:, 0]
    return np.asarray(far > MIN_PATTERNED_ROWS_SHARE)


def _agreed(
    left: NDArray[np.float32], right: NDArray[np.float32], light: NDArray[np.float32], step: float
) -> tuple[NDArray[np.float32], NDArray[np.float32]]:
    """Both sides (A, n, 3) without what one alone has, as a pocket, a bag or a strand of hair: where they differ more than is usual far
    around, both have what is the more like all of their rows."""
    other = right - light
    apart = cv2.blur(
        np.linalg.norm(left - other, axis=-1).astype(np.float32), (1, 2 * round(SIDE_BLEND_METRES / step) + 1)
    )
    size = 2 * round(LIGHT_WINDOW_METRES / step) + 1
    usual = median_filter(np.median(apart, 1), size, mode="nearest")[:, None]
    contested = (apart > np.maximum(MIN_DIFFERENCE_RATIO * usual, MIN_DIFFERENCE_LEVELS)).astype(np.float32)
    both = np.median(np.concatenate([left, other], 1), 1)
    both = median_filter(both, (2 * round(LIGHT_WINDOW_METRES / 4 / step) + 1, 1), mode="nearest")[:, None]
    soft = SIDE_BLEND_METRES / step
    odd = [
        cv2.GaussianBlur(np.linalg.norm(one - both, axis=-1).astype(np.float32), (0, 0), soft) for one in (left, other)
    ]
    where = np.clip(2 * cv2.GaussianBlur(contested, (0, 0), soft), 0, 1)
    found = []
    for one, instead, more in ((left, other, odd[0] - odd[1]), (right, left + light, odd[1] - odd[0])):
        share = (where * np.clip(more / MIN_DIFFERENCE_LEVELS + 0.5, 0, 1))[..., None]
        found.append(np.asarray((1 - share) * one + share * instead, np.float32))
    return found[0], found[1]


def _levelled(
    left: NDArray[np.float32], right: NDArray[np.float32], join: int, step: float
) -> tuple[NDArray[np.float32], NDArray[np.float32]]:
    """Two pictures (A, N, 3) and (A, M, 3) joined: the last `join` columns of one lie on the first of the other, and
    each goes over to what is between both there. What is left of a difference over some rows is no pattern, and would
    be an edge."""
    apart = np.median(right[:, :join] - left[:, -join:], 1)
    apart = cv2.GaussianBlur(
        apart.astype(np.float32), (1, 0), 1, sigmaY=SEAM_LIGHT_METRES / step, borderType=cv2.BORDER_REPLICATE
    )
    found = []
    for one, sign in ((left, 0.5), (right[:, ::-1], -0.5)):
        way = np.clip(np.arange(one.shape[1], dtype=np.float32) / (one.shape[1] - join), 0, 1)
        found.append(one + sign * (way * way * (3 - 2 * way))[None, :, None] * apart[:, None])
    return found[0], found[1][:, ::-1]


def sewn(left: NDArray[np.floating], right: NDArray[np.floating], join: int) -> NDArray[np.float32]:
    """Two pictures (A, N, 3) and (A, M, 3) of which the last and the first `join` columns overlap, cut from top to bottom where they
    differ least, (A, N + M - join, 3): the minimum error boundary cut."""
    cost = ((left[:, -join:] - right[:, :join]) ** 2).sum(-1).astype(np.float64)
    for row in range(1, len(cost)):
        above = np.pad(cost[row - 1], 1, constant_values=np.inf)
        cost[row] += np.minimum(np.minimum(above[:-2], above[1:-1]), above[2:])
    cut = np.zeros(len(cost), np.intp)
    cut[-1] = cost[-1].argmin()
    for row in range(len(cost) - 2, -1, -1):
        low = max(int(cut[row + 1]) - 1, 0)
        cut[row] = low + cost[row, low : cut[row + 1] + 2].argmin()
    soft = max(2.0, join / 4)
    share = np.clip((np.arange(join)[None] - cut[:, None]) / soft + 0.5, 0, 1)[..., None]
    share = np.where(
        np.arange(join)[None, :, None] == 0, 0, np.where(np.arange(join)[None, :, None] == join - 1, 1, share)
    )
    both = (1 - share) * left[:, -join:] + share * right[:, :join]
    return np.concatenate([left[:, :-join], both, right[:, join:]], 1).astype(np.float32)
