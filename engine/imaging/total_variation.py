"""Fields without noise whose edges stay: total variation denoising.

Source: L. Rudin, S. Osher, E. Fatemi, Nonlinear total variation based noise removal algorithms, Physica D 60, 1992, with Huber's norm in place
of the absolute value; solved by the primal-dual algorithm of A. Chambolle, T. Pock, JMIV 40, 2011 (algorithm 2).
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from engine.compiled import njit

OPERATOR_NORM_SQUARED = 8.0
"""Of the gradient on a grid of pixels, at most."""
ITERATIONS = 150


def denoised(
    field: NDArray[np.floating], weight: float, huber: float, trust: NDArray[np.floating] | None = None
) -> NDArray[np.float32]:
    """(H, W) the field u that minimises weight * sum h(|grad u|) + 1/2 sum trust * (u - field)^2, where h is Huber's norm: the square
    over twice `huber` up to `huber`, and the absolute value less half of it beyond.

    trust : (H, W) from zero on, by default one: how far each value of `field` is to be believed.
    """
    values = np.ascontiguousarray(field, np.float32)
    believed = np.ones_like(values) if trust is None else np.ascontiguousarray(trust, np.float32)
    convexity = 1.0 if trust is None else 0.0  # of the data's term: what may be believed nowhere has none
    return np.asarray(_solve(values, believed, weight, huber / weight, convexity, ITERATIONS), np.float32)


@njit(nogil=True, fastmath=True, error_model="numpy")
def _solve(
    field: np.ndarray,
    trust: np.ndarray,
    weight: float,
    dual_convexity: float,
    convexity: float,
    iterations: int,
) -> np.ndarray:
    height, width = field.shape
    u = field.copy()
    ahead = field.copy()
    px, py = np.zeros_like(field), np.zeros_like(field)
    tau = sigma = 1 / np.sqrt(OPERATOR_NORM_SQUARED)
    for _ in range(iterations):
        shrink = np.float32(1 / (1 + sigma * dual_convexity))
        theta = 1 / np.sqrt(1 + 2 * convexity * tau)
        for y in range(height):
            for x in range(width):
                gx = ahead[y, x + 1] - ahead[y, x] if x + 1 < width else np.float32(0)
                gy = ahead[y + 1, x] - ahead[y, x] if y + 1 < height else np.float32(0)
                a, b = (px[y, x] + sigma * gx) * shrink, (py[y, x] + sigma * gy) * shrink
                scale = max(1.0, np.sqrt(a * a + b * b) / weight)
                px[y, x], py[y, x] = a / scale, b / scale
        for y in range(height):
            for x in range(width):
                divergence = px[y, x] + py[y, x]
                if x:
                    divergence -= px[y, x - 1]
                if y:
                    divergence -= py[y - 1, x]
                before = u[y, x]
                rate = tau * trust[y, x]
                now = (before + tau * divergence + rate * field[y, x]) / (1 + rate)
                u[y, x] = now
                ahead[y, x] = now + theta * (now - before)
        tau *= theta
        sigma /= theta
    return u
