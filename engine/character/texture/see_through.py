"""The back of the trunk as its front seen through, without what only fronts have: ties, prints, zips, collars, necklaces.

Cloth goes round: what somebody wears on the back is what is seen of it at their sides, at the same height. So a colour that
hardly occurs at the sides of its own height is taken off, and what is left is continued over it. Patterned cloth differs from
itself at the sides, too, and is kept as it is.
"""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import maximum_filter1d, minimum_filter1d, uniform_filter

from engine.imaging.filling.inpaint import inpaint
from engine.imaging.masks.mask_distance import dilate_mask
from engine.imaging.masks.mask_pieces import pieces_by_area, pieces_touching
from engine.imaging.resample import enlarged_mask, resized

SIDE_FROM, SIDE_TO = 0.6, 0.94
"""Where its sides are, as shares of the way from the middle of the trunk to its outline: of a round trunk, from 37 to 70 degrees."""
BAND = 0.05
"""Half the height over which sides are looked at, as a share of the person's."""
SHOULDERS = 0.75
"""Share of the trunk's usual width from which it is one: what is above, up to the neck, is held against this height."""
BIN = 6.0
"""CIE Lab units of a bin of colours; those beside it are alike."""
RARE, DOUBTFUL = 0.12, 0.3
"""Shares of the sides below which a colour is none of the cloth's, and below which it is not where it touches such."""
PATTERNED, MOST_OF_PATTERN = 0.6, 0.3
"""How often all sides may have a colour, beside how often the middle has it, before it is a pattern's; and the share of a piece in such
colours from which all of it is: half a word would be worse than one."""
ROUND = 0.75
"""Share of the trunk's width that a piece has at some height, if it goes round, as a belt does."""
LEAST = 0.004
"""Share of the trunk's pixels that a feature has at least: what is smaller is a pattern's, or a shadow."""
CLOSED = 7
"""Pixels of the grid between parts of one feature, as letters of a word."""
MOST = 0.6
"""Share of the middle that the front alone may have: if it is more, the sides tell nothing, as where they have no light."""
SKIN = 0.05
"""Share of a face from which a colour is its skin's."""
MOST_BARE = 0.5
"""Share of the sides that may be bare: else it is cloth in a skin's colour, or nobody wears any."""
EDGE = 3
"""Pixels of the grid around what is taken off, in which it is mixed with the cloth."""
LIGHTNESSES, HUES = 18, 44
"""Bins of lightness, and of each hue."""


def without_front_features(
    rgb: NDArray[np.uint8],
    trunk: NDArray[np.bool_],
    legs: NDArray[np.bool_],
    head: NDArray[np.bool_],
    face: NDArray[np.bool_],
    own: NDArray[np.bool_],
) -> NDArray[np.uint8]:
    """The colours (H, W, 3) with those of the trunk continued over what only its front has.

    Parameters
    ----------
    trunk, legs, head, face : (h, w) on the grid, which covers what `rgb` covers: where they are.
    own : (H, W), the pixels whose colour is the person's own.
    """
    size = (own.shape[1], own.shape[0])
    found = front_features(resized(rgb, (trunk.shape[1], trunk.shape[0])), trunk, legs, head, face)
    if not found.features.any():
        return rgb
    hole = enlarged_mask(found.features, size) & own
    return inpaint(rgb, hole, enlarged_mask(found.cloth, size) & own & ~hole)


@dataclass(frozen=True)
class FrontFeatures:
    """`features` (h, w): what only the front has; `cloth` (h, w): what goes round and is no bare skin."""

    features: NDArray[np.bool_]
    cloth: NDArray[np.bool_]


def front_features(
    rgb: NDArray[np.uint8],
    trunk: NDArray[np.bool_],
    legs: NDArray[np.bool_],
    head: NDArray[np.bool_],
    face: NDArray[np.bool_],
) -> FrontFeatures:
    """What of the `trunk` (h, w) of a picture (h, w, 3) has colours that its sides, and those of the `legs` (h, w) at the same height,
    have not; `head` and `face` (h, w): where they are.

    Bare skin at the sides, as beside a shirt without sleeves, is no cloth that goes round: neither is it held against what is between
    it, nor is it taken off itself.
    """
    nothing = FrontFeatures(np.zeros_like(trunk), trunk)
    if not trunk.any():
        return nothing
    across = _across(trunk, legs, head)
    bins = _bins(rgb[across.mask])
    sides = np.abs(across.place) > SIDE_FROM
    skin = _share(_bins(rgb[face]))[tuple(bins.T)] > SKIN
    skin &= bool(skin[sides].mean() < MOST_BARE)
    bare = pieces_touching(across.drawn(skin), across.drawn(skin & sides))
    cloth = sides & ~skin & (np.abs(across.place) < SIDE_TO)
    if not cloth.any():
        return nothing
    share = np.where(bare[across.mask], 1, _share_beside(bins, cloth, across))
    if (share[~sides] < RARE).mean() > MOST:
        return nothing
    beside, between = (_share(bins[one])[tuple(bins.T)] for one in (cloth, ~sides))
    pattern = across.drawn(beside > PATTERNED * between)
    usual = np.ones(trunk.shape, np.float32)
    usual[across.mask] = np.where(np.abs(across.place) < SIDE_TO, share, 1)
    usual = np.asarray(cv2.medianBlur(usual, 3))
    rare = pieces_touching(usual < DOUBTFUL, (usual < RARE) & across.drawn(~sides))
    features = np.zeros_like(trunk)
    for piece in pieces_by_area(rare, LEAST * trunk.sum(), connectivity=8):
        rows = np.bincount(across.row, piece[across.mask], across.height)
        wide = rows > ROUND * np.bincount(across.row, minlength=across.height)
        goes_round = wide[across.shoulders + 1 :].any()
        if not goes_round and pattern[piece].mean() < MOST_OF_PATTERN:
            features |= piece
    closed = cv2.morphologyEx(features.astype(np.uint8), cv2.MORPH_CLOSE, np.ones((CLOSED, CLOSED), np.uint8)) > 0
    features = dilate_mask(without_holes(closed), EDGE) & trunk
    return FrontFeatures(features, across.mask & ~features & ~dilate_mask(across.drawn(skin), EDGE))


def without_holes(mask: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """A mask (h, w) with all that it encloses."""
    border = np.zeros_like(mask)
    border[[0, -1]] = border[:, [0, -1]] = True
    return ~pieces_touching(~mask, border)


def _share_beside(bins: NDArray[np.intp], cloth: NDArray[np.bool_], across: _Across) -> NDArray[np.float32]:
    """Which share of the `cloth` (P,) of the sides at its height has each pixel's colour, (P,)."""
    share = np.ones(len(bins), np.float32)
    reach = max(2, round(BAND * across.rows))
    for first in range(0, across.height, reach):
        here = (across.row >= first) & (across.row < first + reach)
        height = max(first + reach / 2, across.shoulders + reach)
        near = cloth & (np.abs(across.row - height) <= reach)
        if near.any():
            share[here] = _share(bins[near])[tuple(bins[here].T)]
    return share


def _bins(rgb: NDArray[np.uint8]) -> NDArray[np.intp]:
    """The bins (P, 3) of colours (P, 3), of lightness and both hues of CIE Lab."""
    if not len(rgb):
        return np.zeros((0, 3), np.intp)
    lab = cv2.cvtColor(rgb.astype(np.float32)[None] / 255, cv2.COLOR_RGB2LAB)[0]
    return np.clip(
        np.rint(lab / BIN).astype(np.intp) + np.array([0, HUES // 2, HUES // 2]),
        0,
        [LIGHTNESSES - 1, HUES - 1, HUES - 1],
    )


def _share(bins: NDArray[np.intp]) -> NDArray[np.float32]:
    """Which share of some colours (P, 3) is alike to those of each bin, (LIGHTNESSES, HUES, HUES)."""
    count = np.zeros((LIGHTNESSES, HUES, HUES), np.float32)
    np.add.at(count, tuple(bins.T), 1 / max(len(bins), 1))
    return np.asarray(27 * uniform_filter(count, 3, mode="constant"), np.float32)


@dataclass(frozen=True)
class _Across:
    """Of the P pixels of a trunk with the legs beside it, `mask` (h, w), in its order: `row` (P,) how far from the head's end they are along it,
    whole pixels, and `place` (P,) how far from its middle across it, -1 at one outline and 1 at the other. `height`: rows in all; `shoulders`: the
    row at which it is as wide as usual; `rows`: the person's height, pixels."""

    mask: NDArray[np.bool_]
    row: NDArray[np.intp]
    place: NDArray[np.float64]
    height: int
    shoulders: int
    rows: int

    def drawn(self, which: NDArray[np.bool_]) -> NDArray[np.bool_]:
        """Some of its pixels (P,) as a mask (h, w)."""
        out = np.zeros_like(self.mask)
        out[self.mask] = which
        return out


def _across(trunk: NDArray[np.bool_], legs: NDArray[np.bool_], head: NDArray[np.bool_]) -> _Across:
    """Along the trunk's own axis: from the head's middle to its own, or downwards where there is no head."""
    centre = np.array([axis.mean() for axis in np.nonzero(trunk)[::-1]])
    down = np.array([0.0, 1.0])
    if head.any():
        above = np.array([axis.mean() for axis in np.nonzero(head)[::-1]])
        if (length := float(np.linalg.norm(centre - above))) > 1:
            down = (centre - above) / length
    y, x = np.indices(trunk.shape)
    along = (x - centre[0]) * down[0] + (y - centre[1]) * down[1]
    aside = (x - centre[0]) * -down[1] + (y - centre[1]) * down[0]
    mask = (trunk | legs) & (along <= along[trunk].max())
    row = np.floor(along[mask] - along[mask].min()).astype(np.intp)
    height = int(row.max()) + 1
    left, right = np.full(height, np.inf), np.full(height, -np.inf)
    np.minimum.at(left, row, aside[mask])
    np.maximum.at(right, row, aside[mask])
    left, right = minimum_filter1d(left, 3), maximum_filter1d(right, 3)
    width = np.maximum(right - left, 1)
    place = 2 * (aside[mask] - left[row]) / width[row] - 1
    wide = width > SHOULDERS * np.median(width)
    rows = (trunk | legs | head).any(1)
    return _Across(mask, row, place, height, int(np.argmax(wide)), int(rows.sum()))
