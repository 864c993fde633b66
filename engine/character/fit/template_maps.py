"""The fitted template seen from the front and from behind: outline, depth, normals and skinning weights as maps.

The paper's S_SMPL, Z_SMPL, N_SMPL and W_SMPL (section 4.1). The view from behind is what lies furthest along the same
rays, so that both views share one outline and need no mirroring.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from engine.geometry.mesh.surface import vertex_normals
from engine.render.rasterisation.attributes import interpolate
from engine.render.rasterisation.rasteriser import Raster, rasterise

Side = Literal["front", "back"]


@dataclass(frozen=True)
class SideMaps:
    """One side of a part of the template, (H, W) maps.

    depth : z of picture space, NaN outside.
    normals : (H, W, 3) x right, y down, z to the one who looks at this side.
    towards : 1 where that one is on the viewer's side, -1 behind the picture.
    raster : which triangle is seen.
    """

    mask: NDArray[np.bool_]
    depth: NDArray[np.float32]
    normals: NDArray[np.float32]
    raster: Raster
    towards: float


def side_maps(
    vertices: NDArray[np.floating], triangles: NDArray[np.integer], size: tuple[int, int], side: Side
) -> SideMaps:
    """Maps of a mesh in picture space: `vertices` (V, 3); `triangles` (T, 3), counter-clockwise from outside in metres;
    `size` (height, width)."""
    towards = 1.0 if side == "front" else -1.0
    screen = np.stack([vertices[:, 0], vertices[:, 1], -towards * vertices[:, 2]], 1)
    raster = rasterise(screen, triangles, size)
    mask = raster.triangle >= 0
    normals = interpolate(vertex_normals(vertices, triangles), triangles, raster)
    normals = normals * np.array([1, 1, towards], np.float32)
    normals *= -1  # picture space has y down: what is counter-clockwise from outside in metres is clockwise here
    return SideMaps(mask, np.where(mask, -towards * raster.depth, np.nan).astype(np.float32), normals, raster, towards)


def weights_at(
    raster: Raster,
    triangles: NDArray[np.integer],
    bones: NDArray[np.integer],
    weights: NDArray[np.floating],
    count: int,
) -> NDArray[np.float32]:
    """Skinning weights at each pixel, (H, W, count) float32, zero where nothing is seen."""
    dense = np.zeros((len(bones), count), np.float32)
    for k in range(bones.shape[1]):
        dense[np.arange(len(bones)), bones[:, k]] += weights[:, k]  # a bone of no weight may be named twice
    return interpolate(dense, triangles, raster)
