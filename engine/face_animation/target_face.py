"""A picture with the face in it that is to act, at the size of the result."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True)
class TargetFace:
    """A picture of a face, brought to the result's size.

    rgb : (H, W, 3) uint8, the picture at that size.
    alpha : (H, W) float32 in [0, 1], the picture's own; None where it has none.
    mesh : (478, 3) float32 pixels of `rgb`.
    faces : (F, 4) float32: x, y, width and height of all faces found, that of `mesh` among them. They are pixels of the
        original picture, or of a crop of it that numbers give.
    original_size : (width, height) of the original picture, pixels.
    place : (2, 3) float64, carries places in what `faces` refers to into `rgb`, both measured from the upper left corner of
        the first pixel: a scale and a shift.
    people : (h, w) float32 in [0, 1], at whatever size, where people are believed to be in what `rgb` shows; None where
        nobody has looked.
    """

    rgb: NDArray[np.uint8]
    alpha: NDArray[np.float32] | None
    mesh: NDArray[np.float32]
    faces: NDArray[np.float32]
    original_size: tuple[int, int]
    place: NDArray[np.float64]
    people: NDArray[np.float32] | None = None

    @property
    def size(self) -> tuple[int, int]:
        """Width and height of the result, pixels."""
        return self.rgb.shape[1], self.rgb.shape[0]

    def face_boxes(self) -> tuple[NDArray[np.float32], NDArray[np.float32]]:
        """The box (4,) of the face that acts and those of the others (K, 4), in pixels of the result: x, y, width, height."""
        low, high = self.mesh[:, :2].min(axis=0), self.mesh[:, :2].max(axis=0)
        scale = float(self.place[0, 0])
        corners = self.faces[:, :2] * scale + self.place[:, 2]
        boxes = np.hstack([corners, self.faces[:, 2:] * scale]).astype(np.float32)
        middles = boxes[:, :2] + boxes[:, 2:] / 2
        own = np.linalg.norm(middles - (low + high) / 2, axis=1) < np.linalg.norm(high - low) / 2
        seen = ((middles > 0) & (middles < self.size)).all(axis=1)
        return np.concatenate([low, high - low]).astype(np.float32), boxes[seen & ~own]
