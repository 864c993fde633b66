"""Which texels show a part of the surface, and what they show of it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from engine.geometry.texture_charts.texture_atlas import TextureAtlas
from engine.render.rasterisation.rasteriser import Raster, rasterise

TEXEL_SUPERSAMPLING = 4
"""Places along a side of a texel of which a fine part's colour is the mean."""


@dataclass(frozen=True)
class PartTexels:
    """N texels of a part: their numbers in reading order, the triangles that they show and where in them, (N, 3)."""

    texels: NDArray[np.int64]
    triangles: NDArray[np.intp]
    shares: NDArray[np.float32]

    @staticmethod
    def fine(atlas: TextureAtlas, part: NDArray[np.bool_], size: int) -> PartTexels:
        """As `of`, for a texture of `size` texels a side, each there up to `TEXEL_SUPERSAMPLING` x `TEXEL_SUPERSAMPLING` times, evenly spread over it: for
        parts whose pattern is finer than the texels."""
        corners = atlas.corners[part]
        flat = np.zeros((len(atlas.uv), 3), np.float32)
        low = np.floor(atlas.uv[corners.ravel()].min(0) * size).astype(int)
        high = np.ceil(atlas.uv[corners.ravel()].max(0) * size).astype(int)
        flat[:, :2] = (atlas.uv * size - low) * TEXEL_SUPERSAMPLING - 0.5
        columns, rows = (high - low) * TEXEL_SUPERSAMPLING
        raster = rasterise(flat, corners, (int(rows), int(columns)))
        at = np.nonzero(raster.triangle >= 0)
        texels = (at[0] // TEXEL_SUPERSAMPLING + low[1]) * size + at[1] // TEXEL_SUPERSAMPLING + low[0]
        triangles = np.flatnonzero(part)[raster.triangle[at]]
        return PartTexels(texels.astype(np.int64), triangles.astype(np.intp), raster.barycentrics[at])

    @staticmethod
    def of(raster: Raster, part: NDArray[np.bool_]) -> PartTexels:
        """Those of the triangles `part` (T,)."""
        flat = raster.triangle.ravel()
        texels = np.flatnonzero((flat >= 0) & part[flat])
        return PartTexels(texels, flat[texels].astype(np.intp), raster.barycentrics.reshape(-1, 3)[texels])

    def blend(self, values: NDArray[np.floating], triangles: NDArray[np.integer]) -> NDArray[np.float64]:
        """(N, C) attributes of vertices (V, C) at the texels."""
        return np.einsum("nk,nkc->nc", self.shares, np.asarray(values, np.float64)[triangles[self.triangles]])

    def put(self, texture: NDArray[np.uint8], colours: NDArray[np.number]) -> None:
        """Give these texels of a `texture` (S, S, 3) the `colours` (N, 3), 0 to 255, in place; one that is there several times
        their mean."""
        found, index = np.unique(self.texels, return_inverse=True)
        number = np.bincount(index)
        means = np.stack([np.bincount(index, colours[:, k]) / number for k in range(3)], 1)
        texture.reshape(-1, 3)[found] = np.clip(np.rint(means), 0, 255).astype(np.uint8)
