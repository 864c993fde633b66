"""Delaunay triangles over points of the plane."""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

WORKING_EXTENT = 1000.0
"""Units to which the larger side of the points is brought first: OpenCV's subdivision counts in single precision."""
SUBDIVISION_HALF_SIDE = 20_000
"""Half the side, in the same units, of the plane that OpenCV divides, far larger than the points. It begins with a
triangle around that plane. What is thinner than a triangle that reaches its corners would be missing along the hull."""


def delaunay(points: NDArray[np.floating]) -> NDArray[np.int32]:
    """(T, 3) the triangles over points (V, 2), all with the same orientation: y down, clockwise as seen.

    Of points in the same place only one has triangles.
    """
    flat = np.asarray(points, float)
    size = float(np.ptp(flat, axis=0).max()) or 1.0
    placed = ((flat - flat.min(axis=0)) * (WORKING_EXTENT / size)).astype(np.float32)
    plane = cv2.Subdiv2D(
        (-SUBDIVISION_HALF_SIDE, -SUBDIVISION_HALF_SIDE, 2 * SUBDIVISION_HALF_SIDE, 2 * SUBDIVISION_HALF_SIDE)
    )
    for point in placed.tolist():
        plane.insert(point)
    corners = _as_one(np.reshape(np.asarray(plane.getTriangleList(), np.float32), (-1, 2)))
    order = np.argsort(_as_one(placed), kind="stable")
    return np.asarray(order[np.searchsorted(_as_one(placed)[order], corners)].reshape(-1, 3), np.int32)


def _as_one(points: NDArray[np.float32]) -> NDArray[np.complex64]:
    """(N,) each point (N, 2) as one number that can be sorted and looked up; 0 and -0 are the same."""
    return np.ascontiguousarray(points + np.float32(0)).view(np.complex64).ravel()
