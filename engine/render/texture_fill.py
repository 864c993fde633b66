"""What no view saw of a texture: colours that run smoothly over the surface, across the seams of its charts, from what is
known around."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.sparse.csgraph import connected_components

from engine.geometry.cotangent_laplacian import cotangent_laplacian
from engine.geometry.handles import HeldSystem, handles
from engine.geometry.texture_atlas import TextureAtlas
from engine.render.attributes import interpolate
from engine.render.texture_bake import BakedTexture, texel_raster


def filled_over_surface(
    baked: BakedTexture, vertices: NDArray[np.floating], triangles: NDArray[np.integer], atlas: TextureAtlas
) -> NDArray[np.float32]:
    """The colours (S, S, 3) float32 of a baked texture, whose texels on charts that no view saw are harmonic on the surface:
    each point has the mean of what surrounds it, and all lie between the known ones.

    `vertices` (V, 3), `triangles` (T, 3) and `atlas`: those with which it was baked. Known texels stay, and those beside the
    charts. A piece of which nothing is known has the mean of all that is known; where nothing is, nothing changes.
    """
    faces = np.asarray(triangles, np.intp)
    raster = texel_raster(atlas, len(baked.colours))
    on, known = raster.triangle >= 0, baked.weights > 0
    if not (on & known).any() or not (on & ~known).any():
        return baked.colours
    count = len(vertices)
    told = np.nonzero(on & known)
    nearest = raster.barycentrics[told].argmax(1)
    owner = faces[raster.triangle[told], nearest]
    number = np.bincount(owner, minlength=count)
    sums = np.stack([np.bincount(owner, baked.colours[told][:, k], count) for k in range(3)], 1)
    held = np.flatnonzero(number)
    colours = np.tile(baked.colours[told].mean(0, dtype=np.float64), (count, 1))
    colours[held] = sums[held] / number[held, None]
    laplacian = cotangent_laplacian(vertices, faces)
    _, piece = connected_components(laplacian, directed=False)
    first = np.unique(piece, return_index=True)[1]
    held = np.union1d(held, first[~np.isin(piece[first], piece[held])])
    system = HeldSystem(colours, laplacian, handles(count, held))
    nothing = np.zeros((count, 3))
    smooth = system.solve(nothing, colours[held], nothing[:0], idle=colours)
    painted = interpolate(smooth, faces, raster)
    return np.where((on & ~known)[..., None], painted, baked.colours)
