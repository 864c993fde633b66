"""A ball of known colours, filmed from around, under an exposure that drifts."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import pytest
import trimesh
from numpy.typing import NDArray

from engine.avatar.texture.views import ChartedSurface, FrameView
from engine.geometry.camera import Camera
from engine.geometry.texture_charts.texture_atlas import unwrap
from engine.render.rasterisation.attributes import interpolate
from engine.render.rasterisation.rasteriser import rasterise
from engine.render.textures.texture_bake import texel_raster

Colours = Callable[[NDArray], NDArray]


def waves(points: NDArray) -> NDArray:
    """A colour for each place in space."""
    return np.asarray(128 + 60 * np.sin(np.asarray(points) * [9.0, 11.0, 13.0] + [0, 1, 2]))


@dataclass(frozen=True)
class Ball:
    """A ball of radius 1 m about the origin, and films of it."""

    surface: ChartedSurface

    def picture(self, camera: Camera, colours: Colours = waves, gain: float = 1.0) -> NDArray[np.uint8]:
        raster = rasterise(camera.project(self.surface.vertices), self.surface.triangles, camera.size, perspective=True)
        places = interpolate(self.surface.vertices, self.surface.triangles, raster)
        shown = np.where((raster.triangle >= 0)[..., None], colours(places) * gain, 250)
        return np.clip(np.rint(shown), 0, 255).astype(np.uint8)

    def view(self, camera: Camera, colours: Colours = waves, gain: float = 1.0) -> FrameView:
        picture = self.picture(camera, colours, gain)
        return FrameView(camera, lambda: picture)


def ring(count: int, distance: float = 4.0, height: float = 0.0, size: int = 200) -> list[Camera]:
    """Cameras around the ball, the first in front of it."""
    lens = Camera((0, 0, 1), 1.6 * size, ((size - 1) / 2, (size - 1) / 2), (size, size))
    angles = 2 * np.pi * np.arange(count) / count
    return [lens.aimed([distance * np.sin(a), height, distance * np.cos(a)], [0, 0, 0]) for a in angles]


def known_colours(ball: Ball, size: int) -> NDArray:
    """The texture (S, S, 3) of a ball of `waves`."""
    raster = texel_raster(ball.surface.atlas, size)
    return waves(interpolate(ball.surface.vertices, ball.surface.triangles, raster))


@pytest.fixture(scope="session")
def ball() -> Ball:
    mesh = trimesh.creation.icosphere(4)
    vertices, faces = np.asarray(mesh.vertices, np.float64), np.asarray(mesh.faces, np.int32)
    atlas, _ = unwrap(vertices, faces, 256)
    return Ball(ChartedSurface(vertices, faces, atlas, np.ones(len(faces), np.bool_)))


@pytest.fixture(scope="session")
def ball_cameras() -> list[Camera]:
    """From all around, above and below."""
    return [*ring(8), *ring(3, height=4.0), *ring(3, height=-4.0)]
