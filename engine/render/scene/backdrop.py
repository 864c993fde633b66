"""A picture as a stage: its lower part lies on the ground, the rest stands upright behind the character, so that a
moving camera sees it shift as a room would.

Source of the idea: Y. Horry, K. Anjyo, K. Arai, Tour into the picture, SIGGRAPH 1997; here with a floor and one wall.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.geometry.camera import RENDER_TO_VISION_AXES, Camera


@dataclass(frozen=True)
class Backdrop:
    """`plate` (H, W, 3) uint8 sRGB as `camera` took it; `wall`: metres from the camera to the upright plane across its
    view. The ground is the plane y = 0; where the camera sees no ground before the wall, all is wall."""

    plate: NDArray[np.uint8]
    camera: Camera
    wall: float

    def seen_by(self, camera: Camera) -> NDArray[np.uint8]:
        """What another camera sees, (H, W, 3) of its size: the plate itself for the camera that took it. Beyond the
        plate's edges the picture is mirrored."""
        if camera == self.camera:
            return self.plate
        height, width = camera.size
        right, _, back = np.array(self.camera.axes)
        on_wall = np.array(self.camera.eye) - self.wall * back, right, np.cross(back, right)
        on_floor = np.array([self.camera.eye[0], 0.0, self.camera.eye[2]]), np.array([1.0, 0, 0]), np.array([0.0, 0, 1])
        floor = self._floor(camera)
        # the floor begins on a straight line: at a row's ends one sees whether it is crossed
        ends = np.stack([floor(np.array([0.0]), np.arange(height)), floor(np.array([width - 1.0]), np.arange(height))])
        some, all_floor = np.flatnonzero(ends.any(0)), ends.all(0)
        if not len(some):
            return self._warped(camera, on_wall, 0, height)
        first, last = int(some[0]), int(some[-1]) + 1
        other = np.flatnonzero(~all_floor)
        out = np.empty((height, width, 3), np.uint8)
        out[first:last] = self._warped(camera, on_floor, first, last)
        if len(other):
            top, bottom = int(other[0]), int(other[-1]) + 1
            seen = self._warped(camera, on_wall, top, bottom)
            rows = np.arange(top, bottom)[:, None]
            mask = ~floor(np.arange(width), rows) if max(top, first) < min(bottom, last) else np.ones((1, 1), np.bool_)
            cv2.copyTo(
                seen, np.ascontiguousarray(np.broadcast_to(mask, seen.shape[:2])).view(np.uint8), out[top:bottom]
            )
        return out

    def _floor(self, camera: Camera) -> Callable[[NDArray, NDArray], NDArray[np.bool_]]:
        """A function of x and y in pixels: whether a camera's ray meets the ground before the wall."""
        back = np.array(self.camera.axes[2])
        # a ray is linear in its pixel, and so are one over the distances to ground and wall
        rays = camera.rays(np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]]))
        far = self.wall + float((np.array(camera.eye) - self.camera.eye) @ back)
        nearer = -rays[:, 1] / max(camera.eye[1], 1e-6) - (rays @ -back) / max(far, 1e-6)
        start, across, down = nearer[0], nearer[1] - nearer[0], nearer[2] - nearer[0]
        above = camera.eye[1] > 0
        return lambda x, y: (start + x * across + y * down > 0) & above

    def _warped(
        self, camera: Camera, plane: tuple[NDArray, NDArray, NDArray], first: int, last: int
    ) -> NDArray[np.uint8]:
        """The plate painted on a plane (a point of it, two directions), as `camera` sees it in the rows from `first`
        to before `last`."""
        matrix = _homography(self.camera, *plane) @ np.linalg.inv(_homography(camera, *plane))
        matrix = matrix @ np.array([[1.0, 0, 0], [0, 1, first], [0, 0, 1]])
        return np.asarray(
            cv2.warpPerspective(
                self.plate,
                matrix,
                (camera.size[1], last - first),
                flags=cv2.INTER_LINEAR | cv2.WARP_INVERSE_MAP,
                borderMode=cv2.BORDER_REFLECT_101,
            )
        )


def _homography(
    camera: Camera, origin: NDArray[np.float64], along: NDArray[np.float64], across: NDArray[np.float64]
) -> NDArray[np.float64]:
    """(3, 3): from coordinates on a plane to homogeneous pixels."""
    seen = np.array(camera.axes) @ np.stack([along, across, origin - camera.eye], 1)
    return np.asarray(camera.intrinsics @ RENDER_TO_VISION_AXES @ seen)
