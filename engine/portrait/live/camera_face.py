"""The face before a camera, frame by frame: found, steadied, held while it is out of sight. No frame waits for a later one."""

from __future__ import annotations

from contextlib import ExitStack
from types import TracebackType

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.perception.face.landmarks import eye_distance
from engine.perception.face.one_face import OneFace
from engine.perception.face_track.covered_face import CoveredFace
from engine.perception.face_track.face_crop import FaceCrop, crop_face
from engine.perception.face_track.held_face import HeldFace
from engine.perception.one_euro import OneEuroFilter

TRACKED_SIDE_PIXELS = 640
"""Pixels: larger frames are looked at in this size. The tracker's network sees the face in 192."""
MIN_CUTOFF_HZ, CUTOFF_PER_SPEED, DERIVATIVE_CUTOFF_HZ = 1.0, 15.0, 8.0
"""Of the one-euro filter, of meshes in eye distances: a lid that shuts goes 1.5 eye distances a second, a head at rest 0.03."""


class CameraFace:
    """Follows the largest face before a camera. Use as a context manager."""

    def __init__(self) -> None:
        self._open = ExitStack()
        self._follow = self._open.enter_context(OneFace())
        self._covered = self._open.enter_context(CoveredFace())
        self._held = HeldFace()
        self._filter = OneEuroFilter(MIN_CUTOFF_HZ, CUTOFF_PER_SPEED, DERIVATIVE_CUTOFF_HZ)
        self._unit = 0.0
        self.visible = False
        """Whether the last frame showed the face."""

    def __enter__(self) -> CameraFace:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._open.close()

    def __call__(self, rgb: NDArray[np.uint8], time: float) -> FaceCrop | None:
        """How the face looks in the frame (H, W, 3) of a `time`, seconds, in pixels of the frame as it was looked at; as it
        looked last where it is not seen, None before it was seen first."""
        small = in_tracked_size(rgb)
        mesh = self._follow(small)
        seen = None if mesh is None else crop_face(small, mesh)
        if seen is not None and self._covered(small, seen):
            seen = None
        self.visible = seen is not None
        held = self._held(seen)
        return self._steadied(held[-1], time) if held else None

    def _steadied(self, look: FaceCrop, time: float) -> FaceCrop:
        if not self._unit:
            self._unit = float(eye_distance(look.mesh[:, :2]))  # a fixed one: the filter's past is in it
        steady = self._filter(look.mesh / self._unit, time) * self._unit
        return FaceCrop(steady.astype(np.float32), look.place, look.crop)


def in_tracked_size(rgb: NDArray[np.uint8]) -> NDArray[np.uint8]:
    """A frame no larger than it is looked at."""
    scale = TRACKED_SIDE_PIXELS / max(rgb.shape[:2])
    if scale >= 1:
        return rgb
    return np.asarray(cv2.resize(rgb, None, fx=scale, fy=scale, interpolation=cv2.INTER_AREA), np.uint8)
