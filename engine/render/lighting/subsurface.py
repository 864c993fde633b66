"""Light that wanders under the skin: the irradiance of a picture, blurred as skin blurs it.

Source of the profile: E. d'Eon, D. Luebke, Advanced Techniques for Realistic Real-Time Skin Rendering, GPU Gems 3,
2007 (a sum of Gaussians fitted to measured skin); done on the screen as by J. Jimenez et al., Screen-Space
Perceptual Rendering of Human Skin, 2009, here with exact Gaussians.
"""

from __future__ import annotations

import numpy as np
from numba import prange
from numpy.typing import NDArray

from engine.compiled import njit

PROFILE_VARIANCES = (0.0064, 0.0484, 0.187, 0.567, 1.99, 7.41)
"""Variance of each Gaussian of the profile, square millimetres."""

PROFILE_WEIGHTS = (
    (0.233, 0.455, 0.649),
    (0.100, 0.336, 0.344),
    (0.118, 0.198, 0.000),
    (0.113, 0.007, 0.007),
    (0.358, 0.004, 0.000),
    (0.078, 0.000, 0.000),
)
"""Red, green and blue share of each Gaussian."""

MIN_GAUSSIAN_WEIGHT = 0.01
"""Share of a Gaussian below which the others take it: it would cost as much as a large one and cannot be seen."""


def diffuse(
    irradiance: NDArray[np.float32],
    translucency: NDArray[np.float32],
    depth: NDArray[np.float32],
    pixels_per_metre: float,
) -> NDArray[np.float32]:
    """Blur (H, W, 3) irradiance as skin does.

    `translucency` (H, W) is 1 where the surface is skin, and 0 where it is not translucent: no light comes from there
    nor goes there. `depth` (H, W) is in metres, +inf where nothing is: light does not leap from one depth to another.
    """
    shares = np.array(PROFILE_WEIGHTS, np.float32)
    shares[shares < MIN_GAUSSIAN_WEIGHT] = 0
    shares /= shares.sum(0)
    total = np.zeros_like(irradiance)
    weight, turned_weight = np.ascontiguousarray(translucency), np.ascontiguousarray(translucency.T)
    turned_depth = np.ascontiguousarray(depth.T)
    for colour in range(3):
        channel = np.ascontiguousarray(irradiance[..., colour])
        for variance, share in zip(PROFILE_VARIANCES, shares[:, colour], strict=True):
            if share == 0:
                continue
            sigma = np.sqrt(variance) / 1000 * pixels_per_metre
            blurred = channel
            if sigma > 0.4:
                reach = float(max(2.5 * np.sqrt(variance) / 1000, 0.001))
                once = _blur_rows(channel, weight, depth, sigma, reach)
                blurred = _blur_rows(np.ascontiguousarray(once.T), turned_weight, turned_depth, sigma, reach).T
            total[..., colour] += share * blurred
    return total


@njit(parallel=True, fastmath=True)
def _blur_rows(image: np.ndarray, weight: np.ndarray, depth: np.ndarray, sigma: float, reach: float) -> np.ndarray:
    most = np.float32(reach)
    height, width = weight.shape
    radius = int(np.ceil(2.6 * sigma))
    kernel = np.exp(-0.5 * (np.arange(-radius, radius + 1) / sigma) ** 2).astype(np.float32)
    out = image.copy()
    for y in prange(height):
        for x in range(width):
            if weight[y, x] <= 0:
                continue
            light, total = np.float32(0), np.float32(0)
            here = depth[y, x]
            first, last = max(x - radius, 0), min(x + radius, width - 1)
            weights, values, depths = (
                weight[y, first : last + 1],
                image[y, first : last + 1],
                depth[y, first : last + 1],
            )
            bell = kernel[first - x + radius : last - x + radius + 1]
            for k in range(len(bell)):  # without branches: it runs in vectors
                near = np.float32(abs(depths[k] - here) <= most)
                w = near * bell[k] * weights[k]
                light += w * values[k]
                total += w
            if total > 0:
                out[y, x] = light / total
    return out
