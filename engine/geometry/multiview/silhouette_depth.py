"""How far within all silhouettes a point of space is: the visual hull as a field that has a sign, not as voxels.

A view says of a point how many metres it could move across the line of sight until it left the silhouette, or, with a minus,
until it came into it. What most views agree on is a low quantile of these: the least would believe each mask's every fault.
The hull is that of A. Laurentini, The Visual Hull Concept for Silhouette-Based Image Understanding, PAMI 1994.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import cv2
import numpy as np
from numba import prange
from numpy.typing import NDArray

from engine.compiled import njit
from engine.geometry.camera import Camera


@dataclass(frozen=True)
class Beside:
    """The `silhouettes`, (H, W) bool for each view, of what is known to be there: a view says nothing of points within it, or by less
    than `distance` metres beside it, across the line of sight."""

    silhouettes: Sequence[NDArray[np.bool_]]
    distance: float


def silhouette_depths(
    points: NDArray[np.floating],
    silhouettes: Sequence[NDArray[np.bool_]],
    cameras: Sequence[Camera],
    wrong: float,
    beside: Beside | None = None,
) -> tuple[NDArray[np.float32], NDArray[np.uint16]]:
    """(N,) float32 metres by which `points` (N, 3) lie within the silhouettes, negative outside, +inf where no view has anything
    to say of them; and (N,) how many views have.

    Parameters
    ----------
    silhouettes : (H, W) each, of its camera's size. Beyond its border a picture says nothing.
    wrong : share of the views that see a point and may be wrong about it, in [0, 1).
    beside : what is known to be there; by default nothing.
    """
    kept = int(wrong * len(cameras)) + 1
    least = np.full((len(points), kept), np.inf, np.float32)
    seen = np.zeros(len(points), np.uint16)
    for number, (silhouette, camera) in enumerate(zip(silhouettes, cameras, strict=True)):
        apart = np.full(silhouette.shape, np.inf, np.float32)
        distance = np.float32(0)
        if beside is not None:
            apart, distance = -_signed_distance(beside.silhouettes[number]), np.float32(beside.distance)
        at = camera.project(points)
        _keep_least(at, _signed_distance(silhouette), apart, distance, np.float32(camera.focal), least, seen)
    rank = np.minimum((wrong * seen).astype(np.intp), kept - 1)
    return np.take_along_axis(least, rank[:, None], 1)[:, 0], seen


def _signed_distance(silhouette: NDArray[np.bool_]) -> NDArray[np.float32]:
    """(H, W) pixels to the border of the silhouette, positive within it."""
    inside = silhouette.astype(np.uint8)
    # the border lies half a pixel before the first pixel beyond it
    within = cv2.distanceTransform(inside, cv2.DIST_L2, cv2.DIST_MASK_PRECISE) - 0.5 * inside
    beyond = cv2.distanceTransform(1 - inside, cv2.DIST_L2, cv2.DIST_MASK_PRECISE) - 0.5 * (1 - inside)
    return np.asarray(within - beyond, np.float32)


@njit(parallel=True, nogil=True, boundscheck=False, error_model="numpy")
def _keep_least(
    at: np.ndarray,
    distance: np.ndarray,
    apart: np.ndarray,
    least_apart: float,
    focal: float,
    least: np.ndarray,
    seen: np.ndarray,
) -> None:
    """Put what one view says of each point among the least that any has said, which stand in order."""
    height, width = distance.shape
    for n in prange(len(at)):
        away = at[n, 2]
        if away <= 0:
            continue
        u, v = int(np.floor(at[n, 0] + 0.5)), int(np.floor(at[n, 1] + 0.5))
        if not (0 <= u < width and 0 <= v < height):
            continue
        if apart[v, u] * away < least_apart * focal:
            continue
        seen[n] += 1
        said = distance[v, u] * away / focal
        for k in range(least.shape[1]):
            if said < least[n, k]:
                said, least[n, k] = least[n, k], said
