"""A driver's face through frames in which it is not seen."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from engine.perception.face_track.face_crop import FaceCrop, interpolate_crops

EASE_BACK_FRAMES = 8
"""Frames over which what had vanished eases from its held place back to where it was found again."""


def return_share(frames: ArrayLike) -> NDArray[np.float64]:
    """How far something is on its way back, in [0, 1], so many frames after it was found again, the first of them 1."""
    t = np.clip(np.asarray(frames) / (EASE_BACK_FRAMES + 1), 0, 1)
    return np.asarray(t * t * (3 - 2 * t), float)


class HeldFace:
    """A face that is not always seen. Where it is lost it stays as it was last seen, and where it comes back it eases
    over from there. Before it is first seen it is as it will be."""

    def __init__(self) -> None:
        self._waiting = 0
        self._last: FaceCrop | None = None
        self._lost: FaceCrop | None = None
        self._since = 0

    def __call__(self, seen: FaceCrop | None) -> list[FaceCrop]:
        """How it looks in this frame, in which it is `seen` so. Nothing comes before the first that is seen, which then
        comes as often as there were frames up to here."""
        if seen is None:
            self._lost = self._last
            self._since = 0
            self._waiting += self._last is None
            return [self._last] if self._last else []
        if self._lost is not None:
            self._since += 1
            seen = interpolate_crops(self._lost, seen, float(return_share(self._since)))
            if self._since == EASE_BACK_FRAMES:
                self._lost = None
        self._last = seen
        looks = [seen] * (self._waiting + 1)
        self._waiting = 0
        return looks
