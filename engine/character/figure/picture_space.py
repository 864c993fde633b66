"""The space in which characters are made: the picture's own, with depth in the same unit.

x and y are pixels (y down), z is towards the viewer, in pixels as they are at the person's distance. A camera's rays
run along z here. So a depth map is a surface, and front and back have one outline. Whatever is made comes to lie
exactly under its pixels again when the picture's camera sees it.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from engine.geometry.camera import Camera


@dataclass(frozen=True)
class PictureCamera:
    """A picture's `camera`, and the `distance` in metres at which its picture space has the person."""

    camera: Camera
    distance: float

    @property
    def pixels_per_metre(self) -> float:
        """At the person's distance."""
        return self.camera.focal / self.distance

    def to_picture(self, points: NDArray[np.floating]) -> NDArray[np.float64]:
        """(..., 3) metres as the camera sees them to picture space."""
        seen = self.camera.project(points, np.float64)
        seen[..., 2] = (self.distance - seen[..., 2]) * self.pixels_per_metre
        return seen

    def to_metres(self, points: NDArray[np.floating]) -> NDArray[np.float64]:
        """The inverse of `to_picture`."""
        away = self.distance - np.asarray(points, np.float64)[..., 2] / self.pixels_per_metre
        return self.camera.unproject(points[..., :2], away)
