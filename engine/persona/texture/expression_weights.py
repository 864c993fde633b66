"""How much each photograph counts for an expression: equation 2's first factor, its width chosen so that enough photographs count.

A fixed sigma of ten, as the paper has it, leaves one photograph alone, light and all, where an expression is rare.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import gaussian_filter1d

from engine.perception.face.landmarks import fiducials

SIGMA_PIXELS = 10.0
"""Of distances of all fiducials together, in a frame 194 wide (section 6)."""
MIN_EFFECTIVE_PHOTOS, MAX_EFFECTIVE_PHOTOS = 8.0, 16.0
"""That count for an expression: the square of the weights' sum over the sum of their squares."""
SMOOTHING_FRAMES = 2.0
"""Sigma by which weights are smoothed in time."""
WEIGHT_BISECTION_STEPS = 30
SIGMA_RANGE = (0.01, 1000.0)
FIRST_INNER_FIDUCIAL = 17
"""Of the 68: the jaw's say where the head is turned to, not what the face does."""


def expression_points(meshes: NDArray[np.floating]) -> NDArray[np.float64]:
    """(N, 51, 2) fiducials of brows, eyes, nose and lips of meshes (N, 478, 3) that are laid on the frame, in their units."""
    return np.asarray(fiducials(meshes)[:, FIRST_INNER_FIDUCIAL:, :2], np.float64)


def expression_weights(
    targets: NDArray[np.floating], photos: NDArray[np.floating], smoothing: float = 0.0
) -> NDArray[np.float32]:
    """(F, N) how much N photographs count for F expressions, by their points (F, 51, 2) and (N, 51, 2) in pixels of a frame 194 wide:
    exp(-d^2 / (2 sigma^2)), each row's largest 1.

    Sigma is the paper's, or as much more or less as lets `MIN_EFFECTIVE_PHOTOS` to `MAX_EFFECTIVE_PHOTOS` photographs count. `smoothing` is in time, for
    rows that are frames: a sigma in frames.
    """
    squares = ((targets[:, None] - photos[None]) ** 2).sum(axis=(2, 3))
    squares -= squares.min(axis=1, keepdims=True)  # a common factor of a row: it changes no mean
    count = len(photos)
    sigma = np.full(len(targets), SIGMA_PIXELS)
    for least, wanted in ((True, min(MIN_EFFECTIVE_PHOTOS, count)), (False, min(MAX_EFFECTIVE_PHOTOS, count))):
        effective = _effective(squares, sigma)
        off = effective < wanted - 1e-6 if least else effective > wanted + 1e-6
        sigma[off] = _sigma_for(squares[off], wanted)
    weights = np.exp(-squares / (2 * sigma[:, None] ** 2))
    if smoothing > 0 and len(weights) > 1:
        weights = gaussian_filter1d(weights, smoothing, axis=0, mode="nearest")
    return np.asarray(weights, np.float32)


def effective_photos(weights: NDArray[np.floating]) -> NDArray[np.float64]:
    """(F,) how many photographs count in each row of weights (F, N)."""
    return np.asarray(weights.sum(axis=1) ** 2 / (weights**2).sum(axis=1), np.float64)


def _effective(squares: NDArray[np.float64], sigma: NDArray[np.float64]) -> NDArray[np.float64]:
    return effective_photos(np.exp(-squares / (2 * sigma[:, None] ** 2)))


def _sigma_for(squares: NDArray[np.float64], wanted: float) -> NDArray[np.float64]:
    """By bisection: the more photographs count, the larger sigma is."""
    low, high = (np.full(len(squares), bound) for bound in SIGMA_RANGE)
    for _ in range(WEIGHT_BISECTION_STEPS):
        middle = np.sqrt(low * high)
        few = _effective(squares, middle) < wanted
        low, high = np.where(few, middle, low), np.where(few, high, middle)
    return np.sqrt(low * high)
