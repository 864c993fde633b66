"""A pinhole camera that looks along -z, as a photographer stands before a sitter who faces +z."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True)
class Camera:
    """`eye` (3,) metres, looking along -z with y up; `focal` pixels; `centre` (x, y) the principal point in
    pixels; `size` (height, width) of the picture."""

    eye: tuple[float, float, float]
    focal: float
    centre: tuple[float, float]
    size: tuple[int, int]

    def project(self, points: NDArray[np.floating]) -> NDArray[np.float32]:
        """(V, 3) points in metres to (V, 3) float32: x and y in pixels and the distance along the view axis.

        Points behind the eye have a distance <= 0 and no meaningful pixel; the rasteriser leaves them out.
        """
        seen = np.asarray(points, np.float64) - self.eye
        distance = -seen[:, 2]
        with np.errstate(divide="ignore", invalid="ignore"):
            x = self.focal * seen[:, 0] / distance + self.centre[0]
            y = -self.focal * seen[:, 1] / distance + self.centre[1]
        return np.stack([x, y, distance], 1).astype(np.float32)

    def enlarged(self, factor: int) -> Camera:
        """The same view with `factor` by `factor` pixels in the place of each: for supersampling."""
        shift = (factor - 1) / 2
        centre = (self.centre[0] * factor + shift, self.centre[1] * factor + shift)
        return Camera(self.eye, self.focal * factor, centre, (self.size[0] * factor, self.size[1] * factor))
