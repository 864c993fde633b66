"""What all photographs of a face have in common, in whatever light: a subspace of few dimensions, and where one does not lie in it.

Source: section 5, "appearance subspaces"; I. Kemelmacher-Shlizerman, S. M. Seitz, Collection flow, CVPR 2012, which it follows: rank 4. Ours is
robust: spectacles, hands, caps and hard shadows are left out of the fit, and told.
"""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

SUBSPACE_RANK = 4
"""A convex face under any light is a mixture of four pictures to within a few hundredths (R. Basri, D. W. Jacobs, PAMI 2003)."""
MIN_PHOTOS_OF_DIMENSION = 3.0
"""Photographs in which a dimension of the subspace has to lie, at least."""
MIN_SUBSPACE_BELIEF = 0.01
"""Weight of all pixels as they are, so that a photograph of which next to nothing is believed has a light, too."""
RESIDUAL_SIGMA = 14.0
"""Grey levels off the subspace, of a face of mean grey, at which a pixel counts half."""
FITTING_ROUNDS = (
    (1, 4 * RESIDUAL_SIGMA),
    (2, 3 * RESIDUAL_SIGMA),
    (3, 2 * RESIDUAL_SIGMA),
    (SUBSPACE_RANK, RESIDUAL_SIGMA),
    (SUBSPACE_RANK, RESIDUAL_SIGMA),
)
"""Rank and sigma of each in which the subspace is fitted: begun with all dimensions, one would be what covers some of the faces."""
EXPOSED_GREY = 120.0
"""Mean grey of the face to which every photograph is exposed before it is compared."""
FINE_SIGMA, COARSE_SIGMA = 1.0, 2.0
"""Pixels of a frame 194 wide: finer residuals are noise, and pixels count with those about them."""
REFERENCE_WIDTH_PIXELS = 194
"""Pixels of the paper's textures, for which sigmas are told."""


@dataclass(frozen=True)
class Appearance:
    """N photographs (H, W) as their subspace has them.

    exposed : (N, H, W) float32, the photographs' greys, each of the same mean.
    projected : (N, H, W), these in the subspace, which is each photograph's light on the common face.
    weights : (N, H, W) in [0, 1], how far each pixel can be believed.
    """

    exposed: NDArray[np.float32]
    projected: NDArray[np.float32]
    weights: NDArray[np.float32]


def exposed(grey: NDArray[np.float32], face: NDArray[np.bool_]) -> NDArray[np.float32]:
    """Greys (N, H, W), each scaled so that its mean over the `face` (H, W) is `EXPOSED_GREY`."""
    means = np.maximum(grey[:, face].mean(axis=1), 1.0)
    return grey * (EXPOSED_GREY / means)[:, None, None].astype(np.float32)


def appearance(
    grey: NDArray[np.float32],
    shown: NDArray[np.float32],
    area: NDArray[np.bool_],
    start: NDArray[np.float32] | None = None,
) -> Appearance:
    """The subspace of photographs `grey` (N, H, W), exposed alike, over the pixels of `area` (H, W); `shown` (N, H, W) in [0, 1] is how
    well each pixel is shown, `start` the weights to begin with.

    Iteratively reweighted: each photograph's light is told by the pixels that are believed, and those that are not are replaced by
    what the subspace has there before it is fitted again.
    """
    seen = grey[:, area]
    weights = (shown if start is None else start)[:, area]
    filled = seen.copy()
    projected = grey.copy()
    whole = weights
    for rank, sigma in FITTING_ROUNDS:
        low = _low_rank(filled, seen, weights, rank)
        projected[:, area] = low
        whole = _believed(grey - projected, sigma) * shown
        weights = whole[:, area]
        filled = weights * seen + (1 - weights) * low
    return Appearance(grey, projected, np.asarray(whole, np.float32))


def _low_rank(
    filled: NDArray[np.float32], seen: NDArray[np.float32], weights: NDArray[np.float32], rank: int
) -> NDArray[np.float32]:
    """(N, P) rows of the `rank` dimensions that rows `filled` (N, P) span best, each nearest to its row of `seen` where `weights` (N, P)
    believe it."""
    basis = _common(np.linalg.eigh((filled @ filled.T).astype(np.float64))[1], rank).astype(np.float32).T @ filled
    basis /= np.linalg.norm(basis, axis=1, keepdims=True)
    products = (basis[:, None] * basis[None]).reshape(rank * rank, -1)
    normal = (weights @ products.T).reshape(-1, rank, rank).astype(np.float64)
    normal += MIN_SUBSPACE_BELIEF * np.eye(rank)
    wanted = (weights * seen) @ basis.T + MIN_SUBSPACE_BELIEF * (filled @ basis.T)
    return np.asarray(np.linalg.solve(normal, wanted[..., None].astype(np.float64))[..., 0], np.float32) @ basis


def _common(vectors: NDArray[np.float64], rank: int) -> NDArray[np.float64]:
    """(N, rank) those of the eigenvectors (N, N), the largest eigenvalue's last, that lie in several photographs: what one alone has is not
    light on the common face but what covers it. The number of photographs is the inverse participation ratio."""
    many = np.flatnonzero(1 / (vectors**4).sum(axis=0) >= min(MIN_PHOTOS_OF_DIMENSION, len(vectors)) - 1e-6)
    return vectors[:, many[-rank:]] if len(many) >= rank else vectors[:, -rank:]


def _believed(residual: NDArray[np.float32], sigma: float) -> NDArray[np.float32]:
    unit = residual.shape[2] / REFERENCE_WIDTH_PIXELS
    out = np.empty_like(residual)
    for one, weight in zip(residual, out, strict=True):
        off = cv2.GaussianBlur(np.abs(cv2.GaussianBlur(one, (0, 0), FINE_SIGMA * unit)), (0, 0), COARSE_SIGMA * unit)
        weight[:] = 1 / (1 + (np.asarray(off) / sigma) ** 4)
    return out
