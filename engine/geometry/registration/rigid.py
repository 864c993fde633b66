"""Fits of points to points: similarities and rigid motions of the plane and of space, plain and robust."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

CONVEX_PENALTY_SCALE = 2.0
"""Squares of the largest residual, in those of `sigma`, with which the robust penalty begins: convex over all residuals."""
PENALTY_SHARPENING = 1.4
"""By what the penalty comes nearer to Geman and McClure's in each round (the paper's value)."""


@dataclass(frozen=True)
class Similarity:
    """A turn with scale and a shift, q = linear @ p + shift, in D dimensions: `linear` (D, D), `shift` (D,)."""

    linear: NDArray[np.float64]
    shift: NDArray[np.float64]

    def __call__(self, points: NDArray[np.floating]) -> NDArray[np.float64]:
        """Positions (..., D) carried over."""
        return np.asarray(points @ self.linear.T + self.shift)

    def offsets(self, offsets: NDArray[np.floating]) -> NDArray[np.float64]:
        """Offsets (..., D) carried over: only the linear part acts on them."""
        return np.asarray(offsets @ self.linear.T)

    @property
    def scale(self) -> float:
        """Lengths of the destination for one of the source."""
        return float(np.hypot.reduce(self.linear[:, 0]))

    @property
    def rotation(self) -> NDArray[np.float64]:
        """(D, D) the turn without the scale."""
        return np.asarray(self.linear / self.scale)

    def inverse(self) -> Similarity:
        """The transformation back."""
        linear = np.linalg.inv(self.linear)
        return Similarity(np.asarray(linear, np.float64), np.asarray(-linear @ self.shift, np.float64))

    def matrix(self) -> NDArray[np.float64]:
        """(D, D + 1), as OpenCV's affine functions take it."""
        return np.hstack([self.linear, self.shift[:, None]])


@dataclass(frozen=True)
class RobustFit:
    """A fit from which outliers were kept: the `transform`, and `weights` (N,) in [0, 1] with which points counted in the
    end, near zero for outliers."""

    transform: Similarity
    weights: NDArray[np.float64]


def fit_similarity(
    source: NDArray[np.floating], destination: NDArray[np.floating], weights: NDArray[np.floating] | None = None
) -> Similarity:
    """The similarity that carries (N, D) `source` to `destination`, D = 2 or 3, with the least squared error; never a
    reflection. `weights` (N,) not below zero, by default all alike."""
    if weights is not None or source.shape[1] != 2:
        weights = np.ones(len(source)) if weights is None else weights
        scale, rotation, shift = fit_similarities(source, destination[None], weights)
        return Similarity(scale[0] * rotation[0], shift[0])
    a, b = source - source.mean(axis=0), destination - destination.mean(axis=0)
    norm = float((a**2).sum())
    cosine = float((a * b).sum()) / norm
    sine = float((a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]).sum()) / norm
    linear = np.array([[cosine, -sine], [sine, cosine]])
    shift = destination.mean(axis=0) - linear @ source.mean(axis=0)
    return Similarity(linear, np.asarray(shift, np.float64))


def fit_similarities(
    source: NDArray[np.floating], destinations: NDArray[np.floating], weights: NDArray[np.floating]
) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
    """Weighted similarities for many destinations at once, in D = 2 or 3 dimensions.

    Source: S. Umeyama, Least-squares estimation of transformation parameters between two point patterns, PAMI 1991.

    Parameters
    ----------
    source : (V, D). destinations : (N, V, D). weights : (V,) not below zero.

    Returns
    -------
    scale (N,), rotation (N, D, D), shift (N, D): destination = scale * rotation @ source + shift.
    """
    rotation, spread, source_mean, destination_mean, power = _turned(source, destinations, weights)
    scale = spread / power
    return scale, rotation, destination_mean - scale[:, None] * (rotation @ source_mean)


def fit_rigid(
    source: NDArray[np.floating], destination: NDArray[np.floating], weights: NDArray[np.floating] | None = None
) -> Similarity:
    """As `fit_similarity`, but the scale stays 1: a turn and a shift alone.

    Source: W. Kabsch, A solution for the best rotation to relate two sets of vectors, Acta Cryst. A 32, 1976; its
    reflections are avoided as Umeyama does.
    """
    weights = np.ones(len(source)) if weights is None else weights
    rotation, _, source_mean, destination_mean, _ = _turned(source, destination[None], weights)
    return Similarity(rotation[0], destination_mean[0] - rotation[0] @ source_mean)


def fit_robustly(
    source: NDArray[np.floating],
    destination: NDArray[np.floating],
    sigma: float,
    fit: Callable[[NDArray[np.floating], NDArray[np.floating], NDArray[np.floating]], Similarity] = fit_similarity,
) -> RobustFit:
    """A fit that outliers do not pull: Geman and McClure's penalty, reached from a convex one, so that no first guess is
    needed and the same points always give the same fit. It bears that half of the points are anywhere.

    Source: H. Yang, P. Antonante, V. Tzoumas, L. Carlone, Graduated Non-Convexity for Robust Spatial Perception, RA-L 2020
    (algorithm 1, with the weights of its equation 12).

    Parameters
    ----------
    source, destination : (N, D), D = 2 or 3.
    sigma : how far a good point may be off at most, in the destination's unit.
    fit : `fit_similarity` or `fit_rigid`.
    """
    weights = np.ones(len(source))
    transform = fit(source, destination, weights)
    squared = _squared(transform, source, destination)
    convexity = max(CONVEX_PENALTY_SCALE * float(squared.max()) / sigma**2, 1.0)
    while True:
        weights = (convexity / (squared / sigma**2 + convexity)) ** 2
        transform = fit(source, destination, weights)
        squared = _squared(transform, source, destination)
        if convexity == 1:
            return RobustFit(transform, weights)
        convexity = max(convexity / PENALTY_SHARPENING, 1.0)


def _squared(
    transform: Similarity, source: NDArray[np.floating], destination: NDArray[np.floating]
) -> NDArray[np.float64]:
    return np.asarray(((transform(source) - destination) ** 2).sum(axis=1))


def _turned(
    source: NDArray[np.floating], destinations: NDArray[np.floating], weights: NDArray[np.floating]
) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64], NDArray[np.float64], float]:
    """Best rotations (N, D, D), the spread of destinations along them (N,), the means, and the spread of the source."""
    w = weights / weights.sum()
    source_mean, destination_mean = w @ source, np.einsum("v,nvi->ni", w, destinations)
    a, b = source - source_mean, destinations - destination_mean[:, None]
    covariance = np.einsum("v,nvi,vj->nij", w, b, a)
    u, s, vt = np.linalg.svd(covariance)
    sign = np.ones((len(destinations), source.shape[1]))
    sign[:, -1] = np.sign(np.linalg.det(u @ vt))
    rotation = (u * sign[:, None]) @ vt
    return rotation, (s * sign).sum(axis=1), source_mean, destination_mean, float(w @ (a**2).sum(axis=1))
