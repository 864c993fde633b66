"""Charts of a further surface where a texture has room left between the charts that it has.

Each chart, the largest first and in the better of four turns, goes to the first place at which it covers nothing: all places are
tried at once, as a correlation of what is taken with the chart. Texels of all charts are of one size, and as large as fit.

Source of the search: bottom-left packing of bitmaps as B. Levy, S. Petitjean, N. Ray, J. Maillot, Least squares conformal maps for
automatic texture atlas generation, SIGGRAPH 2002, section 4, have it for horizons.
"""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from engine.geometry.texture_charts.texture_atlas import TextureAtlas

ATLAS_ROOM_CELLS = 512
"""Cells along a side of the texture by which room is looked for."""
GAP_CELLS = 2
"""Cells between charts."""
CHART_SCALE_STEP = 0.85
"""By how much smaller charts are tried until all fit."""
MAX_SCALE_STEPS = 24


@dataclass(frozen=True)
class _Chart:
    """places : (C, 2) of a chart in units of its surface from (0, 0) up.
    triangles : (T, 3) of them.
    which : (C,) of the atlas' places they are.
    """

    places: NDArray[np.float64]
    triangles: NDArray[np.int32]
    which: NDArray[np.intp]


def placed_between(taken: NDArray[np.bool_], atlas: TextureAtlas, scale: float) -> TextureAtlas:
    """`atlas` with its charts where `taken` (`ATLAS_ROOM_CELLS`, `ATLAS_ROOM_CELLS`), a texture's cells with charts in them, leaves room.

    A length of 1 on `atlas` becomes `scale` on the texture, or less where there is too little room.

    Raises ValueError where there is none at any size.
    """
    charts = _charts(atlas)
    for step in range(MAX_SCALE_STEPS):
        placed = _placed(ndimage.binary_dilation(taken, iterations=GAP_CELLS), charts, scale * CHART_SCALE_STEP**step)
        if placed is not None:
            uv = np.zeros((len(atlas.uv), 2), np.float32)
            for chart, places in zip(charts, placed, strict=True):
                uv[chart.which] = places
            return TextureAtlas(uv, atlas.corners, atlas.charts)
    raise ValueError("the texture has no room for further charts")


def cells_of(atlas: TextureAtlas) -> NDArray[np.bool_]:
    """(`ATLAS_ROOM_CELLS`, `ATLAS_ROOM_CELLS`) the cells that an atlas' triangles touch."""
    return _cells(
        np.asarray(atlas.uv, np.float64) * ATLAS_ROOM_CELLS, atlas.corners, (ATLAS_ROOM_CELLS, ATLAS_ROOM_CELLS)
    )


def _charts(atlas: TextureAtlas) -> list[_Chart]:
    """Its charts, the largest first."""
    found = []
    for chart in np.unique(atlas.charts):
        which, corners = np.unique(atlas.corners[atlas.charts == chart], return_inverse=True)
        places = atlas.uv[which].astype(np.float64)
        found.append(_Chart(places - places.min(0), corners.reshape(-1, 3).astype(np.int32), which))
    return sorted(found, key=lambda chart: -float(np.prod(chart.places.max(0))))


def _placed(taken: NDArray[np.bool_], charts: list[_Chart], scale: float) -> list[NDArray[np.float64]] | None:
    """Places of each chart on the texture, or None where one finds no room."""
    full, found = taken.copy(), []
    full[[0, -1]] = full[:, [0, -1]] = True
    for chart in charts:
        best: tuple[int, NDArray[np.float64], NDArray[np.bool_], tuple[int, int]] | None = None
        for turn in range(2):
            places = ATLAS_ROOM_CELLS * scale * (chart.places if turn == 0 else _turned(chart.places))
            size = np.ceil(places.max(0)).astype(int)[::-1] + 1
            if (size >= ATLAS_ROOM_CELLS).any():
                continue
            cells = _cells(places, chart.triangles, (int(size[0]), int(size[1])))
            free = cv2.matchTemplate(full.astype(np.float32), cells.astype(np.float32), cv2.TM_CCORR) < 0.5
            if free.any():
                y, x = np.argwhere(free)[0]
                if best is None or y + size[0] < best[0]:
                    best = int(y + size[0]), places + np.array([x, y]), cells, (int(y), int(x))
        if best is None:
            return None
        _, at, cells, (y, x) = best
        grown = ndimage.binary_dilation(np.pad(cells, GAP_CELLS), iterations=GAP_CELLS)
        top, left = max(y - GAP_CELLS, 0), max(x - GAP_CELLS, 0)
        part = grown[top - y + GAP_CELLS :, left - x + GAP_CELLS :][: ATLAS_ROOM_CELLS - top, : ATLAS_ROOM_CELLS - left]
        full[top : top + part.shape[0], left : left + part.shape[1]] |= part
        found.append(at / ATLAS_ROOM_CELLS)
    return found


def _turned(places: NDArray[np.float64]) -> NDArray[np.float64]:
    """By a right angle, not mirrored."""
    return np.stack([places[:, 1], places[:, 0].max() - places[:, 0]], 1)


def _cells(places: NDArray[np.float64], triangles: NDArray[np.integer], size: tuple[int, int]) -> NDArray[np.bool_]:
    """`size` (rows, columns): which cells triangles cover, those on their edges included."""
    found = np.zeros(size, np.uint8)
    for corners in np.floor(places).astype(np.int32)[triangles]:
        cv2.fillConvexPoly(found, corners, 1)
    return found.astype(np.bool_)
