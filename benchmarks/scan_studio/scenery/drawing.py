"""Textured triangles, each with its share of the light, drawn one over the other."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from engine.geometry.camera import Camera
from engine.render.rasterisation.rasteriser import draw_into
from engine.render.textures.mipmap import Mipmap, build_mipmap
from engine.render.textures.texturing import PictureWindow, TexturedSurface, colour_inside, corner_table


@dataclass(frozen=True)
class TexturedMesh:
    """A mesh prepared to be drawn: its S vertices along the texture's seams are there once for each side."""

    source: NDArray[np.int64]
    """(S,) which of the vertices given each one is."""
    uv: NDArray[np.float32]
    """(S, 2)."""
    triangles: NDArray[np.int32]
    """(T, 3)."""
    shade: NDArray[np.float32]
    """(S,) by what the light multiplies the texture."""
    spread: NDArray[np.float32]
    """(T,) the area of each triangle on the texture, texels."""
    mipmap: Mipmap


def textured_mesh(
    triangles: NDArray[np.int32],
    uv: NDArray[np.float32],
    uv_triangles: NDArray[np.int32],
    shade: NDArray[np.float32],
    texture: NDArray[np.uint8],
) -> TexturedMesh:
    """Prepare triangles (T, 3) of vertices, whose corners are `uv_triangles` (T, 3) among the places `uv` (U, 2), with the shade
    (V,) of the vertices and a texture (H, W, 3)."""
    pairs = np.stack([triangles.ravel(), uv_triangles.ravel()], 1).astype(np.int64)
    found, number = np.unique(pairs, axis=0, return_inverse=True)
    source, place = found.T
    faces = number.reshape(-1, 3).astype(np.int32)
    a, b, c = (uv[place][faces[:, k]] * np.array(texture.shape[1::-1], np.float32) for k in range(3))
    p, q = b - a, c - a
    spread = (np.abs(p[:, 0] * q[:, 1] - p[:, 1] * q[:, 0]) / 2).astype(np.float32)
    return TexturedMesh(source, uv[place].astype(np.float32), faces, shade[source], spread, build_mipmap(texture))


def empty_depths(camera: Camera) -> NDArray[np.float32]:
    """(H, W): nothing is drawn yet."""
    return np.full(camera.size, np.inf, np.float32)


def draw_over(
    rgb: NDArray[np.uint8],
    depths: NDArray[np.float32],
    mesh: TexturedMesh,
    vertices: NDArray[np.floating],
    camera: Camera,
) -> NDArray[np.bool_]:
    """Draw a mesh with its vertices (V, 3) into a picture (H, W, 3) and its depths (H, W), by one look-up to a pixel; where it
    is nearer than what was there. Returns where that is, (H, W)."""
    points = camera.project(vertices)[mesh.source]
    ids = np.full(camera.size, -1, np.int32)
    draw_into(points, mesh.triangles, True, False, ids, depths)
    with np.errstate(invalid="ignore", over="ignore"):  # what lies behind the eye has no place, and is not drawn
        corners = corner_table(points, mesh.uv, mesh.shade)
    surface = TexturedSurface(corners, mesh.triangles, mesh.spread, *mesh.mipmap)
    window = PictureWindow(rgb, np.zeros(camera.size, np.float32), 0, 0)
    colour_inside(surface, ids, np.zeros(camera.size, np.bool_), window)
    return ids >= 0
