"""A frame that was chosen from a film, with the person in it and the camera that took it."""

from __future__ import annotations

from dataclasses import dataclass, replace

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.geometry.camera import Camera


@dataclass(frozen=True)
class CapturedView:
    """`image` (H, W, 3) uint8 sRGB, `figure` (H, W) bool where the person is seen, and the `camera`, of this size."""

    image: NDArray[np.uint8]
    figure: NDArray[np.bool_]
    camera: Camera

    @property
    def grey(self) -> NDArray[np.float32]:
        """(H, W) its grey levels, 0 to 255, not rounded: in dark cloth all texture is between one level and the next."""
        return np.asarray(cv2.cvtColor(self.image.astype(np.float32), cv2.COLOR_RGB2GRAY), np.float32)

    def undistorted(self) -> CapturedView:
        """The view as a lens without distortion would show it; what its picture lacks at the borders is black and no figure."""
        if not self.camera.distortion:
            return self
        straight = replace(self.camera, distortion=())
        height, width = self.camera.size
        y, x = np.indices((height, width), np.float64)
        lies = self.camera.project(straight.unproject(np.stack([x, y], axis=-1), 1.0))
        image = cv2.remap(self.image, lies[..., 0], lies[..., 1], cv2.INTER_LINEAR)
        figure = cv2.remap(self.figure.astype(np.uint8), lies[..., 0], lies[..., 1], cv2.INTER_NEAREST)
        return CapturedView(np.asarray(image, np.uint8), np.asarray(figure > 0), straight)

    def cropped(self, left: int, top: int, size: tuple[int, int]) -> CapturedView:
        """The part of `size` (height, width) that begins at pixel (left, top)."""
        part = slice(top, top + size[0]), slice(left, left + size[1])
        return CapturedView(self.image[part], self.figure[part], self.camera.cropped(left, top, size))
