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
SPLIT_BREGMAN_ITERATIONS = 150


def denoised(
    field: NDArray[np.floating], weight: float, huber: float, trust: NDArray[np.floating] | None = None
) -> NDArray[np.float32]:
    """(H, W) the field u that minimises weight * sum h(|grad u|) + 1/2 sum trust * (u - field)^2. There h is Huber's
    norm: the square over twice `huber` up to `huber`, and the absolute value less half of it beyond.

    trust : (H, W) from zero on, by default one: how far each value of `field` is to be believed.
    """
    values = np.ascontiguousarray(field, np.float32)
    believed = np.ones_like(values) if trust is None else np.ascontiguousarray(trust, np.float32)
    convexity = 1.0 if trust is None else 0.0  # of the data's term: what may be believed nowhere has none
    return np.asarray(_solve(values, believed, weight, huber / weight, convexity, SPLIT_BREGMAN_ITERATIONS), np.float32)


@njit(nogil=True, fastmath=True, error_model="numpy", boundscheck=False)
def _solve(
    field: np.ndarray,
    trust: np.ndarray,
    weight: float,
    dual_convexity: float,
    convexity: float,
    iterations: int,
) -> np.ndarray:
    """In single precision throughout, rows without branches: the compiler takes eight pixels at once."""
    height, width = field.shape
    one = np.float32(1)
    u, ahead = field.copy(), field.copy()
    p = np.zeros((2, height + 1, width + 1), np.float32)
    tau = sigma = 1 / np.sqrt(OPERATOR_NORM_SQUARED)
    for _ in range(iterations):
        shrink, step, rate = np.float32(1 / (1 + sigma * dual_convexity)), np.float32(sigma), np.float32(tau)
        theta = 1 / np.sqrt(1 + 2 * convexity * tau)
        pull, inverse = np.float32(theta), np.float32(1 / weight)
        for y in range(height):
            here, below = ahead[y], ahead[min(y + 1, height - 1)]
            px, py = p[0, y + 1], p[1, y + 1]
            for x in range(width - 1):  # of pixel (y, x) at (y + 1, x + 1): zeros lie before the first
                a = (px[x + 1] + step * (here[x + 1] - here[x])) * shrink
                b = (py[x + 1] + step * (below[x] - here[x])) * shrink
                scale = one / max(one, np.sqrt(a * a + b * b) * inverse)
                px[x + 1], py[x + 1] = a * scale, b * scale
            b = (py[width] + step * (below[width - 1] - here[width - 1])) * shrink
            py[width] = b / max(one, abs(b) * inverse)
        for y in range(height):
            px, py, above = p[0, y + 1], p[1, y + 1], p[1, y]
            now, here, wanted, believed = u[y], ahead[y], field[y], trust[y]
            for x in range(width):
                before, own = now[x], rate * believed[x]
                divergence = px[x + 1] - px[x] + py[x + 1] - above[x + 1]
                after = (before + rate * divergence + own * wanted[x]) / (one + own)
                now[x], here[x] = after, after + pull * (after - before)
        tau *= theta
        sigma /= theta
    return u
