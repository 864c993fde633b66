"""How much of a body its cloud shows, part by part."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from engine.geometry.point_clouds.point_cloud import PointCloud

COVERAGE_RADIUS_METRES = 0.005
"""Metres from a vertex within which a point shows it."""


def coverage(
    vertices: NDArray[np.floating],
    parts: Mapping[str, NDArray[np.bool_] | NDArray[np.integer]],
    cloud: PointCloud,
    near: float = COVERAGE_RADIUS_METRES,
) -> dict[str, float]:
    """For each part, vertices chosen by a mask (V,) or by their numbers, the share that has a point of the cloud within `near`.

    `vertices` (V, 3) metres are of a mesh that lies where the cloud does. Where it lies off, it counts as not covered:
    so ask with the mesh that was fitted to the cloud, not before. A part without vertices has none covered.
    """
    if len(cloud):
        distance, _ = cKDTree(cloud.points).query(vertices, distance_upper_bound=near)
        covered = np.isfinite(distance)
    else:
        covered = np.zeros(len(vertices), bool)
    return {name: float(covered[chosen].mean()) if len(covered[chosen]) else 0.0 for name, chosen in parts.items()}
