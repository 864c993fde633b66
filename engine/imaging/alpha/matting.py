"""The colours of a layer without the picture behind it bleeding in.

Where a pixel is partly hair and partly wall, its colour is I = alpha F + (1 - alpha) B. Moving such
pixels over another background shows the old one as a halo, so F (and B) must be told apart. After
Germer, Uelwer, Conrad, Harmeling, "Fast multi-level foreground estimation", ICPR 2020: F and B are as
smooth as alpha allows, solved pixel by pixel on a pyramid from a single pixel to the full picture.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from engine.compiled import njit
from engine.imaging.resample import resized

FLAT_SMOOTHNESS_WEIGHT = 5e-3
"""Weight of smoothness where alpha is flat (the paper: 1)."""
EDGE_SMOOTHNESS_WEIGHT = 0.1
"""By how much the weight of smoothness grows with the step of alpha between neighbours (the paper: 1e-5)."""

MIN_SETTLED_SIDE_PIXELS = 256
"""Pixels of the longest side of a picture from which pixels amid wholly opaque or transparent ones are settled already."""

TRANSPARENT_RELUCTANCE = 0.1
"""How reluctantly transparent pixels take up what the composition at rest misses: the weight of their squared transparency."""


def estimate_foreground(
    rgb: NDArray[np.uint8] | NDArray[np.float32], alpha: NDArray[np.float32]
) -> NDArray[np.float32]:
    """Colours (H, W, 3) of the layer, float32 in the units of `rgb`; `alpha` (H, W) in [0, 1].

    Opaque pixels keep their colour exactly; where alpha is 0 the layer's colours are continued outward.
    """
    return estimate_layers(rgb, alpha)[0]


def estimate_layers(
    rgb: NDArray[np.uint8] | NDArray[np.float32], alpha: NDArray[np.float32]
) -> tuple[NDArray[np.float32], NDArray[np.float32]]:
    """Colours of the layer and of what is behind it: two (H, W, 3) float32 in the units of `rgb`."""
    image = np.ascontiguousarray(rgb, np.float32)
    matte = np.ascontiguousarray(alpha, np.float32)
    height, width = matte.shape
    front = np.full((1, 1, 3), image[matte > 0.9].mean(0) if (matte > 0.9).any() else image.mean((0, 1)), np.float32)
    back = np.full((1, 1, 3), image[matte < 0.1].mean(0) if (matte < 0.1).any() else image.mean((0, 1)), np.float32)
    levels = max(1, int(np.ceil(np.log2(max(height, width)))))
    sizes = [(max(1, round(width ** (k / levels))), max(1, round(height ** (k / levels)))) for k in range(levels + 1)]
    pyramid = [(image, matte)]
    for size in reversed(sizes[:-1]):
        pyramid.append((resized(pyramid[-1][0], size), resized(pyramid[-1][1], size)))
    for size, (small_image, small_matte) in zip(sizes, reversed(pyramid), strict=True):
        front, back = resized(front, size, smooth=False).copy(), resized(back, size, smooth=False).copy()
        _relax(small_image, small_matte, front, back, 10 if max(size) <= 32 else 2, max(size) > MIN_SETTLED_SIDE_PIXELS)
    np.copyto(front, image, where=matte[..., None] >= 1)
    np.copyto(back, image, where=matte[..., None] <= 0)
    return front, back


def reconcile_with_plate(
    rgb: NDArray[np.uint8] | NDArray[np.float32],
    alpha: NDArray[np.float32],
    front: NDArray[np.float32],
    plate: NDArray[np.uint8],
) -> NDArray[np.float32]:
    """The layer's colours `front` (H, W, 3), changed so that over this `plate` the layer at rest gives `rgb`.

    A plate is a likely background, not the one that shone through the hair. What the composition at rest
    misses is given back to the layer's colours: in full where it is nearly opaque, and less the more transparent it is.
    There it would turn into specks once the layer moves.
    """
    a = alpha[..., None]
    missing = rgb - a * front - (1 - a) * plate
    share = a / (np.square(a) + TRANSPARENT_RELUCTANCE * np.square(1 - a))
    return np.clip(front + share * missing, 0, 255).astype(np.float32)


@njit(fastmath=True, nogil=True)
def _relax(image, alpha, front, back, sweeps, some_settled):  # type: ignore[no-untyped-def]
    """Gauss-Seidel sweeps over the 2x2 systems of each pixel's front and back colour, in place."""
    height, width = alpha.shape
    for _ in range(sweeps):
        for y in range(height):
            for x in range(width):
                a = alpha[y, x]
                if some_settled and (a == 0 or a == 1) and _amid_equals(alpha, y, x):
                    continue
                b = 1 - a
                weights = np.float32(0)
                f0 = f1 = f2 = b0 = b1 = b2 = np.float32(0)
                for k in range(4):
                    ny = y + (1 if k == 0 else -1 if k == 1 else 0)
                    nx = x + (1 if k == 2 else -1 if k == 3 else 0)
                    ny, nx = min(max(ny, 0), height - 1), min(max(nx, 0), width - 1)
                    weight = FLAT_SMOOTHNESS_WEIGHT + EDGE_SMOOTHNESS_WEIGHT * abs(a - alpha[ny, nx])
                    weights += weight
                    f0 += weight * front[ny, nx, 0]
                    f1 += weight * front[ny, nx, 1]
                    f2 += weight * front[ny, nx, 2]
                    b0 += weight * back[ny, nx, 0]
                    b1 += weight * back[ny, nx, 1]
                    b2 += weight * back[ny, nx, 2]
                # [a a + w, a b; a b, b b + w] [F; B] = [a I + w meanF; b I + w meanB]
                m00, m01, m11 = a * a + weights, a * b, b * b + weights
                scale = 1 / (m00 * m11 - m01 * m01)
                for c in range(3):
                    colour = image[y, x, c]
                    sum_f = f0 if c == 0 else f1 if c == 1 else f2
                    sum_b = b0 if c == 0 else b1 if c == 1 else b2
                    right_f, right_b = a * colour + sum_f, b * colour + sum_b
                    front[y, x, c] = min(max((m11 * right_f - m01 * right_b) * scale, 0.0), 255.0)
                    back[y, x, c] = min(max((m00 * right_b - m01 * right_f) * scale, 0.0), 255.0)


@njit(fastmath=True, nogil=True, forceinline=True)
def _amid_equals(alpha, y, x):  # type: ignore[no-untyped-def]
    """Whether a pixel is as opaque as each of its neighbours."""
    height, width = alpha.shape
    a = alpha[y, x]
    return (
        alpha[max(y - 1, 0), x] == a
        and alpha[min(y + 1, height - 1), x] == a
        and alpha[y, max(x - 1, 0)] == a
        and alpha[y, min(x + 1, width - 1)] == a
    )
