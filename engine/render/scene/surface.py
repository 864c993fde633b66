"""Draws a textured surface: what covers each pixel, its colours, and smooth edges where its outline runs.

Nothing here starts threads of its own, and all inner loops let others run: frames are drawn side by side, one thread each.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from engine.compiled import njit
from engine.render.rasterisation.multisampling import draw_samples, sample_offsets, select_pixels
from engine.render.rasterisation.outline import facings, mark_outline
from engine.render.rasterisation.rasteriser import SUBPIXEL_STEPS, draw_into
from engine.render.scene.scratch import Scratch
from engine.render.textures.mipmap import Mipmap
from engine.render.textures.texturing import PictureWindow, TexturedSurface, colour_inside, colour_samples, corner_table

SAMPLES_PER_AXIS = 3
"""Samples to a pixel, along each axis: ten steps from outside to inside along an edge."""


class Surface(NamedTuple):
    """What of a surface is the same wherever its vertices are.

    triangles : (T, 3) int32, counter-clockwise from outside.
    uv : (V, 2) float32, as in glTF.
    spread : (T,) float32, of `triangle_spread`.
    edges : (E, 4) int32, of `engine.geometry.mesh.adjacency.edge_table`.
    cull : whether backs are left out.
    mipmap : the texture.
    """

    triangles: NDArray[np.int32]
    uv: NDArray[np.float32]
    spread: NDArray[np.float32]
    edges: NDArray[np.int32]
    cull: bool
    mipmap: Mipmap


def triangle_spread(
    triangles: NDArray[np.integer], uv: NDArray[np.floating], shape: tuple[int, ...]
) -> NDArray[np.float32]:
    """(T,) the area of each triangle on a texture of `shape` (H, W, ...), texels."""
    a, b, c = (uv[triangles[:, k]] * np.array(shape[1::-1], np.float32) for k in range(3))
    p, q = b - a, c - a
    return np.asarray(np.abs(p[:, 0] * q[:, 1] - p[:, 1] * q[:, 0]) / 2, np.float32)


def draw_surface(
    rgb: NDArray[np.uint8],
    alone: bool,
    surface: Surface,
    points: NDArray[np.float32],
    scratch: Scratch,
    samples: int = SAMPLES_PER_AXIS,
    shade: NDArray[np.float32] | None = None,
) -> NDArray[np.float32]:
    """Draw into `rgb` (H, W, 3), which holds the background or, where the surface is drawn `alone`, nothing.

    `points` (V, 3): x and y in pixels, and the distance, as `Camera.project` gives them; they are moved. `shade` (V,): by what the
    texture is multiplied. Returns the alpha (H, W), which is part of `scratch`.
    """
    faces, size = surface.triangles, (rgb.shape[0], rgb.shape[1])
    alpha = scratch.filled("alpha", size, 0, np.float32)
    left, top, right, bottom = _box(points, *size)
    if right <= left or bottom <= top:
        return alpha
    points -= np.array([left, top, 0], np.float32)
    inner = bottom - top, right - left
    ids, depths = scratch.filled("ids", inner, -1, np.int32), scratch.filled("depths", inner, np.inf, np.float32)
    draw_into(points, faces, True, surface.cull, ids, depths)
    marks, facing = scratch.filled("marks", inner, False, np.bool_), facings(points, faces)
    mark_outline(points, surface.edges, facing, depths, marks)
    textured = TexturedSurface(corner_table(points, surface.uv, shade), faces, surface.spread, *surface.mipmap)
    window = PictureWindow(rgb, alpha, left, top)
    colour_inside(textured, ids, marks, window)
    chosen, offsets = select_pixels(marks), sample_offsets(samples)
    seen = draw_samples(points, faces, facing, surface.cull, *chosen, offsets)
    share = (offsets / SUBPIXEL_STEPS).astype(np.float32)
    colour_samples(textured, seen, chosen.places, share, alone, window)
    return alpha


@njit(nogil=True, boundscheck=False)
def _box(points: np.ndarray, height: int, width: int) -> tuple[int, int, int, int]:
    """The pixels that points before the camera, (V, 3) float32, can touch: left, top, right, bottom (exclusive)."""
    left, top, right, bottom = np.float32(width), np.float32(height), np.float32(-1), np.float32(-1)
    for v in range(len(points)):
        if points[v, 2] > 0:
            left, right = min(left, points[v, 0]), max(right, points[v, 0])
            top, bottom = min(top, points[v, 1]), max(bottom, points[v, 1])
    return (
        int(max(np.floor(left) - 1, 0)),
        int(max(np.floor(top) - 1, 0)),
        int(min(np.ceil(right) + 2, width)),
        int(min(np.ceil(bottom) + 2, height)),
    )
