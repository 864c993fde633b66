"""Where a landmark is in space that several cameras see, some of them wrongly.

Pairs of views propose places, the one most views agree with begins, and iteratively reweighted least squares of the
distances to the lines of sight end: M. A. Fischler, R. C. Bolles, Random sample consensus, CACM 24, 1981; P. J. Huber, Robust
Statistics, 1981, with the weights of Geman and McClure.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from engine.geometry.camera import Camera

MAX_VIEW_PAIRS = 60
"""Pairs of views that propose a place."""
MAX_PAIR_COSINE = 0.97
"""Between the lines of sight of a pair: nearly parallel ones do not say how far away a landmark is."""
TRIANGULATION_ROUNDS = 15
"""Rounds of least squares."""
INLIER_SIGMAS = 2.0
"""Deviations within which a view agrees."""


@dataclass(frozen=True)
class Triangulated:
    """place : (3,) metres.
    agreeing : how many views do.
    residual : their root mean square distance in pixels.
    """

    place: NDArray[np.float64]
    agreeing: int
    residual: float


def triangulate_robustly(
    cameras: Sequence[Camera],
    pixels: NDArray[np.floating],
    confidence: NDArray[np.floating],
    sigma: NDArray[np.floating],
) -> Triangulated | None:
    """The landmark seen by each of N `cameras` at `pixels` (N, 2), with `confidence` (N,) in [0, 1]; pixels are off by `sigma`
    (N,), usually. None where fewer than two views agree."""
    eyes = np.array([camera.eye for camera in cameras])
    sight = np.stack([camera.rays(at[None])[0] for camera, at in zip(cameras, pixels, strict=True)])
    sight /= np.linalg.norm(sight, axis=1, keepdims=True)
    across = np.eye(3) - sight[:, :, None] * sight[:, None, :]

    def nearest(weights: NDArray[np.float64]) -> NDArray[np.float64]:
        weighed = weights[:, None, None] * across
        return np.linalg.solve(weighed.sum(0), np.einsum("nab,nb->a", weighed, eyes))

    def off(place: NDArray[np.float64]) -> NDArray[np.float64]:
        found = np.stack([camera.project(place, np.float64, 0.01)[:2] for camera in cameras])
        return np.linalg.norm(found - pixels, axis=1) / sigma

    best: tuple[float, NDArray[np.float64]] | None = None
    for pair in _pairs(sight):
        place = nearest(np.isin(np.arange(len(eyes)), pair).astype(np.float64))
        score = float((confidence / (1 + off(place) ** 2)).sum())
        if best is None or score > best[0]:
            best = score, place
    if best is None:
        return None
    place = best[1]
    for _ in range(TRIANGULATION_ROUNDS):
        weights = confidence / (1 + off(place) ** 2) ** 2 / np.maximum(np.linalg.norm(eyes - place, axis=1), 0.01) ** 2
        place = nearest(weights)
    residuals = off(place)
    agreeing = residuals < INLIER_SIGMAS
    if agreeing.sum() < 2:
        return None
    rms = float(np.sqrt(((residuals * sigma)[agreeing] ** 2).mean()))
    return Triangulated(place, int(agreeing.sum()), rms)


def _pairs(sight: NDArray[np.float64]) -> list[tuple[int, int]]:
    """Pairs of views that look along different lines: all of them, or as many as are tried."""
    cosines = np.abs(sight @ sight.T)
    first, second = np.nonzero(np.triu(cosines < MAX_PAIR_COSINE, 1))
    chosen = np.random.default_rng(0).permutation(len(first))[:MAX_VIEW_PAIRS]
    return [(int(first[k]), int(second[k])) for k in chosen]
