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
    feet = np.einsum("nab,nb->na", across, eyes)  # of the lines' normals from the origin

    def nearest(weights: NDArray[np.float64]) -> NDArray[np.float64]:
        """(P, 3) the places nearest to the lines of sight, each with weights of its own, (P, N)."""
        return np.asarray(np.linalg.solve(np.tensordot(weights, across, 1), (weights @ feet)[..., None])[..., 0])

    def off(places: NDArray[np.float64]) -> NDArray[np.float64]:
        """(P, N) the deviations of places (P, 3)."""
        found = np.stack([camera.project(places, np.float64, 0.01)[:, :2] for camera in cameras], 1)
        return np.asarray(np.linalg.norm(found - pixels, axis=-1) / sigma)

    pairs = _pairs(sight)
    if not len(pairs):
        return None
    proposed = nearest((pairs[..., None] == np.arange(len(eyes))).any(1).astype(np.float64))
    score = (confidence / (1 + off(proposed) ** 2)).sum(1)
    place = proposed[[score.argmax()]]
    for _ in range(TRIANGULATION_ROUNDS):
        away = np.linalg.norm(eyes - place[:, None], axis=-1)
        place = nearest(confidence / (1 + off(place) ** 2) ** 2 / np.maximum(away, 0.01) ** 2)
    residuals = off(place)[0]
    agreeing = residuals < INLIER_SIGMAS
    if agreeing.sum() < 2:
        return None
    rms = float(np.sqrt(((residuals * sigma)[agreeing] ** 2).mean()))
    return Triangulated(place[0], int(agreeing.sum()), rms)


def _pairs(sight: NDArray[np.float64]) -> NDArray[np.intp]:
    """(P, 2) pairs of views that look along different lines: all of them, or as many as are tried."""
    cosines = np.abs(sight @ sight.T)
    different = np.argwhere(np.triu(cosines < MAX_PAIR_COSINE, 1))
    return different[np.random.default_rng(0).permutation(len(different))[:MAX_VIEW_PAIRS]]
