"""A part's colours all round, from what is seen of it: cloth goes round.

Each row of an unrolled part is modelled by what its two sides say of it: a colour at its left, one at its right, and
between them the way from one to the other. What lies behind is what lies before it, seen through, as far as it is of
the model's kind, and the model itself elsewhere. A tie, a print, a zip or a collar is unlike the sides of its own rows,
and stays in front. A stripe, a belt or a plaid is like them, and goes round. As the model is exact at both sides, the
light of somebody lit from one side has no border behind.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import cv2
import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import median_filter

from engine.character.shell.colours.bare_rows import BareRows
from engine.character.shell.colours.between_hems import between_hems
from engine.character.shell.colours.unrolled import ROW_METRES, UNROLLED_COLUMNS
from engine.imaging.filling.pull_push import pull_push

BackTexture = Literal["see_through", "mirror", "inpaint"]

ROW_SMOOTHING_METRES = 0.005
"""Metres along a part over which its sides are averaged: a hem is no softer than that."""
VARIATION_WINDOW_METRES = 0.05
"""Metres along a part over which it is judged how much its sides vary."""
SIDE_START_HALF_WIDTHS = 0.5
"""How far aside a part's sides begin, in half widths, where it is judged how much they vary."""
MAX_SAME_KIND_COLOUR_DISTANCE = 8.0
"""CIE Lab distance within which colours are of one kind wherever sides are plain."""
CLOTH_LAB_WEIGHTS = np.array([0.7, 1.2, 1.2], np.float32)
"""How much lightness counts in distances of cloth's colours, and hues: cloth is lighter where light falls on it."""
MAX_COLOUR_DEVIATIONS = 2.5
"""How many of its sides' deviations a colour may be off the model."""
MIN_KIND_SHARE = 0.35
"""Share of the kind in what is around a cell, below which it is not; of twice as much, it is."""
MIXED_EDGE_METRES = 0.008
"""Metres around what is not of the kind, in which colours are mixed."""
FILL_BLEND_METRES = 0.04
"""Metres over which what is filled in comes to be as it is made, from where it meets what is seen."""
BARE_BLEND_METRES = 0.15
"""Metres along an arm over which what is filled of bare skin comes to be as it is made: its light changes softly, and once round an arm columns are a
quarter as wide as rows."""
MIN_ROW_CELLS = 6.0
"""Cells, as well seen as can be, from which on a row's side is known; with fewer, the nearest row that is says the rest."""
ROBUST_SCALE_LEVELS = 40.0
"""sRGB levels from the mean of a side beyond which a colour counts little in it."""
ROBUST_ROUNDS = 3
"""Times by which a side's mean is freed from what is unlike it."""
TRUNK_CROSSING_METRES = 0.15
"""Metres along the trunk that are as far as its other side; rows of limbs are rings."""
OTHER_SIDE_WEIGHT = 0.03
"""How much the other side of a row counts where this one is seen."""
BEST_SEEN_HALF_WIDTHS = 0.8
"""How far aside the sides are seen best, in half widths: the maximum of cos x sin^2 x."""
BORDER_SMOOTHING_METRES = 0.02
"""Metres along a part over which the border of what is seen is smoothed before what lies beyond it is reflected there."""
OTHER_SIDE_BLEND_SHARE = 0.3
"""Share of what is not seen of a row, in its middle, in which what comes from one side goes over into what comes from the other."""

COLUMN_RADIANS = ((np.arange(UNROLLED_COLUMNS) + 0.5) / UNROLLED_COLUMNS * 2 * np.pi - np.pi).astype(np.float32)
COLUMN_SINES = np.sin(COLUMN_RADIANS)
OPPOSITE_COLUMN_AND_WEIGHT = (
    (UNROLLED_COLUMNS // 2 - 1 - np.arange(UNROLLED_COLUMNS)) % UNROLLED_COLUMNS,
    np.ones(UNROLLED_COLUMNS, np.float32),
)
"""The column that is as far aside on the other half, and how much it counts."""


@dataclass(frozen=True)
class RowModel:
    """What the sides of each row say of it.

    colours : (A, `UNROLLED_COLUMNS`, 3).
    spread : (A, `UNROLLED_COLUMNS`) how far the sides are from these colours, CIE Lab.
    sure : (A,) how sure each row is of itself; 0 where only further ones say it.
    """

    colours: NDArray[np.float32]
    spread: NDArray[np.float32]
    sure: NDArray[np.float32]


def coloured_round(
    colours: NDArray[np.floating],
    source: NDArray[np.bool_],
    facing: NDArray[np.floating],
    back: BackTexture = "see_through",
    yoke: int | None = None,
    ring: bool = False,
    at_the_border: bool = False,
    bare: BareRows | None = None,
) -> tuple[NDArray[np.float32], NDArray[np.float32]]:
    """The colours (A, `UNROLLED_COLUMNS`, 3) of an unrolled part, sRGB levels: those of its `source` (A, `UNROLLED_COLUMNS`), and
    continued round it; and how sure (A,) each row is of them, from 0 to 1.

    `facing` (A, `UNROLLED_COLUMNS`): cosine to the viewer of each cell, negative behind. From the row `yoke` upwards a front has
    a neckline and no back has one: there the rows below are mirrored. A `ring`, as a limb is, is told by all that is seen
    of a row, and not by its sides alone. What is seen is laid behind as it lies before, or, `at_the_border`, reflected where it ends: of legs,
    which are seen over as much of their girth everywhere. What is not seen of `bare` rows is skin. Where nothing is a source, nothing changes.
    """
    if not source.any():
        return colours, np.zeros(len(colours), np.float32)
    turns = row_middles(facing)
    seen, known, near = (turned_rows(each, -turns) for each in (colours, source, facing))
    weight = (
        known.astype(np.float32) if ring else known * np.maximum(near, 0) * COLUMN_SINES**2
    )  # sides, as far as they are well seen
    model = row_model(seen, weight, 0.0 if ring else TRUNK_CROSSING_METRES, folds=False)
    kind = _of_the_kind(seen, model, known)
    through = {"mirror": known.astype(np.float32), "inpaint": 0 * kind, "see_through": kind}[back]
    rows = np.arange(len(seen))
    if yoke is not None and back == "see_through":
        rows = np.where(rows > yoke, np.maximum(2 * yoke - rows, 0), rows)
    own = through[..., None] * (seen - model.colours)
    ways = reflections(known) if at_the_border else [OPPOSITE_COLUMN_AND_WEIGHT]
    detail = np.zeros_like(seen)
    for partner, share in ways:
        detail += share[..., None] * own[rows[:, None], partner]
    filled, reach = model.colours + detail, np.full((len(seen), 1), FILL_BLEND_METRES, np.float32)
    if bare is not None and bare.rows.any():
        share = _blurred(bare.rows[:, None].astype(np.float32), ROW_SMOOTHING_METRES)[..., None]
        filled, kind = filled + share * (bare.colour - filled), np.maximum(kind, share[..., 0])
        reach += share[..., 0] * (BARE_BLEND_METRES - reach)
    filled = joined(filled, seen, known, known * kind, reach)
    return turned_rows(np.where(known[..., None], seen, filled), turns), model.sure


def reflections(known: NDArray[np.bool_]) -> list[tuple[NDArray[np.intp], NDArray[np.float32]]]:
    """For each cell (A, `UNROLLED_COLUMNS`) the column that mirrors it at the border of what is `known` of its row: as
    far within as the cell is beyond. There is one for the border at its left and one for that at its right, and how
    much each counts. The middle column faces the viewer. So what is seen goes on at its border without a seam, to and
    fro; behind, one side goes over into the other. What is within is itself."""
    middle, columns = UNROLLED_COLUMNS // 2, np.arange(UNROLLED_COLUMNS)
    quarter = UNROLLED_COLUMNS // 4
    there = known & (np.abs(columns - middle) <= quarter)
    told = there.sum(1) >= MIN_ROW_CELLS
    if not told.any():
        return []
    first = np.where(told, there.argmax(1), 0).astype(np.float32)
    last = np.where(told, UNROLLED_COLUMNS - 1 - there[:, ::-1].argmax(1), 0).astype(np.float32)
    rows = np.arange(len(known))
    first, last = (
        _blurred(np.interp(rows, rows[told], one[told])[:, None].astype(np.float32), BORDER_SMOOTHING_METRES)
        for one in (first, last)
    )
    first, last = np.minimum(first, middle - 1), np.maximum(last, middle + 1)
    found = []
    gap = UNROLLED_COLUMNS - (last - first)
    inside = (columns >= first) & (columns <= last)
    for border, inwards in ((last, -1), (first, 1)):
        beyond = (-inwards * (columns - border)) % UNROLLED_COLUMNS  # around the back, from this border on
        fold = beyond % (2 * (last - first))
        within = np.minimum(fold, 2 * (last - first) - fold)
        partner = np.rint(border + inwards * within).astype(np.intp) % UNROLLED_COLUMNS
        share = np.clip(0.5 + (0.5 - beyond / gap) / OTHER_SIDE_BLEND_SHARE, 0, 1)
        share = np.where(inside, inwards < 0, share * share * (3 - 2 * share))
        found.append((np.where(inside, columns, partner), np.asarray(share, np.float32)))
    return found


def with_the_other(
    own: tuple[NDArray, NDArray, NDArray], other: tuple[NDArray, NDArray, NDArray]
) -> tuple[NDArray, NDArray, NDArray]:
    """Colours (A, `UNROLLED_COLUMNS`, 3), source and facing (A, `UNROLLED_COLUMNS`) of an unrolled limb, with those of the other side's
    limb in rows of which hardly anything is seen: both are dressed alike."""
    count = min(len(own[0]), len(other[0]))
    few = own[1].sum(1) < MIN_ROW_CELLS
    few[:count] &= other[1][:count].sum(1) >= MIN_ROW_CELLS
    few[count:] = False
    found = []
    for one, instead in zip(own, other, strict=True):
        mixed = one.copy()
        mixed[few] = instead[:count][few[:count], ::-1]
        found.append(mixed)
    return found[0], found[1], found[2]


def row_middles(facing: NDArray[np.floating]) -> NDArray[np.intp]:
    """By how many columns (A,) from the middle one the place is away at which each row faces the viewer, smoothly along the part."""
    towards = np.maximum(facing, 0) @ np.stack([np.cos(COLUMN_RADIANS), COLUMN_SINES], 1)
    smooth = _blurred(towards.astype(np.float32), VARIATION_WINDOW_METRES)
    return np.rint(np.arctan2(smooth[:, 1], smooth[:, 0]) / (2 * np.pi) * UNROLLED_COLUMNS).astype(np.intp)


def turned_rows(values: NDArray, by: NDArray[np.intp]) -> NDArray:
    """Rows (A, `UNROLLED_COLUMNS`, ...) each turned by so many columns (A,)."""
    columns = (np.arange(UNROLLED_COLUMNS)[None] - by[:, None]) % UNROLLED_COLUMNS
    return values[np.arange(len(values))[:, None], columns]


def row_model(
    seen: NDArray[np.floating],
    weight: NDArray[np.floating],
    across: float = TRUNK_CROSSING_METRES,
    *,
    folds: bool = True,
) -> RowModel:
    """What is `seen` (A, `UNROLLED_COLUMNS`, 3) of the sides of each row, the middle column facing the viewer. `weight`
    (A, `UNROLLED_COLUMNS`) is how well it is seen. `across` is how many metres along the part are as far as the other
    side. Without `folds`, what is lighter or darker along it is averaged between hems."""
    sides = [_side(seen, weight * (side * COLUMN_SINES > 0)) for side in (-1, 1)]
    values, counts = (np.stack(each, 1) for each in zip(*sides, strict=True))  # (A, 2, 3 + 1), (A, 2)
    known, other = counts[..., None], OTHER_SIDE_WEIGHT * counts[:, ::-1, None]
    values = (known * values + other * values[:, ::-1]) / np.maximum(known + other, 1e-6)
    values = _on_both_sides(_nearest_rows(values, (known + other)[..., 0], across))
    if not folds:
        values = between_hems(
            values, counts >= min(MIN_ROW_CELLS, float(counts.max())), ROW_METRES, 2 * ROW_SMOOTHING_METRES
        )
    share = (np.clip(COLUMN_SINES / BEST_SEEN_HALF_WIDTHS, -1, 1) * 0.5 + 0.5)[None, :, None]
    between = np.asarray((1 - share) * values[:, :1] + share * values[:, 1:], np.float32)
    sure = np.clip(counts.max(1) / MIN_ROW_CELLS, 0, 1).astype(np.float32)
    return RowModel(between[..., :3], np.sqrt(np.maximum(between[..., 3], 0)), sure)


def _side(seen: NDArray[np.floating], weight: NDArray[np.floating]) -> tuple[NDArray[np.float32], NDArray[np.float32]]:
    """One side's colour in each row and the square of what it varies by (A, 4), and how many cells say so (A,). What is unlike
    the others counts little."""
    told = weight.any(0)
    if not told.any():
        return np.zeros((len(seen), 4), np.float32), np.zeros(len(seen), np.float32)
    seen, weight, aside = seen[:, told], weight[:, told], np.abs(COLUMN_SINES[told])
    trust = np.asarray(weight, np.float64)
    mean = np.zeros((len(seen), 3))
    for _ in range(ROBUST_ROUNDS):
        count = _blurred(trust.sum(1), ROW_SMOOTHING_METRES)
        mean[:] = (
            _blurred(np.einsum("an,anc->ac", trust, seen), ROW_SMOOTHING_METRES) / np.maximum(count, 1e-6)[:, None]
        )
        off = seen - mean[:, None]
        trust = weight / (1 + np.einsum("anc,anc->an", off, off) / ROBUST_SCALE_LEVELS**2)
    away = (_lab(seen) - _lab(mean[:, None])) * CLOTH_LAB_WEIGHTS
    trust = trust * (aside > SIDE_START_HALF_WIDTHS)
    varies = _blurred((trust * np.einsum("anc,anc->an", away, away)).sum(1), VARIATION_WINDOW_METRES)
    squares = varies / np.maximum(_blurred(trust.sum(1), VARIATION_WINDOW_METRES), 1e-6)
    return np.concatenate([mean, squares[:, None]], 1).astype(np.float32), _blurred(weight.sum(1), ROW_SMOOTHING_METRES)


def _on_both_sides(values: NDArray[np.floating]) -> NDArray[np.float32]:
    """Values (A, 2, C) of a part's rows without what one side alone has there, a letter or a pocket: by how much the sides differ more
    than is usual around is taken off the one that is the odder."""
    size = 2 * round(VARIATION_WINDOW_METRES / ROW_METRES) + 1
    usual = median_filter(values, (size, 1, 1), mode="nearest")
    apart = values[:, 0] - values[:, 1]
    more = apart - median_filter(apart, (size, 1), mode="nearest")
    odd = np.linalg.norm((values - usual)[..., :3], axis=-1, keepdims=True)
    share = odd / np.maximum(odd.sum(1, keepdims=True), 1e-6)
    return np.asarray(values - share * more[:, None] * np.array([1, -1])[None, :, None], np.float32)


def _nearest_rows(values: NDArray[np.floating], count: NDArray[np.floating], across: float) -> NDArray[np.float32]:
    """Values (A, 2, C) of a part's rows, of which those that few cells (A, 2) tell of are taken from another. That is
    the nearest row of the same side of which more cells tell, or, where that is `across` further off, of the other
    side. No garment fades into the next."""
    known = count >= min(MIN_ROW_CELLS, float(count.max()))
    rows = np.arange(len(values))
    places, away = np.zeros((2, len(values)), np.intp), np.full((2, len(values)), np.inf)
    for side in (0, 1):
        good = np.flatnonzero(known[:, side])
        if len(good):
            after = np.searchsorted(good, rows).clip(max=len(good) - 1)
            pair = good[np.stack([np.maximum(after - 1, 0), after])]
            nearer = np.abs(pair - rows).argmin(0)
            places[side] = pair[nearer, rows]
            away[side] = np.abs(places[side] - rows) * ROW_METRES
    whole = np.empty_like(values)
    for side in (0, 1):
        own = away[side] <= away[1 - side] + across
        whole[:, side] = np.where(own[:, None], values[places[side], side], values[places[1 - side], 1 - side])
    return _blurred(whole, ROW_SMOOTHING_METRES / 2)


def _of_the_kind(seen: NDArray[np.floating], model: RowModel, known: NDArray[np.bool_]) -> NDArray[np.float32]:
    """How far (A, `UNROLLED_COLUMNS`), from 0 to 1, cells are of the same kind as the sides of their rows."""
    off = np.linalg.norm((_lab(seen) - _lab(model.colours)) * CLOTH_LAB_WEIGHTS, axis=-1)
    kind = known / (1 + (off / np.hypot(MAX_SAME_KIND_COLOUR_DISTANCE, MAX_COLOUR_DEVIATIONS * model.spread)) ** 4)
    size = 2 * round(MIXED_EDGE_METRES / ROW_METRES) + 1
    wide = np.concatenate([kind, kind, kind], 1).astype(np.float32)
    usual = np.asarray(cv2.medianBlur(wide, 5))
    mostly = np.minimum(usual, np.clip((cv2.blur(usual, (size, size)) - MIN_KIND_SHARE) / MIN_KIND_SHARE, 0, 1))
    calm = cv2.blur(cv2.erode(mostly, np.ones((size, size), np.uint8)), (size, size))
    return np.asarray(calm[:, UNROLLED_COLUMNS : 2 * UNROLLED_COLUMNS] * known, np.float32)


def continued_rows(colours: NDArray[np.floating], weight: NDArray[np.floating]) -> NDArray[np.float32]:
    """Colours (A, `UNROLLED_COLUMNS`, C) continued smoothly from where they have a `weight` (A, `UNROLLED_COLUMNS`), across the ends of
    rows."""
    quarter = UNROLLED_COLUMNS // 4
    wide, there = (np.concatenate([each[:, -quarter:], each, each[:, :quarter]], 1) for each in (colours, weight))
    return pull_push(wide, there)[:, quarter : quarter + UNROLLED_COLUMNS]


def joined(
    filled: NDArray[np.floating],
    seen: NDArray[np.floating],
    known: NDArray[np.bool_],
    trust: NDArray[np.floating],
    reach: NDArray[np.floating] | float = FILL_BLEND_METRES,
) -> NDArray[np.float32]:
    """What is `filled` in, (A, `UNROLLED_COLUMNS`, 3), moved to what is `seen` where both meet, as far as that is of its kind, `trust`
    (A, `UNROLLED_COLUMNS`), and less and less over a `reach`, metres along the part, one or of each
    row (A, 1)."""
    moved = continued_rows(seen - filled, trust)
    wide = np.concatenate([known, known, known], 1)
    away = (
        cv2.distanceTransform((~wide).astype(np.uint8), cv2.DIST_L2, 5)[:, UNROLLED_COLUMNS : 2 * UNROLLED_COLUMNS]
        * ROW_METRES
    )
    return np.asarray(filled + moved * np.exp(-away / reach)[..., None], np.float32)


def _blurred(values: NDArray[np.floating], metres: float) -> NDArray[np.float32]:
    """Values (A, ...) averaged along a part."""
    flat = np.ascontiguousarray(values.reshape(len(values), -1), np.float32)
    out = cv2.GaussianBlur(flat, (1, 0), 1, sigmaY=metres / ROW_METRES, borderType=cv2.BORDER_REFLECT)
    return np.asarray(out, np.float32).reshape(values.shape)


def _lab(rgb: NDArray[np.floating]) -> NDArray[np.float32]:
    return np.asarray(
        cv2.cvtColor(np.clip(rgb, 0, 255).astype(np.float32) / np.float32(255), cv2.COLOR_RGB2LAB), np.float32
    )
