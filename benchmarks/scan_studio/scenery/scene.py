"""The room and the subject in it as a camera sees them.

Edges are smoothed and motion is blurred by the mean of several pictures, each of another part of the pixel and of another
moment of the exposure (P. Haeberli, K. Akeley, The accumulation buffer, SIGGRAPH 1990), in linear light.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from benchmarks.scan_studio.people.subject import Subject
from benchmarks.scan_studio.scenery.drawing import draw_over, empty_depths, textured_mesh
from benchmarks.scan_studio.scenery.room import Room
from engine.compiled import njit
from engine.geometry.camera import Camera
from engine.media.colour_conversion.tone_mapping import srgb_light

SAMPLE_OFFSETS_PIXELS = ((-0.375, 0.125), (0.125, 0.375), (-0.125, -0.375), (0.375, -0.125))
"""Pixels from a pixel's centre at which it is looked at, one moment of the exposure each: a turned grid."""


class Scene:
    """A room, and in it, if anybody, a subject; and in its `company` somebody at rest, so far from the origin, who looks the
    same."""

    def __init__(self, room: Room, subject: Subject | None, company: tuple[float, float, float] | None = None):
        self._room = textured_mesh(room.triangles, room.uv, room.triangles, room.shade, room.texture)
        self._walls = room.vertices
        self._company = None if subject is None or company is None else subject.vertices + np.array(company)
        self._person = (
            None
            if subject is None
            else textured_mesh(subject.triangles, subject.uv, subject.uv_triangles, subject.shade, subject.texture)
        )

    def draw(self, camera: Camera, vertices: NDArray[np.float64] | None) -> NDArray[np.uint8]:
        """(H, W, 3) sRGB by one look-up to a pixel; the subject, if there is one, stands with its `vertices` (V, 3)."""
        rgb = np.zeros((*camera.size, 3), np.uint8)
        depths = empty_depths(camera)
        draw_over(rgb, depths, self._room, self._walls, camera)
        if self._person is not None and vertices is not None:
            draw_over(rgb, depths, self._person, vertices, camera)
        if self._person is not None and self._company is not None:
            draw_over(rgb, depths, self._person, self._company, camera)
        return rgb

    def expose(self, cameras: list[Camera], stands: list[NDArray[np.float64] | None]) -> NDArray[np.float32]:
        """(H, W, 3) linear light from 0 to 1, the mean over moments of an exposure; `SAMPLE_OFFSETS_PIXELS` are gone through."""
        total = np.zeros((*cameras[0].size, 3), np.float32)
        light = srgb_light(np.arange(256) / 255).astype(np.float32)
        for k, (camera, vertices) in enumerate(zip(cameras, stands, strict=True)):
            x, y = SAMPLE_OFFSETS_PIXELS[k % len(SAMPLE_OFFSETS_PIXELS)]
            moved = replace(camera, centre=(camera.centre[0] - x, camera.centre[1] - y))
            _add_light(self.draw(moved, vertices), light, total)
        return total / np.float32(len(cameras))


@njit(nogil=True, boundscheck=False)
def _add_light(rgb: np.ndarray, light: np.ndarray, total: np.ndarray) -> None:
    for y in range(rgb.shape[0]):
        for x in range(rgb.shape[1]):
            for k in range(3):
                total[y, x, k] += light[rgb[y, x, k]]
