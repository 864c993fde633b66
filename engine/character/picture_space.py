"""The space in which characters are made: the picture's own, with depth in the same unit.

x and y are pixels (y down), z is towards the viewer, in pixels as they are at the person's distance. A camera's rays run
along z here, so that a depth map is a surface, front and back have one outline, and whatever is made comes to lie
exactly under its pixels again when it is seen by the picture's camera.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True)
class PictureCamera:
    """A pinhole camera at the origin, looking along -z, y up. `focal` pixels, `centre` (x, y) pixels, `distance` metres
    to the person."""

    focal: float
    centre: tuple[float, float]
    distance: float

    @property
    def pixels_per_metre(self) -> float:
        """At the person's distance."""
        return self.focal / self.distance

    def scaled(self, factor: float) -> PictureCamera:
        """The camera of the same picture, resized by `factor` (pixel centres at whole numbers)."""
        x, y = ((c + 0.5) * factor - 0.5 for c in self.centre)
        return PictureCamera(self.focal * factor, (x, y), self.distance)

    def moved(self, left: float, top: float) -> PictureCamera:
        """The camera of a part of the picture that begins at pixel (left, top)."""
        return PictureCamera(self.focal, (self.centre[0] - left, self.centre[1] - top), self.distance)

    def to_picture(self, points: NDArray[np.floating]) -> NDArray[np.float64]:
        """(..., 3) metres as the camera sees them to picture space."""
        away = -np.asarray(points, np.float64)[..., 2]
        x = points[..., 0] * self.focal / away + self.centre[0]
        y = -points[..., 1] * self.focal / away + self.centre[1]
        return np.stack([x, y, (self.distance - away) * self.pixels_per_metre], -1)

    def to_metres(self, points: NDArray[np.floating]) -> NDArray[np.float64]:
        """The inverse of `to_picture`."""
        away = self.distance - np.asarray(points, np.float64)[..., 2] / self.pixels_per_metre
        x = (points[..., 0] - self.centre[0]) * away / self.focal
        y = -(points[..., 1] - self.centre[1]) * away / self.focal
        return np.stack([x, y, -away], -1)
