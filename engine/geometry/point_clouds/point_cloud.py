"""Points measured on a surface."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from engine.geometry.registration.rigid import Similarity


@dataclass(frozen=True)
class PointCloud:
    """Points of a surface, each with its normal and its colour.

    points : (N, 3) float32, metres.
    normals : (N, 3) float32, unit vectors, out of the body.
    colours : (N, 3) uint8, sRGB.
    """

    points: NDArray[np.float32]
    normals: NDArray[np.float32]
    colours: NDArray[np.uint8]

    def __post_init__(self) -> None:
        shapes = {self.points.shape, self.normals.shape, self.colours.shape}
        if shapes != {(len(self.points), 3)}:
            raise ValueError(f"a cloud has as many points as normals and colours, of three numbers each, not {shapes}")

    def __len__(self) -> int:
        return len(self.points)

    def __getitem__(self, chosen: NDArray[np.integer] | NDArray[np.bool_] | slice) -> PointCloud:
        """The points that an index array, a mask (N,) or a slice chooses."""
        return PointCloud(self.points[chosen], self.normals[chosen], self.colours[chosen])

    def moved(self, change: Similarity) -> PointCloud:
        """These points carried into another world."""
        normals = self.normals @ change.rotation.T
        return PointCloud(change(self.points).astype(np.float32), normals.astype(np.float32), self.colours)


def joined(clouds: Sequence[PointCloud]) -> PointCloud:
    """One cloud of all, in their order; raises ValueError where there are none."""
    return PointCloud(
        np.concatenate([cloud.points for cloud in clouds]),
        np.concatenate([cloud.normals for cloud in clouds]),
        np.concatenate([cloud.colours for cloud in clouds]),
    )


def thinned(cloud: PointCloud, spacing: float) -> PointCloud:
    """At most one point in each cell of a grid with cells of `spacing` metres: the one nearest to the cell's mean."""
    return cloud[thinning(cloud.points, spacing)]


def thinning(points: NDArray[np.floating], spacing: float) -> NDArray[np.intp]:
    """Which of the points (N, 3), in their order, stay when one is left in each cell: those that `thinned` leaves."""
    if not len(points):
        return np.zeros(0, np.intp)
    cells = np.floor(points / spacing).astype(np.int64)
    cells -= cells.min(axis=0)
    wide = cells.max(axis=0) + 1
    _, cell, counts = np.unique(
        (cells[:, 0] * wide[1] + cells[:, 1]) * wide[2] + cells[:, 2], return_inverse=True, return_counts=True
    )
    sums = np.stack([np.bincount(cell, points[:, axis], len(counts)) for axis in range(3)], axis=1)
    distance = np.linalg.norm(points - (sums / counts[:, None])[cell], axis=1)
    order = np.lexsort((distance, cell))
    first = np.r_[True, np.diff(cell[order]) > 0]
    return np.sort(order[first])
