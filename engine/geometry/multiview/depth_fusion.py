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
from engine.geometry.multiview.patch_match_stereo import DepthMap
from engine.geometry.point_clouds.point_cloud import PointCloud

FUSION_ROUNDS = 2
"""How often the views are asked about a point: the second time where the first has moved it."""
MIN_AGREEING_NORMAL_COSINE = 0.5
"""Least cosine between normals that agree: 60 degrees."""


@dataclass(frozen=True)
class Agreement:
    """What makes a point of a view trusted.

    distance : metres from the median of what views say within which one agrees.
    seen_through : metres by which another's depth lies behind a point that it denies, and up to which it has a say in the median.
    views : how many must agree, the point's own among them.
    cost : the greatest at which a measurement counts at all (`DepthMap.cost`). In plain dark cloth, what correlates less with other views is
        as wrong as it is much.
    """

    distance: float = 0.008
    seen_through: float = 0.025
    views: int = 3
    cost: float = 0.7


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
    step: int = 1,
) -> FusedPoints:
    """Points on which views agree, each moved along its normal to the median of what they say.

    Parameters
    ----------
    maps, cameras, images : of all views, of one size (H, W), images (H, W, 3) sRGB; cameras without distortion.
    neighbours : for each view the numbers of those that are asked about its points.
    step : of the views' rows and of their columns one in so many gives points.

    A place that many views confirm is given once by each of them: `thinned` leaves one.
    """
    depths = np.stack([np.where(m.cost <= agreement.cost, m.depth, 0) for m in maps])
    normals = np.stack([m.normals for m in maps])
    pixels = np.stack(list(images))
    projections = np.stack([camera.projection for camera in cameras])
    limits = np.array([agreement.distance, agreement.seen_through])
    points, directions, colours, support, view = [], [], [], [], []
    for number, (camera, asked) in enumerate(zip(cameras, neighbours, strict=True)):
        y, x = step * np.array(np.nonzero(depths[number, ::step, ::step]))
        found = camera.unproject(np.stack([x, y], axis=-1).astype(np.float64), depths[number, y, x])
        normal = normals[number, y, x]
        median, agreeing = _confirmed(found, normal, depths, normals, projections, np.array(asked, np.int64), limits)
        kept = agreeing >= agreement.views
        points.append(median[kept])
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
    """Points (N, 3) at the median of what views say, and how many agree (N,), 0 where more look through the point."""
    median, agreeing = np.empty_like(points), np.empty(len(points), np.int64)
    for n in prange(len(points)):
        heights, ordered = np.empty(len(asked) + 1), np.empty(len(asked) + 1)
        for k in range(3):
            median[n, k] = points[n, k]
        moved = 0.0  # along the normal, from where the point's own view has it
        for _ in range(FUSION_ROUNDS):
            count, denied = np.int64(1), 0
            heights[0] = -moved
            for view in asked:
                seen, height = _height(median[n], directions[n], depths[view], normals[view], projections[view], limits)
                if seen > 0:
                    heights[count] = height
                    count += 1
                elif seen < 0:
                    denied += 1
            shift = _median(heights, count, ordered)
            moved += shift
            for k in range(3):
                median[n, k] += directions[n, k] * shift
        agreed = 0
        for k in range(count):
            agreed += abs(heights[k] - shift) <= limits[0]
        agreeing[n] = agreed
        if denied >= agreeing[n]:
            agreeing[n] = 0
    return median, agreeing


@njit(boundscheck=False, error_model="numpy")
def _median(values: np.ndarray, count: int, ordered: np.ndarray) -> float:
    """Of the first `count` of a few values, which `ordered` takes in their order."""
    for k in range(count):
        place = k
        while place > 0 and ordered[place - 1] > values[k]:
            ordered[place] = ordered[place - 1]
            place -= 1
        ordered[place] = values[k]
    return 0.5 * (ordered[(count - 1) // 2] + ordered[count // 2])


@njit(boundscheck=False, error_model="numpy")
def _height(
    point: np.ndarray,
    normal: np.ndarray,
    depths: np.ndarray,
    normals: np.ndarray,
    projection: np.ndarray,
    limits: np.ndarray,
) -> tuple[int, float]:
    """Whether a view tells of a point, and how far along the normal the surface lies of which it tells. It is 1 if it
    has a surface near it, -1 if it looks through it, else 0."""
    x, y, z = point
    p = projection
    away = p[2, 0] * x + p[2, 1] * y + p[2, 2] * z + p[2, 3]
    if away <= 0:
        return 0, 0.0
    u = int(np.floor((p[0, 0] * x + p[0, 1] * y + p[0, 2] * z + p[0, 3]) / away + 0.5))
    v = int(np.floor((p[1, 0] * x + p[1, 1] * y + p[1, 2] * z + p[1, 3]) / away + 0.5))
    if not (0 <= u < depths.shape[1] and 0 <= v < depths.shape[0]) or depths[v, u] == 0:
        return 0, 0.0
    further = depths[v, u] - away
    if further > limits[1]:
        return -1, 0.0
    other = normals[v, u]
    if (
        further < -limits[1]
        or normal[0] * other[0] + normal[1] * other[1] + normal[2] * other[2] < MIN_AGREEING_NORMAL_COSINE
    ):
        return 0, 0.0
    # the surface is so much further off along the view's line of sight; along the normal it is less
    return 1, further * (normal[0] * p[2, 0] + normal[1] * p[2, 1] + normal[2] * p[2, 2])
