"""Rows of an unrolled arm that are bare: all round them, but for what the picture shows, is the skin's own tone.

An arm in the shade and one in the light are of one skin. What is filled by rows in the colours of each would have a border at
the elbow where one is hidden, and a dark side where one is seen from its shade alone.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import median_filter

from engine.character.shell.colours.bare_skin import MIN_BARE_RING_SHARE, shaded_skin
from engine.character.shell.colours.unrolled import ROW_METRES
from engine.imaging.histogram_matching import from_lab, to_lab

HEM_METRES = 0.02
"""Metres along an arm over which rows agree on whether they are bare."""


@dataclass(frozen=True)
class BareRows:
    """Which rows (A,) of an unrolled part are bare, and the `colour` (3,) of their skin, sRGB levels."""

    rows: NDArray[np.bool_]
    colour: NDArray[np.float32]


def bare_rows(
    colours: NDArray[np.floating], source: NDArray[np.bool_], skin: NDArray[np.floating], wrist: int
) -> tuple[NDArray[np.bool_], NDArray[np.float32]]:
    """Which rows (A,) of an unrolled part, of whose `colours` (A, C, 3), sRGB levels, some are a `source` (A, C), are bare; and these cells'
    colours (N, 3) CIELAB. `skin` (3,) is the person's, CIELAB. Rows that show nothing are as the nearest that do, on the same
    side of the `wrist`, a row, if any do there: that is where sleeves end."""
    bare, told = np.zeros(len(colours), np.bool_), source.any(1)
    if not told.any():
        return bare, np.zeros((0, 3), np.float32)
    lab = to_lab(colours[source])
    like = shaded_skin(lab, skin)
    row = np.nonzero(source)[0]
    share = np.bincount(row, like, len(colours)) / np.maximum(source.sum(1), 1)
    rows, seen = np.arange(len(colours)), np.flatnonzero(told)
    far = np.abs(seen[:, None] - rows) + len(rows) * ((seen >= wrist)[:, None] != (rows >= wrist))
    nearest = seen[far.argmin(0)]
    size = 2 * round(HEM_METRES / ROW_METRES / 2) + 1
    bare = np.asarray(median_filter(share[nearest] > MIN_BARE_RING_SHARE, size, mode="nearest"), np.bool_)
    return bare, lab[like & bare[row]]


def skin_colour(cells: NDArray[np.floating], skin: NDArray[np.floating]) -> NDArray[np.float32]:
    """The colour (3,), sRGB levels, of the skin that `cells` (N, 3) CIELAB show; `skin` (3,) where there are none."""
    return np.asarray(from_lab(np.median(cells, 0) if len(cells) else skin)[0], np.float32)
