"""What no view saw of a texture: colours that run smoothly over the surface, across the seams of its charts, from what is
known around."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.sparse.csgraph import connected_components

from engine.geometry.deformation.cotangent_laplacian import cotangent_laplacian
from engine.geometry.deformation.handles import HeldSystem, handles
from engine.geometry.texture_charts.texture_atlas import TextureAtlas
from engine.render.rasterisation.rasteriser import Raster
from engine.render.textures.texture_bake import BakedTexture, texel_raster

FILLED_STRIP_ROWS = 256
"""Rows of a texture that are worked on at once."""


def filled_over_surface(
    baked: BakedTexture, vertices: NDArray[np.floating], triangles: NDArray[np.integer], atlas: TextureAtlas
) -> NDArray[np.float32]:
    """The colours (S, S, 3) float32 of a baked texture, whose texels on charts that no view saw are harmonic on the surface:
    each point has the mean of what surrounds it, and all lie between the known ones.

    `vertices` (V, 3), `triangles` (T, 3) and `atlas`: those with which it was baked. Known texels stay, and those beside the
    charts. A piece of which nothing is known has the mean of all that is known; where nothing is, nothing changes.
    """
    raster = texel_raster(atlas, len(baked.colours))
    filled = baked.colours.copy()
    fill_over_surface(filled, baked.weights > 0, raster, vertices, triangles)
    return filled


def fill_over_surface(
    texture: NDArray, known: NDArray[np.bool_], raster: Raster, vertices: NDArray[np.floating], triangles: NDArray
) -> None:
    """As `filled_over_surface`, in place: `texture` (S, S, 3) uint8 or float32 is filled where the raster of its texels has a
    triangle and it is not `known` (S, S)."""
    on = raster.triangle >= 0
    if not (on & known).any() or not (on & ~known).any():
        return
    faces = np.asarray(triangles, np.intp)
    smooth = _harmonic(*_vertex_means(texture, known & on, raster, faces, len(vertices)), vertices, faces)
    for first in range(0, len(texture), FILLED_STRIP_ROWS):
        rows = slice(first, first + FILLED_STRIP_ROWS)
        hole = np.nonzero((on & ~known)[rows])
        corners, shares = faces[raster.triangle[rows][hole]], raster.barycentrics[rows][hole]
        colours = np.einsum("nk,nkc->nc", shares, smooth[corners])
        texture[rows][hole] = np.rint(colours) if texture.dtype == np.uint8 else colours


def _vertex_means(
    texture: NDArray, told: NDArray[np.bool_], raster: Raster, faces: NDArray[np.intp], count: int
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Sums (V, 3) of the told texels that are nearest to each vertex, and how many these are (V,)."""
    sums, number = np.zeros((count, 3)), np.zeros(count)
    for first in range(0, len(texture), FILLED_STRIP_ROWS):
        rows = slice(first, first + FILLED_STRIP_ROWS)
        here = np.nonzero(told[rows])
        owner = faces[raster.triangle[rows][here], raster.barycentrics[rows][here].argmax(1)]
        colours = texture[rows][here].astype(np.float64)
        number += np.bincount(owner, minlength=count)
        sums += np.stack([np.bincount(owner, colours[:, k], count) for k in range(3)], 1)
    return sums, number


def _harmonic(
    sums: NDArray[np.float64], number: NDArray[np.float64], vertices: NDArray[np.floating], faces: NDArray[np.intp]
) -> NDArray[np.float64]:
    """(V, 3) colours: means where a vertex has any, harmonic elsewhere."""
    held = np.flatnonzero(number)
    colours = np.tile(sums.sum(0) / number.sum(), (len(vertices), 1))
    colours[held] = sums[held] / number[held, None]
    laplacian = cotangent_laplacian(vertices, faces)
    _, piece = connected_components(laplacian, directed=False)
    first = np.unique(piece, return_index=True)[1]
    held = np.union1d(held, first[~np.isin(piece[first], piece[held])])
    system = HeldSystem(colours, laplacian, handles(len(vertices), held))
    nothing = np.zeros((len(vertices), 3))
    return np.asarray(system.solve(nothing, colours[held], nothing[:0], idle=colours))
