"""What the camera sees of a scene: the visible points, before anything is known of light or matter."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from engine.geometry.camera import Camera
from engine.performances.modelling.actor import Scene
from engine.render.rasterisation.attributes import interpolate
from engine.render.rasterisation.rasteriser import Raster, rasterise


@dataclass(frozen=True)
class VisiblePoints:
    """The P visible points of a picture, row by row.

    covered : (H, W) the pixels where they are.
    raster : which triangle covers each pixel.
    part : (P,) of the scene.
    position : (P, 3) metres.
    normal : (P, 3) of unit length.
    view : (P, 3) the way to the camera, of unit length.
    """

    covered: NDArray[np.bool_]
    raster: Raster
    part: NDArray[np.uint8]
    position: NDArray[np.float32]
    normal: NDArray[np.float32]
    view: NDArray[np.float32]


def visible_points(scene: Scene, camera: Camera) -> VisiblePoints:
    """Which points of the scene the camera sees."""
    raster = rasterise(camera.project(scene.vertices), scene.triangles, camera.size, perspective=True)
    covered = raster.triangle >= 0
    position = interpolate(scene.vertices, scene.triangles, raster)[covered]
    normal = unit(interpolate(scene.normals, scene.triangles, raster)[covered])
    view = unit(np.asarray(camera.eye, np.float32) - position)
    return VisiblePoints(covered, raster, scene.part[raster.triangle[covered]], position, normal, view)


def unit(vectors: NDArray[np.floating]) -> NDArray[np.float32]:
    """Vectors (N, 3) scaled to length one."""
    return (vectors / np.maximum(np.linalg.norm(vectors, axis=1, keepdims=True), 1e-9)).astype(np.float32)
