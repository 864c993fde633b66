"""A foot's colours where the picture does not show them: level all round, as shoes are made and worn.

Rows of an unrolled foot go from heel to toe, and of a foot that points at the viewer nobody sees those behind the ankle. But a sole
goes round at its height, the upper is above it, and above that is the sock: what is seen at a height says what is there behind.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import gaussian_filter1d

from engine.character.fit.template_fit import load_human
from engine.character.shell.colours.round import COLUMN_SINES, joined
from engine.character.shell.colours.unrolled import UnrolledPart
from engine.character.shell.template_mesh import template_mesh
from engine.render.rasterisation.attributes import interpolate

HEIGHT_STEP_METRES = 0.0025
"""Metres between the heights above the ground at which a foot's colours are told."""
HEIGHT_SMOOTHING_METRES = 0.004
"""Metres over which they are smoothed: a sole's edge is no softer."""
TOP_OF_THE_FOOT_WEIGHT = 0.1
"""How much the top of a foot counts, where its sides count 1: laces and tongues are in front alone."""
MIN_HEIGHT_CELLS = 4.0
"""Cells, as well seen as can be, from which on a height is known; with fewer, the nearest that is says the rest."""
LEVEL_SCALE_LEVELS = 30.0
"""sRGB levels from the mean of a height beyond which a colour counts little in it."""
LEVEL_ROBUST_ROUNDS = 3
"""Times by which the mean of a height is freed from what is unlike it."""

FootEvidence = tuple[NDArray[np.floating], NDArray[np.bool_], NDArray[np.floating]]
"""Of a foot's cells (A, `UNROLLED_COLUMNS`) their colours (..., 3), which of them are a source, and their cosines to the viewer."""


@cache
def foot_heights() -> NDArray[np.float32]:
    """Height (V,) of the template's vertices above the ground, metres, on the mean body."""
    places = load_human().space.mean[template_mesh().ids].astype(np.float32)
    return np.asarray(places[:, 1] - places[:, 1].min())


def level_round(
    part: UnrolledPart, own: FootEvidence, other: tuple[UnrolledPart, FootEvidence] | None
) -> tuple[NDArray[np.float32], NDArray[np.float32]]:
    """The colours (A, `UNROLLED_COLUMNS`, 3) of an unrolled foot, sRGB levels, those of its source and level beyond it; and how
    sure (A,) each row is of them, from 0 to 1. The `other` foot is dressed alike, and tells of heights, too. Where nothing
    is a source, nothing changes."""
    heights = _heights(part)
    told = [(heights, own)] if other is None else [(heights, own), (_heights(other[0]), other[1])]
    if not any(evidence[1].any() for _, evidence in told):
        return np.asarray(own[0], np.float32), np.zeros(len(own[0]), np.float32)
    model = _levels(told)[np.rint(heights / HEIGHT_STEP_METRES).astype(np.intp).clip(0, _count() - 1)]
    colours, source, _ = own
    filled = joined(model, colours, source, source.astype(np.float32)) if source.any() else model
    return np.where(source[..., None], colours, filled).astype(np.float32), np.ones(len(colours), np.float32)


def _heights(part: UnrolledPart) -> NDArray[np.float32]:
    """Heights of its cells, metres."""
    found = interpolate(foot_heights()[:, None], template_mesh().triangles, part.raster)
    return np.asarray(found[..., 0], np.float32)


@cache
def _count() -> int:
    """Heights that are told of: up to the knees no foot is higher."""
    return int(np.ceil(float(foot_heights().max()) / 4 / HEIGHT_STEP_METRES))


def _levels(told: Sequence[tuple[NDArray[np.float32], FootEvidence]]) -> NDArray[np.float32]:
    """The colour (N, 3) at each height, of what cells at it show."""
    weight, colours, level = [], [], []
    for heights, (seen, source, facing) in told:
        beside = TOP_OF_THE_FOOT_WEIGHT + (1 - TOP_OF_THE_FOOT_WEIGHT) * COLUMN_SINES**2
        weight.append((np.maximum(facing, 0) * beside)[source])
        colours.append(seen[source])
        level.append(np.rint(heights[source] / HEIGHT_STEP_METRES).astype(np.intp).clip(0, _count() - 1))
    well, shown, at = (np.concatenate(one) for one in (weight, colours, level))
    smooth = HEIGHT_SMOOTHING_METRES / HEIGHT_STEP_METRES
    trust = well.astype(np.float64)
    for _ in range(LEVEL_ROBUST_ROUNDS):
        count = gaussian_filter1d(np.bincount(at, trust, _count()), smooth)
        sums = [gaussian_filter1d(np.bincount(at, trust * shown[:, k], _count()), smooth) for k in range(3)]
        mean = np.stack(sums, 1) / np.maximum(count, 1e-9)[:, None]
        off = shown - mean[at]
        trust = well / (1 + (off**2).sum(1) / LEVEL_SCALE_LEVELS**2)
    known = np.flatnonzero(count >= min(MIN_HEIGHT_CELLS, float(count.max())))
    rows = np.arange(_count())
    nearest = known[np.abs(known[:, None] - rows).argmin(0)]
    return np.asarray(mean[nearest], np.float32)
