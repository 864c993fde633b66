"""A pinhole camera: by itself it looks along -z, as a photographer stands before a sitter who faces +z."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike, NDArray

from engine.compiled import njit

Axes = tuple[tuple[float, ...], ...]

UPRIGHT: Axes = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))


@dataclass(frozen=True)
class Camera:
    """`eye` (3,) metres; `focal` pixels; `centre` (x, y) the principal point in pixels; `size` (height, width) of the
    picture. `axes` are three unit vectors of the world: the camera's right, its up, and backwards, away from what it
    looks at."""

    eye: tuple[float, float, float]
    focal: float
    centre: tuple[float, float]
    size: tuple[int, int]
    axes: Axes = UPRIGHT

    def project(self, points: NDArray[np.floating]) -> NDArray[np.float32]:
        """(V, 3) points in metres to (V, 3) float32: x and y in pixels and the distance along the view axis.

        Points behind the eye have a distance <= 0 and no meaningful pixel; the rasteriser leaves them out.
        """
        found = np.empty((len(points), 3), np.float32)
        _project(np.asarray(points), np.array(self.eye), np.array(self.axes), self.focal, *self.centre, found)
        return found

    def rays(self, pixels: NDArray[np.floating]) -> NDArray[np.float64]:
        """(N, 2) pixels to (N, 3) the directions in which they look, in the world, one metre along the view axis."""
        x, y = (np.asarray(pixels, np.float64) - self.centre).T / self.focal
        return np.stack([x, -y, -np.ones_like(x)], 1) @ np.array(self.axes)

    def enlarged(self, factor: int) -> Camera:
        """The same view with `factor` by `factor` pixels in the place of each: for supersampling."""
        shift = (factor - 1) / 2
        centre = (self.centre[0] * factor + shift, self.centre[1] * factor + shift)
        size = (self.size[0] * factor, self.size[1] * factor)
        return replace(self, focal=self.focal * factor, centre=centre, size=size)

    def aimed(self, eye: ArrayLike, target: ArrayLike) -> Camera:
        """The same lens, level, at `eye` and looking at `target` (3,). The target may not be right above the eye."""
        back = np.asarray(eye, np.float64) - np.asarray(target, np.float64)
        back = back / np.linalg.norm(back)
        right = np.cross([0.0, 1.0, 0.0], back)
        right = right / np.linalg.norm(right)
        axes = np.stack([right, np.cross(back, right), back]).tolist()
        x, y, z = np.asarray(eye, np.float64).tolist()
        return replace(self, eye=(x, y, z), axes=tuple(map(tuple, axes)))


@njit(nogil=True, boundscheck=False, error_model="numpy")
def _project(
    points: np.ndarray, eye: np.ndarray, axes: np.ndarray, focal: float, x: float, y: float, found: np.ndarray
) -> None:
    for v in range(len(points)):
        a, b, c = points[v, 0] - eye[0], points[v, 1] - eye[1], points[v, 2] - eye[2]
        distance = -(a * axes[2, 0] + b * axes[2, 1] + c * axes[2, 2])
        found[v, 0] = focal * (a * axes[0, 0] + b * axes[0, 1] + c * axes[0, 2]) / distance + x
        found[v, 1] = -focal * (a * axes[1, 0] + b * axes[1, 1] + c * axes[1, 2]) / distance + y
        found[v, 2] = distance
