"""The aligning transformation phi between the driver's neutral frame and the target."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from engine.perception.landmarks import EYES_AND_NOSE_TIP


@dataclass(frozen=True)
class Similarity:
    """A rotation with scale and a shift in the picture plane: q = linear @ p + shift."""

    linear: NDArray[np.float64]
    shift: NDArray[np.float64]

    def __call__(self, points: NDArray[np.floating]) -> NDArray[np.float64]:
        """Positions (..., 2) carried over, pixels."""
        return points @ self.linear.T + self.shift

    def offsets(self, offsets: NDArray[np.floating]) -> NDArray[np.float64]:
        """Offsets (..., 2) carried over: only the linear part acts on them (equation 1)."""
        return offsets @ self.linear.T

    @property
    def scale(self) -> float:
        """Pixels of the destination for one pixel of the source."""
        return float(np.hypot(self.linear[0, 0], self.linear[1, 0]))

    def inverse(self) -> Similarity:
        """The transformation back."""
        linear = np.linalg.inv(self.linear)
        return Similarity(np.asarray(linear, np.float64), np.asarray(-linear @ self.shift, np.float64))

    def matrix(self) -> NDArray[np.float64]:
        """(2, 3), as OpenCV's affine functions take it."""
        return np.hstack([self.linear, self.shift[:, None]])


def fit_similarity(source: NDArray[np.floating], destination: NDArray[np.floating]) -> Similarity:
    """The similarity that carries (N, 2) `source` to `destination` with the least squared error."""
    a, b = source - source.mean(axis=0), destination - destination.mean(axis=0)
    norm = float((a**2).sum())
    cosine = float((a * b).sum()) / norm
    sine = float((a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]).sum()) / norm
    linear = np.array([[cosine, -sine], [sine, cosine]])
    shift = destination.mean(axis=0) - linear @ source.mean(axis=0)
    return Similarity(linear, np.asarray(shift, np.float64))


def align(neutral: NDArray[np.floating], target: NDArray[np.floating]) -> Similarity:
    """phi: from the driver's neutral mesh to the target's, over the eyes and the nose tip (section 4).

    Parameters
    ----------
    neutral, target : (478, 2 or 3) meshes in pixels.
    """
    chosen = list(EYES_AND_NOSE_TIP)
    return fit_similarity(neutral[chosen, :2].astype(float), target[chosen, :2].astype(float))
