"""What a phone measures of the light: its exposure drifts, and its sensor has noise."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from benchmarks.scan_studio.people.sway import SmoothCurve
from engine.compiled import njit

EXPOSURE_DRIFT_SHARE = 0.08
"""Share by which brightness drifts, at most."""
BALANCE_DRIFT_SHARE = 0.015
"""Share by which red and blue drift against green, at most."""
SHOT_NOISE_VARIANCE = 2.5e-4
"""Variance to a unit of light, of what is left after a phone's own denoising."""
READ_NOISE_SIGMA = 1.2e-3
"""Standard deviation in the dark, where white is 1."""


@dataclass(frozen=True)
class Sensor:
    """A sensor during a film of `seconds`."""

    seconds: float
    seed: int
    """Of the drifts and of the noise."""

    def gains(self, seconds: NDArray[np.float64]) -> NDArray[np.float64]:
        """(N, 3) by what red, green and blue light are multiplied at these moments (N,)."""
        exposure = 1 + EXPOSURE_DRIFT_SHARE * SmoothCurve(1, self.seconds, self.seed)(seconds)
        balance = BALANCE_DRIFT_SHARE * SmoothCurve(2, self.seconds, self.seed + 1)(seconds)
        return exposure * (1 + np.stack([balance[:, 0], 0 * seconds, balance[:, 1]], 1))

    def read(self, light: NDArray[np.float32], gains: NDArray[np.float64], frame: int) -> NDArray[np.float32]:
        """Linear light (H, W, 3) as it is measured, with the noise of this frame."""
        random = np.random.default_rng((self.seed, frame))
        return _read(light, gains.astype(np.float32), random.standard_normal(light.shape, np.float32))


@njit(nogil=True, boundscheck=False)
def _read(light: np.ndarray, gains: np.ndarray, noise: np.ndarray) -> np.ndarray:
    found = np.empty_like(light)
    shot, still = np.float32(SHOT_NOISE_VARIANCE), np.float32(READ_NOISE_SIGMA**2)
    for y in range(light.shape[0]):
        for x in range(light.shape[1]):
            for k in range(3):
                value = light[y, x, k] * gains[k]
                found[y, x, k] = value + noise[y, x, k] * np.sqrt(shot * value + still)
    return found
