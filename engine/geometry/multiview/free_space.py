"""What views look through: a surface that is seen in a view leaves nothing before it.

The depth that a view would have measured is that of the nearest points of the fused cloud that face it, each as a small disc; places
before it are free. That is the visibility of P. Merrell et al., Real-Time Visibility-Based Fusion of Depth Maps, ICCV 2007, asked of
places instead of points.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numba import prange
from numpy.typing import NDArray

from engine.compiled import njit
from engine.geometry.camera import Camera

MIN_FACING_COSINE = 0.15
"""Least cosine between a point's normal and the way to the camera at which the point hides what is behind it."""
MAX_SPLAT_PIXELS = 8
"""Pixels, at most, of the radius of the disc that a point hides."""


@dataclass(frozen=True)
class SeenSurfaces:
    """What views see.

    cameras : theirs.
    depths : (H, W) float32 for each, metres along the view axis, +inf where nothing is known.
    """

    cameras: Sequence[Camera]
    depths: Sequence[NDArray[np.float32]]

    def votes(self, places: NDArray[np.floating], before: float) -> NDArray[np.int32]:
        """How many views look through each of the `places` (N, 3), and how many see something there, (N, 2). Those look through it
        that see something `before` metres and more behind it. A view from which it is hidden by more says nothing."""
        votes = np.zeros((len(places), 2), np.int32)
        for camera, depths in zip(self.cameras, self.depths, strict=True):
            _vote(camera.project(places), depths, before, votes)
        return votes


def seen_depths(
    points: NDArray[np.floating], normals: NDArray[np.floating], camera: Camera, radius: float
) -> NDArray[np.float32]:
    """(H, W) the depth of the nearest of the `points` (N, 3), whose `normals` (N, 3) point out of the body, that face the camera; each a
    disc with a `radius` in metres."""
    to_camera = np.asarray(camera.eye) - points
    far = np.linalg.norm(to_camera, axis=1)
    facing = np.einsum("nd,nd->n", to_camera, normals) > MIN_FACING_COSINE * far
    return np.asarray(_splat(camera.project(points[facing]), camera.size[0], camera.size[1], radius * camera.focal))


@njit(boundscheck=False, error_model="numpy")
def _splat(at: np.ndarray, height: int, width: int, reach: float) -> np.ndarray:
    depths = np.full((height, width), np.inf, np.float32)
    for n in range(len(at)):
        away = at[n, 2]
        if not away > 0:
            continue
        r = min(reach / away, MAX_SPLAT_PIXELS)
        top, bottom = max(int(np.ceil(at[n, 1] - r)), 0), min(int(np.floor(at[n, 1] + r)), height - 1)
        left, right = max(int(np.ceil(at[n, 0] - r)), 0), min(int(np.floor(at[n, 0] + r)), width - 1)
        for v in range(top, bottom + 1):
            for u in range(left, right + 1):
                if (u - at[n, 0]) ** 2 + (v - at[n, 1]) ** 2 <= r * r and away < depths[v, u]:
                    depths[v, u] = away
    return depths


@njit(parallel=True, boundscheck=False, error_model="numpy")
def _vote(at: np.ndarray, depths: np.ndarray, before: float, votes: np.ndarray) -> None:
    for n in prange(len(at)):
        away = at[n, 2]
        if not away > 0:
            continue
        u, v = int(np.floor(at[n, 0] + 0.5)), int(np.floor(at[n, 1] + 0.5))
        if not (0 <= u < depths.shape[1] and 0 <= v < depths.shape[0]) or depths[v, u] == np.inf:
            continue
        ahead = depths[v, u] - away
        if ahead > before:
            votes[n, 0] += 1
        elif ahead > -before:
            votes[n, 1] += 1
