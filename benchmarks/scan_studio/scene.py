"""The room and the subject in it as a camera sees them: textured triangles, each with its share of the light.

Edges are smoothed and motion is blurred by the mean of several pictures, each of another part of the pixel and of another
moment of the exposure (P. Haeberli, K. Akeley, The accumulation buffer, SIGGRAPH 1990), in linear light.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from benchmarks.scan_studio.room import Room
from benchmarks.scan_studio.subject import Subject
from engine.compiled import njit
from engine.geometry.camera import Camera
from engine.media.tone_mapping import srgb_light
from engine.render.mipmap import Mipmap, build_mipmap
from engine.render.rasteriser import draw_into
from engine.render.texturing import PictureWindow, TexturedSurface, colour_inside, corner_table

SAMPLE_OFFSETS = ((-0.375, 0.125), (0.125, 0.375), (-0.125, -0.375), (0.375, -0.125))
"""Pixels from a pixel's centre at which it is looked at, one moment of the exposure each: a turned grid."""


@dataclass(frozen=True)
class _Mesh:
    """A textured mesh whose vertices along the texture's seams are there once for each side: `source` (S,) which of the
    vertices given each one is."""

    source: NDArray[np.int64]
    uv: NDArray[np.float32]
    triangles: NDArray[np.int32]
    shade: NDArray[np.float32]
    spread: NDArray[np.float32]
    mipmap: Mipmap


class Scene:
    """A room, and in it, if anybody, a subject."""

    def __init__(self, room: Room, subject: Subject | None):
        self._room = _mesh(room.triangles, room.uv, room.triangles, room.shade, room.texture)
        self._walls = room.vertices
        self._person = (
            None
            if subject is None
            else _mesh(subject.triangles, subject.uv, subject.uv_triangles, subject.shade, subject.texture)
        )

    def draw(self, camera: Camera, vertices: NDArray[np.float64] | None) -> NDArray[np.uint8]:
        """(H, W, 3) sRGB by one look-up to a pixel; the subject, if there is one, stands with its `vertices` (V, 3)."""
        rgb = np.zeros((*camera.size, 3), np.uint8)
        depths = np.full(camera.size, np.inf, np.float32)
        _draw_over(rgb, depths, self._room, self._walls, camera)
        if self._person is not None and vertices is not None:
            _draw_over(rgb, depths, self._person, vertices, camera)
        return rgb

    def expose(self, cameras: list[Camera], stands: list[NDArray[np.float64] | None]) -> NDArray[np.float32]:
        """(H, W, 3) linear light from 0 to 1, the mean over moments of an exposure; `SAMPLE_OFFSETS` are gone through."""
        total = np.zeros((*cameras[0].size, 3), np.float32)
        light = srgb_light(np.arange(256) / 255).astype(np.float32)
        for k, (camera, vertices) in enumerate(zip(cameras, stands, strict=True)):
            x, y = SAMPLE_OFFSETS[k % len(SAMPLE_OFFSETS)]
            moved = replace(camera, centre=(camera.centre[0] - x, camera.centre[1] - y))
            _add_light(self.draw(moved, vertices), light, total)
        return total / np.float32(len(cameras))


def _mesh(
    triangles: NDArray[np.int32],
    uv: NDArray[np.float32],
    uv_triangles: NDArray[np.int32],
    shade: NDArray[np.float32],
    texture: NDArray[np.uint8],
) -> _Mesh:
    pairs = np.stack([triangles.ravel(), uv_triangles.ravel()], 1).astype(np.int64)
    found, number = np.unique(pairs, axis=0, return_inverse=True)
    source, place = found.T
    faces = number.reshape(-1, 3).astype(np.int32)
    a, b, c = (uv[place][faces[:, k]] * np.array(texture.shape[1::-1], np.float32) for k in range(3))
    p, q = b - a, c - a
    spread = (np.abs(p[:, 0] * q[:, 1] - p[:, 1] * q[:, 0]) / 2).astype(np.float32)
    return _Mesh(source, uv[place].astype(np.float32), faces, shade[source], spread, build_mipmap(texture))


def _draw_over(
    rgb: NDArray[np.uint8], depths: NDArray[np.float32], mesh: _Mesh, vertices: NDArray[np.float64], camera: Camera
) -> None:
    points = camera.project(vertices)[mesh.source]
    ids = np.full(camera.size, -1, np.int32)
    draw_into(points, mesh.triangles, True, False, ids, depths)
    with np.errstate(invalid="ignore", over="ignore"):  # what lies behind the eye has no place, and is not drawn
        corners = corner_table(points, mesh.uv, mesh.shade)
    surface = TexturedSurface(corners, mesh.triangles, mesh.spread, *mesh.mipmap)
    window = PictureWindow(rgb, np.zeros(camera.size, np.float32), 0, 0)
    colour_inside(surface, ids, np.zeros(camera.size, np.bool_), window)


@njit(nogil=True, boundscheck=False)
def _add_light(rgb: np.ndarray, light: np.ndarray, total: np.ndarray) -> None:
    for y in range(rgb.shape[0]):
        for x in range(rgb.shape[1]):
            for k in range(3):
                total[y, x, k] += light[rgb[y, x, k]]
