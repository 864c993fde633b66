"""How a surface lies on its texture: charts, flat pieces of it side by side.

A surface may bring its own, as the human template does (`atlas_from_uv`), or is cut and unfolded (`unwrap`).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp
import xatlas
from numpy.typing import NDArray
from scipy.sparse.csgraph import connected_components

CHART_GAP_TEXELS = 16
"""Texels between charts, and about half as many around them: colours keep apart down to a quarter of the texture's size."""
PACKING_SCALE_STEP = 0.98
"""By how much smaller charts are packed than would seem to fit."""
MAX_PACKINGS = 8
"""Times that charts are packed, smaller each time, until they fit."""


@dataclass(frozen=True)
class TextureAtlas:
    """A surface of T triangles, laid out flat.

    uv : (C, 2) float32, places on the texture as in glTF, (0, 0) the upper left corner of the upper left texel, (1, 1)
        the lower right corner of the last.
    corners : (T, 3) int32, which of them are the corners of each triangle.
    charts : (T,) int32, the chart on which each triangle lies, from 0.
    """

    uv: NDArray[np.float32]
    corners: NDArray[np.int32]
    charts: NDArray[np.int32]


def atlas_from_uv(uv: NDArray[np.floating], corners: NDArray[np.integer]) -> TextureAtlas:
    """The atlas of a surface that brings its own places on a texture, (C, 2), and each triangle's corners among them, (T, 3).

    Raises ValueError where a place is not within [0, 1], or a corner has none.
    """
    places = np.asarray(uv, np.float32)
    ends = np.asarray(corners, np.int32).reshape(-1, 3)
    if not ((places >= 0) & (places <= 1)).all():
        raise ValueError("a place on the texture is not within [0, 1]")
    if len(ends) and not 0 <= ends.min() <= ends.max() < len(places):
        raise ValueError("a corner has no place on the texture")
    triangle = np.arange(len(ends)).repeat(3)
    links = sp.csr_array((np.ones(len(triangle)), (triangle, ends.ravel())), (len(ends), len(places)))
    _, charts = connected_components(links @ links.T, directed=False)
    return TextureAtlas(places, ends, charts.astype(np.int32))


def unwrap(
    vertices: NDArray[np.floating], triangles: NDArray[np.integer], size: int, gap: int = CHART_GAP_TEXELS
) -> tuple[TextureAtlas, NDArray[np.int32]]:
    """Cut a surface into charts that are little distorted, and pack them on a square texture.

    Parameters
    ----------
    vertices, triangles : (V, 3) in any unit and (T, 3).
    size : texels along a side of the texture.
    gap : texels that stay free between two charts, at least.

    Returns
    -------
    The atlas, and (C,) int32: the vertex that each of its places shows. Triangles keep their order; those without area
    lie on single points.

    By xatlas (J. Young; MIT), which flattens as B. Levy, S. Petitjean, N. Ray, J. Maillot have it, Least squares conformal
    maps for automatic texture atlas generation, SIGGRAPH 2002.

    Raises ValueError where there is no triangle, or a place is not finite; or where the charts do not fit the texture.
    """
    points, corners = np.asarray(vertices, np.float32), np.asarray(triangles, np.int64).reshape(-1, 3)
    if not len(corners) or not np.isfinite(points).all():
        raise ValueError("a surface to unfold has triangles, and places that are finite")
    if not 0 <= corners.min() <= corners.max() < len(points):
        raise ValueError("a triangle has a corner that is not there")
    scale = 0.0  # texels to a unit; xatlas makes a first guess, and then as large a texture as that takes
    for _ in range(MAX_PACKINGS):
        packer = _packed(points, corners, scale or None, size, gap)
        longest = max(packer.width, packer.height)
        if longest <= size:
            break
        scale = packer.texels_per_unit * PACKING_SCALE_STEP * size / longest
    else:
        raise ValueError(f"the surface's charts do not fit {size} texels: take a larger texture, or a smaller gap")
    shown, faces, uv = packer[0]
    places = uv * np.array([packer.width, packer.height], np.float32) / np.float32(longest)  # what is free is used
    return atlas_from_uv(np.clip(places, 0, 1), faces), shown.astype(np.int32)


def _packed(
    points: NDArray[np.float32], corners: NDArray[np.int64], scale: float | None, size: int, gap: int
) -> xatlas.Atlas:
    pack = xatlas.PackOptions()
    pack.padding, pack.bilinear = (gap + 1) // 2, True  # around each chart
    if scale is None:
        pack.resolution = size
    else:
        pack.texels_per_unit = scale
    packer = xatlas.Atlas()
    packer.add_mesh(points, corners.astype(np.uint32))
    packer.generate(xatlas.ChartOptions(), pack)
    return packer
