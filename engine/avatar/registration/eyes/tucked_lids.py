"""Skin of the upper lid that lies tucked beside its rim while the eye is open, and comes out as it shuts.

A fitted lid is as smooth as points are there, without the fold into which skin goes. What shows between rim and brow, lashes and a
shade, would be drawn out over the whole eye in a blink. So the surface stays, and vertices slide on it, along columns up from the
rim. Those of the lid go to its rim, where they take less of the frames than lashes do, and those above go after them.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from engine.avatar.registration.template_skin.lid_rims import lid_rim, upper_lid_columns
from engine.avatar.registration.template_skin.skin import EYE_PARTS
from engine.body.template import Template

LID_SKIN_EYE_WIDTHS, SLID_EYE_WIDTHS = 0.2, 0.45
"""Widths of an eye, along the skin from the rim up, that are the lid's, which get tucked, and that slide at all."""
TUCKED_EYE_WIDTHS = 0.035
"""Widths of an eye that a lid's skin takes when it is tucked."""
TUCKED_FROM_CORNER_EYE_WIDTHS = 0.45
"""Widths of an eye from its corners over which tucking sets in."""
CORNER_LID_SHARE = 0.35
"""Of the lid's skin in the middle of the eye, what there is of it at the corners, where the fold ends."""


@dataclass(frozen=True)
class LidColumns:
    """Columns of vertices up from an upper lid's rim (`engine.avatar.registration.template_skin.lid_rims.upper_lid_columns`).

    lengths : (C, K) widths of the eye along each column from the rim to its vertices.
    tucked : (C,) by how much of all that it can be each column is tucked: less at the corners.
    """

    lengths: NDArray[np.float64]
    tucked: NDArray[np.float64]

    @classmethod
    def of(cls, places: NDArray[np.floating], rim: NDArray[np.floating]) -> LidColumns:
        """Those whose vertices have the `places` (C, K, 3), metres, on a lid whose rim is the loop (R, 3)."""
        width = float(np.ptp(rim, axis=0).max())
        steps = np.linalg.norm(np.diff(places, axis=1), axis=2)
        lengths = np.pad(np.cumsum(steps, axis=1), ((0, 0), (1, 0))) / width
        corners = rim[[np.argmin(rim[:, 0]), np.argmax(rim[:, 0])]]
        away = np.linalg.norm(places[:, :1] - corners, axis=2).min(1) / (TUCKED_FROM_CORNER_EYE_WIDTHS * width)
        return cls(lengths, np.clip(away, 0, 1) ** 2 * (3 - 2 * np.clip(away, 0, 1)))

    def in_tuck(self) -> NDArray[np.bool_]:
        """(C, K) which vertices of a lid that is tucked are its skin, or of its rim."""
        return np.asarray(self.lengths < TUCKED_EYE_WIDTHS)

    def when_tucked(self) -> NDArray[np.float64]:
        """(C, K) the lengths with lids tucked that are not."""
        moved = np.interp(self.lengths, *_TUCKING) - np.minimum(self.lengths, SLID_EYE_WIDTHS)
        return np.asarray(self.lengths + self.tucked[:, None] * moved)

    def untucked(self) -> NDArray[np.float64]:
        """(C, K) the lengths with lids not tucked that are."""
        own, short = _TUCKING
        out = self.lengths.copy()
        for length, share in zip(out, self.tucked, strict=True):
            ends = (1 - share) * np.array(own) + share * np.array(short)
            within = length < SLID_EYE_WIDTHS
            length[within] = np.interp(length[within], ends, own)
        return out

    def up(self) -> NDArray[np.float64]:
        """(C, K) how far up the skin of a lid that is tucked each vertex is: 0 at the rim, 1 at the fold, beyond more."""
        folds = LID_SKIN_EYE_WIDTHS * (CORNER_LID_SHARE + (1 - CORNER_LID_SHARE) * self.tucked)
        return np.asarray(self.untucked() / folds[:, None])


_TUCKING = ([0.0, LID_SKIN_EYE_WIDTHS, SLID_EYE_WIDTHS], [0.0, TUCKED_EYE_WIDTHS, SLID_EYE_WIDTHS])


def with_tucked_lids(template: Template, vertices: NDArray[np.float64]) -> NDArray[np.float64]:
    """The template's `vertices` (V, 3), metres, with the upper lids of both eyes tucked; the surface is the same."""
    out = vertices.copy()
    for part in EYE_PARTS:
        columns = upper_lid_columns(template, part)
        out[columns] = tucked_lid(vertices[columns], vertices[lid_rim(template, part)])
    return out


def tucked_lid(places: NDArray[np.floating], rim: NDArray[np.floating]) -> NDArray[np.float64]:
    """(C, K, 3) the places of columns' vertices, (C, K, 3) metres, slid along the columns until the lid with the `rim` (R, 3) is
    tucked."""
    columns = LidColumns.of(places, rim)
    goal = columns.when_tucked()
    out = np.asarray(places, np.float64).copy()
    for number, (length, wanted) in enumerate(zip(columns.lengths, goal, strict=True)):
        for axis in range(3):
            out[number, :, axis] = np.interp(wanted, length, places[number, :, axis])
    return out
