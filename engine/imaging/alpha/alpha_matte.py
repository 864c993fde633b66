"""Alpha matting: how much of each pixel along an outline belongs to the front layer.

Closed-form matting (Levin, Lischinski, Weiss, "A closed-form solution to natural image matting", PAMI 2008). Inside
each 3x3 window alpha is taken to be an affine function of the colour. That makes alpha the minimum of a quadratic form,
the matting Laplacian. It is solved on the unknown pixels of a trimap only, from a coarse picture to a fine one. A
second source of evidence holds it: pairs of a front and a back colour found along rays
(`engine.imaging.alpha.colour_pairs`). They carry alpha across wide bands of hair where the Laplacian alone would bleed.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from engine.compiled import njit
from engine.imaging.alpha.colour_pairs import alpha_from_colour_pairs
from engine.imaging.resample import resized

MATTE_COVARIANCE_REGULARISATION = 2e-5
"""What is added to the variances of a window's colours in [0, 1]: grain of scans and JPEG."""

SAMPLE_WEIGHT = 1.0
"""Weight of an alpha found from a pair of colours beside the Laplacian, at full confidence."""


def alpha_matte(
    rgb: NDArray[np.uint8],
    trimap: NDArray[np.float32],
    prior: NDArray[np.float32] | None = None,
    prior_weight: NDArray[np.float32] | None = None,
) -> NDArray[np.float32]:
    """Alpha (H, W) in [0, 1] of the layer that a trimap outlines.

    Parameters
    ----------
    rgb : (H, W, 3) uint8.
    trimap : (H, W) float32, 1 where the layer covers the pixel, 0 where it does not, anything between
        where it is to be found.
    prior, prior_weight : (H, W) float32: an alpha that is believed before looking at the colours, and
        how much (0 not at all; 0.01 about as much as a clear pair of colours).
    """
    pixels: NDArray[np.float32] = np.ascontiguousarray(rgb, np.float32) / np.float32(255)
    unknown = (trimap > 0) & (trimap < 1)
    if not unknown.any():
        return trimap.astype(np.float32)
    sampled, confidence = alpha_from_colour_pairs(rgb, trimap)
    weight = np.float32(SAMPLE_WEIGHT) * confidence
    pull = weight * sampled
    if prior is not None and prior_weight is not None:
        weight = weight + prior_weight
        pull = pull + prior_weight * prior
    weight += 1e-6  # keeps islands without evidence solvable
    pull += 1e-6 * np.float32(0.5)
    target = np.asarray(pull / weight, np.float32)
    return _coarse_to_fine(pixels, trimap.astype(np.float32), target, np.asarray(weight, np.float32))


def _coarse_to_fine(
    pixels: NDArray[np.float32], trimap: NDArray[np.float32], target: NDArray[np.float32], weight: NDArray[np.float32]
) -> NDArray[np.float32]:
    height, width = trimap.shape
    unknown = (trimap > 0) & (trimap < 1)
    if min(height, width) >= 96:
        half = (width // 2, height // 2)
        small_weight = resized(weight, half)
        small_pull = resized(target * weight, half)
        small_target = (small_pull / np.maximum(small_weight, 1e-9)).astype(np.float32)
        # a coarse pixel stands for four fine ones, and so does its evidence
        coarse = _coarse_to_fine(resized(pixels, half), resized(trimap, half), small_target, 4 * small_weight)
        start = resized(coarse, (width, height))
        iterations = 30
    else:
        start = target
        iterations = 150
    start = np.where(unknown, start, trimap).astype(np.float32)
    return np.clip(_solve(pixels, trimap, start, target, weight, iterations), 0, 1)


def _solve(
    pixels: NDArray[np.float32],
    trimap: NDArray[np.float32],
    start: NDArray[np.float32],
    target: NDArray[np.float32],
    weight: NDArray[np.float32],
    iterations: int,
) -> NDArray[np.float32]:
    ys, xs = np.nonzero((trimap > 0) & (trimap < 1))
    number = np.full(trimap.shape, -1, np.int32)
    number[ys, xs] = np.arange(len(ys), dtype=np.int32)
    rows = laplacian_rows(pixels, number, len(ys), MATTE_COVARIANCE_REGULARISATION)
    neighbours, right = _couple(rows, number, trimap, ys.astype(np.int32), xs.astype(np.int32))
    diagonal = weight[ys, xs]
    right += diagonal * target[ys, xs]
    rows[:, 12] += diagonal
    solution = _conjugate_gradients(rows, neighbours, right, start[ys, xs].astype(np.float32), iterations, 1e-4)
    alpha = trimap.copy()
    alpha[ys, xs] = solution
    return alpha


@njit(fastmath=True, nogil=True)
def laplacian_rows(pixels, number, count, noise):  # type: ignore[no-untyped-def]
    """Rows of the matting Laplacian for the numbered pixels, over their 5x5 neighbours: (count, 25)."""
    height, width = number.shape
    rows = np.zeros((count, 25), np.float32)
    colour = np.empty((9, 3), np.float32)
    member = np.empty(9, np.int32)
    for cy in range(1, height - 1):
        for cx in range(1, width - 1):
            any_unknown = False
            for k in range(9):
                member[k] = number[cy + k // 3 - 1, cx + k % 3 - 1]
                any_unknown = any_unknown or member[k] >= 0
            if not any_unknown:
                continue
            m0 = m1 = m2 = np.float32(0)
            for k in range(9):
                y, x = cy + k // 3 - 1, cx + k % 3 - 1
                colour[k, 0], colour[k, 1], colour[k, 2] = pixels[y, x, 0], pixels[y, x, 1], pixels[y, x, 2]
                m0 += colour[k, 0]
                m1 += colour[k, 1]
                m2 += colour[k, 2]
            m0, m1, m2 = m0 / 9, m1 / 9, m2 / 9
            a = b = c = d = e = f = np.float32(0)
            for k in range(9):
                colour[k, 0] -= m0
                colour[k, 1] -= m1
                colour[k, 2] -= m2
                r, g, v = colour[k, 0], colour[k, 1], colour[k, 2]
                a += r * r
                b += r * g
                c += r * v
                d += g * g
                e += g * v
                f += v * v
            a, b, c, d, e, f = a / 9 + noise, b / 9, c / 9, d / 9 + noise, e / 9, f / 9 + noise
            i00, i01, i02 = d * f - e * e, c * e - b * f, b * e - c * d
            i11, i12, i22 = a * f - c * c, b * c - a * e, a * d - b * b
            scale = 1.0 / (a * i00 + b * i01 + c * i02)
            for k in range(9):
                row = member[k]
                if row < 0:
                    continue
                r, g, v = colour[k, 0], colour[k, 1], colour[k, 2]
                s0 = (i00 * r + i01 * g + i02 * v) * scale
                s1 = (i01 * r + i11 * g + i12 * v) * scale
                s2 = (i02 * r + i12 * g + i22 * v) * scale
                base = (2 - k // 3) * 5 + 2 - k % 3
                for j in range(9):
                    dot = s0 * colour[j, 0] + s1 * colour[j, 1] + s2 * colour[j, 2]
                    rows[row, base + (j // 3) * 5 + j % 3] -= (1 + dot) / 9
                rows[row, 12] += 1
    return rows


@njit(nogil=True)
def _couple(rows, number, known, ys, xs):  # type: ignore[no-untyped-def]
    """Numbers of each row's unknown neighbours (itself where there is none), and what the known ones give."""
    height, width = number.shape
    count = len(ys)
    neighbours = np.empty((count, 25), np.int32)
    right = np.zeros(count, np.float32)
    for i in range(count):
        for k in range(25):
            y, x = ys[i] + k // 5 - 2, xs[i] + k % 5 - 2
            neighbours[i, k] = i
            if k == 12:
                continue
            if 0 <= y < height and 0 <= x < width and number[y, x] >= 0:
                neighbours[i, k] = number[y, x]
            else:
                if 0 <= y < height and 0 <= x < width:
                    right[i] -= rows[i, k] * known[y, x]
                rows[i, k] = 0
    return neighbours, right


@njit(fastmath=True, nogil=True)
def _conjugate_gradients(rows, neighbours, right, x, iterations, tolerance):  # type: ignore[no-untyped-def]
    """Solve with the diagonal as preconditioner; stops when the residual has shrunk by `tolerance`."""
    count = len(right)
    residual = np.empty(count, np.float32)
    along = np.empty(count, np.float32)
    product = np.empty(count, np.float32)
    energy = 0.0
    scale = 0.0
    for i in range(count):
        total = right[i]
        for k in range(25):
            total -= rows[i, k] * x[neighbours[i, k]]
        residual[i] = total
        along[i] = total / rows[i, 12]
        energy += total * along[i]
        scale += right[i] * right[i] / rows[i, 12]
    stop = tolerance * tolerance * max(scale, 1e-12)
    for _ in range(iterations):
        if energy <= stop:
            break
        curvature = 0.0
        for i in range(count):
            total = np.float32(0)
            for k in range(25):
                total += rows[i, k] * along[neighbours[i, k]]
            product[i] = total
            curvature += total * along[i]
        step = np.float32(energy / max(curvature, 1e-20))
        after = 0.0
        for i in range(count):
            x[i] += step * along[i]
            residual[i] -= step * product[i]
            after += residual[i] * residual[i] / rows[i, 12]
        turn = np.float32(after / energy)
        for i in range(count):
            along[i] = residual[i] / rows[i, 12] + turn * along[i]
        energy = after
    return x
