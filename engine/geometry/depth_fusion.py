"""Depth maps of many views become one cloud: a point is kept where views agree about it, and none looks through it.

Source: J. L. Schönberger, E. Zheng, M. Pollefeys, J.-M. Frahm, Pixelwise View Selection for Unstructured Multi-View Stereo,
ECCV 2016, section 4.5 (consistency in depth and normal); points that others see through as P. Merrell et al., Real-Time
Visibility-Based Fusion of Depth Maps, ICCV 2007.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numba import prange
from numpy.typing import NDArray

from engine.compiled import njit
from engine.geometry.camera import Camera
from engine.geometry.patch_match_stereo import DepthMap
from engine.geometry.point_cloud import PointCloud

NORMALS_AGREE = 0.5
"""Least cosine between normals that agree: 60 degrees."""


@dataclass(frozen=True)
class Agreement:
    """What makes a point of a view trusted.

    `distance` metres along the view axis within which another view's depth agrees; `seen_through` metres by which another's
    depth lies behind a point that it denies; `views` how many must agree, the point's own among them; `cost` the greatest at
    which a measurement counts at all (`DepthMap.cost`).
    """

    distance: float = 0.008
    seen_through: float = 0.03
    views: int = 3
    cost: float = 0.9


@dataclass(frozen=True)
class FusedPoints:
    """The points of one view that others confirm, or of many: the `cloud`, how many views saw each (N,) uint8 `support`,
    and the number of the view (N,) int32 `view` whose pixel a point is."""

    cloud: PointCloud
    support: NDArray[np.uint8]
    view: NDArray[np.int32]


def fuse_depth_maps(
    maps: Sequence[DepthMap],
    cameras: Sequence[Camera],
    images: Sequence[NDArray[np.uint8]],
    neighbours: Sequence[Sequence[int]],
    agreement: Agreement,
) -> FusedPoints:
    """Points on which views agree, each moved along its normal to the mean of what they say.

    Parameters
    ----------
    maps, cameras, images : of all views, of one size (H, W), images (H, W, 3) sRGB; cameras without distortion.
    neighbours : for each view the numbers of those that are asked about its points.

    A place that many views confirm is given once by each of them: `thinned` leaves one.
    """
    depths = np.stack([np.where(m.cost <= agreement.cost, m.depth, 0) for m in maps])
    normals = np.stack([m.normals for m in maps])
    pixels = np.stack(list(images))
    projections = np.stack([camera.projection for camera in cameras])
    limits = np.array([agreement.distance, agreement.seen_through])
    points, directions, colours, support, view = [], [], [], [], []
    for number, (camera, asked) in enumerate(zip(cameras, neighbours, strict=True)):
        y, x = np.nonzero(depths[number])
        found = camera.unproject(np.stack([x, y], axis=-1).astype(np.float64), depths[number, y, x])
        normal = normals[number, y, x]
        mean, agreeing = _confirmed(found, normal, depths, normals, projections, np.array(asked, np.int64), limits)
        kept = agreeing >= agreement.views
        points.append(mean[kept])
        directions.append(normal[kept])
        colours.append(pixels[number, y[kept], x[kept]])
        support.append(np.minimum(agreeing[kept], 255))
        view.append(np.full(int(kept.sum()), number))
    cloud = PointCloud(np.concatenate(points).astype(np.float32), np.concatenate(directions), np.concatenate(colours))
    return FusedPoints(cloud, np.concatenate(support).astype(np.uint8), np.concatenate(view).astype(np.int32))


@njit(parallel=True, boundscheck=False, error_model="numpy")
def _confirmed(
    points: np.ndarray,
    directions: np.ndarray,
    depths: np.ndarray,
    normals: np.ndarray,
    projections: np.ndarray,
    asked: np.ndarray,
    limits: np.ndarray,
) -> tuple[np.ndarray, np.ndarray]:
    """Points (N, 3) at the mean of what views say, and how many agree (N,), 0 where more look through the point."""
    mean, agreeing = points.copy(), np.ones(len(points), np.int64)
    height, width = depths.shape[1:]
    for n in prange(len(points)):
        x, y, z = points[n]
        a, b, c = directions[n]
        shift, denied = 0.0, 0
        for view in asked:
            p = projections[view]
            away = p[2, 0] * x + p[2, 1] * y + p[2, 2] * z + p[2, 3]
            if away <= 0:
                continue
            u = int(np.floor((p[0, 0] * x + p[0, 1] * y + p[0, 2] * z + p[0, 3]) / away + 0.5))
            v = int(np.floor((p[1, 0] * x + p[1, 1] * y + p[1, 2] * z + p[1, 3]) / away + 0.5))
            if not (0 <= u < width and 0 <= v < height) or depths[view, v, u] == 0:
                continue
            further = depths[view, v, u] - away
            if further > limits[1]:
                denied += 1
            elif abs(further) <= limits[0]:
                other = normals[view, v, u]
                if a * other[0] + b * other[1] + c * other[2] >= NORMALS_AGREE:
                    agreeing[n] += 1
                    # along the view's line of sight the surface is so much further off; along the normal less
                    shift += further * (a * p[2, 0] + b * p[2, 1] + c * p[2, 2])
        if denied >= agreeing[n]:
            agreeing[n] = 0
        else:
            for k in range(3):
                mean[n, k] += directions[n, k] * shift / agreeing[n]
    return mean, agreeing
