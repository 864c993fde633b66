"""A driver's face that something covers while the tracker goes on.

A tracker that follows a face goes on for as long as what it sees has the colours of skin: over a hand, it makes a face of
the hand. So what it follows is held against the face that was seen first. A face that turned or lights up may look as
unlike that one; then a detector, which knows nothing of what came before, has to find a face there.
"""

from __future__ import annotations

from types import TracebackType

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.perception.face.faces import MIN_CONFIDENCE, FaceTracker
from engine.perception.face_track.face_crop import FaceCrop

COMPARED_SIZE = (80, 72)
"""Height and width at which faces are compared, pixels."""
FACE_REGION = (slice(14, 66), slice(10, 62))
"""Rows and columns in which the face is, from the brows to the chin, of a picture of `COMPARED_SIZE`."""
FINE_SIGMA_PIXELS, COARSE_SIGMA_PIXELS = 1.0, 8.0
"""Pixels: structure between these two counts. Finer is noise, coarser is light."""
SAME_FACE_CORRELATION = 0.3
"""Correlation above which it is the same face: of what covers faces 0.13 at most was seen, of faces that speak 0.4, that
turn 0."""
SEARCH_MARGIN_FACE_SIZES = 1.0
"""How far around the middle of a face a detector looks, in the face's size."""


class CoveredFace:
    """Whether something covers the face that is followed. Use as a context manager."""

    def __init__(self) -> None:
        self._first: NDArray[np.float32] | None = None
        self._detector: FaceTracker | None = None

    def __enter__(self) -> CoveredFace:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if self._detector is not None:
            self._detector.__exit__(kind, error, trace)

    def __call__(self, rgb: NDArray[np.uint8], seen: FaceCrop) -> bool:
        """Of the face that a tracker says it has `seen` in a frame (H, W, 3); that of the first call is the true one."""
        look = _structure(seen.crop)
        if self._first is None:
            self._first = look
        return float((look * self._first).mean()) < SAME_FACE_CORRELATION and not self._detected(rgb, seen)

    def _detected(self, rgb: NDArray[np.uint8], seen: FaceCrop) -> bool:
        if self._detector is None:
            self._detector = FaceTracker(confidence=MIN_CONFIDENCE, alone=True)
        low, high = seen.mesh[:, :2].min(axis=0), seen.mesh[:, :2].max(axis=0)
        middle, reach = (low + high) / 2, SEARCH_MARGIN_FACE_SIZES * float((high - low).max())
        x0, y0 = np.maximum(middle - reach, 0).astype(int)
        x1, y1 = np.minimum(middle + reach, rgb.shape[1::-1]).astype(int)
        return min(x1 - x0, y1 - y0) >= 8 and bool(self._detector(rgb[y0:y1, x0:x1]))


def _structure(crop: NDArray[np.uint8]) -> NDArray[np.float32]:
    """What stands out of the light in a face's crop, of mean 0 and deviation 1; nothing where hardly anything does."""
    grey = cv2.cvtColor(cv2.resize(crop, COMPARED_SIZE[::-1], interpolation=cv2.INTER_AREA), cv2.COLOR_RGB2GRAY)
    light = grey.astype(np.float32)
    band = (cv2.GaussianBlur(light, (0, 0), FINE_SIGMA_PIXELS) - cv2.GaussianBlur(light, (0, 0), COARSE_SIGMA_PIXELS))[
        FACE_REGION
    ]
    return np.asarray((band - band.mean()) / max(float(band.std()), 1.0), np.float32)
