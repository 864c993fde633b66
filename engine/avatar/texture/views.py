"""What the texture is made of: the fitted surface on its charts, and frames with their cameras."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from engine.avatar.texture.image_shift import ImageShift
from engine.geometry.camera import Camera
from engine.geometry.texture_charts.texture_atlas import TextureAtlas


@dataclass(frozen=True)
class ChartedSurface:
    """A surface that is textured, not cut along the seams of the texture.

    vertices : (V, 3) metres.
    triangles : (T, 3) int32, counter-clockwise seen from outside.
    atlas : where they lie on the texture, the triangle `t` as its triangle `t`.
    stitched : (T,) bool, those that take colours from frames; the others only hide what lies behind them.
    doubted : (T,) bool, those of which frames are believed only where they are so many that they contradict one that is
        wrong; None where none is.
    """

    vertices: NDArray[np.float64]
    triangles: NDArray[np.int32]
    atlas: TextureAtlas
    stitched: NDArray[np.bool_]
    doubted: NDArray[np.bool_] | None = None

    def __post_init__(self) -> None:
        count = len(self.triangles)
        if len(self.atlas.corners) != count or self.stitched.shape != (count,):
            raise ValueError("the atlas, or what is stitched, has other triangles than the surface")


@dataclass(frozen=True)
class FrameView:
    """A frame by its camera.

    read : gives the picture (H, W, 3) uint8, of the camera's size, anew each time it is asked: of a film's frames only
        one is held at a time.
    person : gives (H, W) bool, which pixels show the person; None where that is not known.
    farthest : metres; about what is farther away it is not asked.
    shift : by how much it shows places elsewhere than its camera has them, if it does.
    """

    camera: Camera
    read: Callable[[], NDArray[np.uint8]]
    person: Callable[[], NDArray[np.bool_]] | None = None
    farthest: float = np.inf
    shift: ImageShift | None = None

    def places(self, points: NDArray[np.floating]) -> NDArray[np.float32]:
        """(N, 3) where the picture shows points (N, 3) of the surface, x and y in pixels, and how far away they are along the
        view axis."""
        pixels = self.camera.project(points)
        return pixels if self.shift is None else self.shift.shifted(pixels)

    def picture(self) -> NDArray[np.uint8]:
        """The picture. Raises ValueError where it has another size than its camera."""
        found = self.read()
        if found.shape != (*self.camera.size, 3) or found.dtype != np.uint8:
            raise ValueError(f"a frame is (H, W, 3) uint8, of its camera's size {self.camera.size}: {found.shape}")
        return found
