"""A rigid motion that lays points on a cloud's surface: iterated closest points, from points to planes.

Source: Y. Chen, G. Medioni, Object Modelling by Registration of Multiple Range Images, Image and Vision Computing 1992;
distances beyond a few sigma count less, by Tukey's weights.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree
from scipy.spatial.transform import Rotation

from engine.geometry.registration.rigid import Similarity

CLOUD_ALIGNMENT_ROUNDS = 4
"""How often closest points are found anew."""
REST_WEIGHT = 1e-3
"""Weight of no motion beside the mean of the points': what they do not determine stays as it is."""


def align_to_surface(
    points: NDArray[np.floating],
    normals: NDArray[np.floating],
    surface: cKDTree,
    surface_normals: NDArray[np.floating],
    gate: float,
) -> Similarity:
    """The rigid motion of `points` (N, 3) with `normals` that lays them on the surface, a tree of M points, metres, with unit normals
    (M, 3).

    Points count that have a point of the surface within `gate` metres whose normal is within 60 degrees of theirs.
    """
    places: NDArray[np.float64] = surface.data
    rotation, shift = np.eye(3), np.zeros(3)
    centre = points.mean(axis=0)
    for _ in range(CLOUD_ALIGNMENT_ROUNDS):
        moved = points @ rotation.T + shift
        distance, nearest = (np.asarray(found) for found in surface.query(moved, distance_upper_bound=gate))
        near = np.flatnonzero(np.isfinite(distance))
        across = surface_normals[nearest[near]]
        near_enough = ((normals[near] @ rotation.T) * across).sum(axis=1) > 0.5
        near, across = near[near_enough], across[near_enough]
        if len(near) < 6:
            break
        residual = ((moved[near] - places[nearest[near]]) * across).sum(axis=1)
        weights = (1 - (residual / gate) ** 2) ** 2
        arm = moved[near] - centre
        slope = np.hstack([np.cross(arm, across), across])  # by turns about the centre, and by shifts
        normal_matrix = (slope * weights[:, None]).T @ slope
        normal_matrix += REST_WEIGHT * np.diag(
            np.repeat([np.trace(normal_matrix[:3, :3]), np.trace(normal_matrix[3:, 3:])], 3)
        )
        step = np.linalg.solve(normal_matrix, -(slope * weights[:, None]).T @ residual)
        turn = Rotation.from_rotvec(step[:3]).as_matrix()
        rotation, shift = turn @ rotation, turn @ (shift - centre) + centre + step[3:]
    return Similarity(rotation, shift)
