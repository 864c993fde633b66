"""Lids that meet: how far the template's blink has to go on this face, in this expression, for the eye to shut.

The template's blink is drawn for its average face: on another it stops short or runs past the lower lid, and it
drags the corners of the eyes along. Here each column of the lid is given the share of that motion that brings its
rim onto the lower one, whatever smile or surprise has done to both.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray

from engine.performances.modelling.eyes import Eyeball
from engine.render.rasterisation.rasteriser import rasterise

RIM_OVERLAP_METRES = 0.0003
"""Metres by which the upper rim covers the lower one when shut."""

INNER_FADE_METRES, OUTER_FADE_METRES = 0.009, 0.0055
"""Metres beyond the visible eyeball over which the lid's motion fades: at the nose the lids reach further."""


@dataclass(frozen=True)
class Rim:
    """Points along the visible edge of a lid, right to left: `corners` (C, 3) and `share` (C, 3), the triangle of
    fine skin at each and its barycentrics; `x` (C,) metres in the rest pose."""

    corners: NDArray[np.int32]
    share: NDArray[np.float32]
    x: NDArray[np.float64]


@dataclass(frozen=True)
class Lids:
    """One eye's lids.

    upper, lower : (C, V) sparse give points on the rims from the template's vertices.
    x : (C,) their columns.
    shut : (V, 3) the template's blink.
    columns : (V,) the rest x of its vertices.
    """

    upper: sp.csr_array
    lower: sp.csr_array
    x: NDArray[np.float64]
    shut: NDArray[np.float32]
    columns: NDArray[np.float32]

    def close(self, moved: NDArray[np.floating], share: float) -> NDArray[np.float32]:
        """The displacement (V, 3) that closes the eye by `share` [0, 1] of its opening in the expression `moved`
        (V, 3), the template's vertices with all other face units at work."""
        gap = (self.upper @ moved[:, 1]) - (self.lower @ moved[:, 1])
        reach = -(self.upper @ self.shut[:, 1])
        needed = np.clip((gap + RIM_OVERLAP_METRES) / np.maximum(reach, 1e-4), 0, 1.6)
        needed = np.convolve(np.pad(needed, 2, mode="edge"), np.full(5, 0.2), mode="valid")
        inner_is_first = self.x.mean() > 0
        fades = (INNER_FADE_METRES, OUTER_FADE_METRES) if inner_is_first else (OUTER_FADE_METRES, INNER_FADE_METRES)
        ends = (self.x[0] - fades[0], *self.x, self.x[-1] + fades[1])
        amount = np.interp(self.columns, ends, (0.0, *needed, 0.0))
        return (share * amount[:, None] * self.shut).astype(np.float32)


def build_lids(
    fine: sp.csr_array,
    triangles: NDArray[np.int32],
    rest: NDArray[np.float32],
    eyeball: Eyeball,
    centre: NDArray[np.floating],
    shut: NDArray[np.float32],
) -> Lids:
    """Lids of the eye at `centre`; `shut` (V, 3) is the template's blink of that eye."""
    skin = (fine @ rest).astype(np.float32)
    columns = np.linspace(0, 1, 40)
    rims = [find_rim(skin, triangles, eyeball, centre, upper, columns) for upper in (True, False)]
    points = []
    for rim in rims:
        rows = np.arange(len(rim.x)).repeat(3)
        pick = sp.csr_array((rim.share.ravel(), (rows, rim.corners.ravel())), shape=(len(rim.x), len(skin)))
        points.append(sp.csr_array(pick @ fine))
    return Lids(points[0], points[1], rims[0].x, shut, rest[:, 0])


def find_rim(
    skin: NDArray[np.float32],
    triangles: NDArray[np.int32],
    eyeball: Eyeball,
    centre: NDArray[np.floating],
    upper: bool,
    places: NDArray[np.floating],
) -> Rim:
    """The edge of a lid at `places` [0, 1] from right to left, found by looking at the rest pose from the front:
    in each column, the skin next to the eyeball."""
    ball = eyeball.vertices + centre
    both = np.concatenate([skin, ball])
    faces = np.concatenate([triangles, eyeball.triangles + len(skin)])
    scale, size = 20000.0, (480, 760)
    x = (both[:, 0] - centre[0]) * scale + size[1] / 2
    y = -(both[:, 1] - centre[1]) * scale + size[0] / 2
    raster = rasterise(np.stack([x, y, -both[:, 2]], 1), faces, size)
    on_eye = raster.triangle >= len(triangles)
    seen = np.flatnonzero(on_eye.sum(0) > 20)
    chosen = np.rint(seen[0] + 4 + places * (seen[-1] - seen[0] - 8)).astype(int)
    rows = on_eye[:, chosen].argmax(0) - 1 if upper else size[0] - on_eye[::-1, chosen].argmax(0)
    found = raster.triangle[rows, chosen]
    return Rim(triangles[found], raster.barycentrics[rows, chosen], centre[0] + (chosen - size[1] / 2) / scale)
