"""What does not belong to a measured surface is taken out of a cloud: lone points and pieces that hang apart."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage
from scipy.spatial import cKDTree

from engine.geometry.point_clouds.point_cloud import PointCloud


def crowded(cloud: PointCloud, radius: float, neighbours: int) -> NDArray[np.bool_]:
    """(N,) which points have so many others within `radius` metres."""
    return crowded_points(cloud.points, radius, neighbours)


def crowded_points(points: NDArray[np.floating], radius: float, neighbours: int) -> NDArray[np.bool_]:
    """(N,) which of `points` (N, 3) have so many others within `radius`."""
    if len(points) <= neighbours:
        return np.zeros(len(points), bool)
    distance, _ = cKDTree(points).query(points, [neighbours + 1], distance_upper_bound=radius)
    return np.isfinite(np.asarray(distance)[:, 0])


def in_large_pieces(cloud: PointCloud, gap: float, share: float) -> NDArray[np.bool_]:
    """(N,) which points are in pieces of at least `share` of the largest one's points. Pieces are apart where an empty cell of
    `gap` metres lies between them."""
    if not len(cloud):
        return np.zeros(0, bool)
    cells = np.floor((cloud.points - cloud.points.min(axis=0)) / gap).astype(int)
    grid = np.zeros(cells.max(axis=0) + 1, bool)
    grid[tuple(cells.T)] = True
    pieces, _ = ndimage.label(grid, np.ones((3, 3, 3)))
    piece = pieces[tuple(cells.T)]
    counts = np.bincount(piece)
    return np.asarray(counts[piece] >= share * counts.max())


def smoothed_along_normals(cloud: PointCloud, radius: float) -> PointCloud:
    """Each point moved along its normal to the plane of its neighbours, weighted by a Gaussian that ends at `radius` metres;
    normals become their neighbours' means. Neighbours that face elsewhere do not count.

    Source: M. Alexa et al., Computing and Rendering Point Set Surfaces, TVCG 2003, one step.
    """
    neighbours = 24
    distance, nearest = cKDTree(cloud.points).query(
        cloud.points, min(neighbours, len(cloud)), distance_upper_bound=radius
    )
    inside = np.isfinite(distance)
    nearest = np.where(inside, nearest, 0)
    facing = np.einsum("nki,ni->nk", cloud.normals[nearest], cloud.normals)
    weights = np.where(inside & (facing > 0.5), np.exp(-((2 * np.where(inside, distance, 0) / radius) ** 2)), 0)
    total = weights.sum(axis=1, keepdims=True)
    normals = np.einsum("nk,nki->ni", weights, cloud.normals[nearest])
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    mean = np.einsum("nk,nki->ni", weights / total, cloud.points[nearest])
    height = ((mean - cloud.points) * normals).sum(axis=1, keepdims=True)
    return PointCloud((cloud.points + normals * height).astype(np.float32), normals.astype(np.float32), cloud.colours)
