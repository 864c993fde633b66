"""A sheet through points that scatter about it, whichever side of it each was measured on: thin things, brims and tails of coats.

Points move onto planes through those around them, round by round. The distance of a place from the sheet is then what
the planes of the nearest points say. It goes on a little beyond their border, as these planes do.

Source: D. Levin, Mesh-Independent Surface Interpolation, 2003 (moving least squares), with planes of principal components and no
normals asked for; the distance is that of R. Kolluri, Provably Good Moving Least Squares, SODA 2005, squared and so without a sign.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from engine.geometry.point_clouds.point_cloud import thinning

MAX_PLANE_POINTS = 160
"""Points of which a plane is made, at most."""
MIN_PLANE_POINTS, FEWEST_SHARE = 8, 0.35
"""Points without which there is no plane, and the share of the usual number without which there is none. At a border
there are half as many as elsewhere, and beside a sheet few."""
ASKED_POINT_COUNT = 12
"""Points of a sheet that are asked about a place."""
KERNEL_WIDTH_SPACINGS = 0.7
"""Width of the Gaussian by which points of a sheet are asked, in distances of the nearest of them, where that is more
than they are apart."""


@dataclass(frozen=True)
class PointSheet:
    """`points` (N, 3) on a sheet, `spacing` apart about, with unit `normals` (N, 3) to either side of it."""

    points: NDArray[np.float64]
    normals: NDArray[np.float64]
    spacing: float

    def distances(self, places: NDArray[np.floating]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """(M,) how far `places` (M, 3) are from the sheet, or from what it would be if it went on, and (M,) how far from its
        points along itself: about 0 where it is, growing beyond its border."""
        count = min(ASKED_POINT_COUNT, len(self.points))
        found = cKDTree(self.points).query(places, count)
        nearest, which = (np.reshape(one, (-1, count)) for one in found)
        width = np.maximum(KERNEL_WIDTH_SPACINGS * nearest[:, :1], self.spacing)
        weights = np.exp((nearest[:, :1] ** 2 - nearest**2) / width**2)
        offsets = np.asarray(places)[:, None] - self.points[which]
        squares = np.einsum("nkd,nkd->nk", offsets, self.normals[which]) ** 2
        across = (squares * weights).sum(1) / weights.sum(1)
        return np.sqrt(across), np.sqrt(np.maximum(nearest[:, 0] ** 2 - across, 0))


def sheet_through(points: NDArray[np.floating], radius: float, rounds: int, spacing: float) -> PointSheet:
    """The sheet through `points` (N, 3): each moves `rounds` times onto the plane of those within `radius`, weighted by a
    Gaussian that ends there. Those that have too few around them are left out, and of those that come to lie within `spacing` of
    each other one stays."""
    moved = np.asarray(points, np.float64)
    normals = np.zeros_like(moved)
    for _ in range(rounds):
        moved, normals = _on_planes(moved, radius)
        kept = thinning(moved, spacing)
        moved, normals = moved[kept], normals[kept]
    return PointSheet(moved, normals, spacing)


def _on_planes(points: NDArray[np.float64], radius: float) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Points moved onto the planes of those around them, and the planes' normals; lone ones left out."""
    count = min(MAX_PLANE_POINTS, len(points))
    if count < MIN_PLANE_POINTS:
        return points[:0], points[:0]
    found = cKDTree(points).query(points, count, distance_upper_bound=radius)
    distance, which = (np.asarray(one) for one in found)
    within = np.isfinite(distance)
    number = within.sum(1)
    crowd = number >= max(MIN_PLANE_POINTS, FEWEST_SHARE * float(np.median(number)))
    distance, which, within = distance[crowd], np.where(within, which, 0)[crowd], within[crowd]
    weights = np.where(within, np.exp(-((2 * np.where(within, distance, 0) / radius) ** 2)), 0)
    mean = np.einsum("nk,nkd->nd", weights, points[which]) / weights.sum(1)[:, None]
    off = points[which] - mean[:, None]
    normals = np.linalg.eigh(np.einsum("nk,nka,nkb->nab", weights, off, off))[1][:, :, 0]
    heights = np.einsum("nd,nd->n", points[crowd] - mean, normals)
    return points[crowd] - heights[:, None] * normals, normals
