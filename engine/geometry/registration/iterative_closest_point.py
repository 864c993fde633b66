"""Points turned and shifted onto a surface near which they are.

Source: Y. Chen, G. Medioni, Object modelling by registration of multiple range images, Image and Vision Computing 10, 1992
(distances to tangential planes, which let points slide along the surface).
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree
from scipy.spatial.transform import Rotation

from engine.geometry.mesh.closest_points import closest_points
from engine.geometry.mesh.surface import face_normals
from engine.geometry.registration.rigid import Similarity

MOTION_DAMPING = 1e-9
"""What keeps a motion along which the surface is the same, such as a ball's turn, at none."""


def rigid_onto_surface(
    points: NDArray[np.floating],
    vertices: NDArray[np.floating],
    triangles: NDArray[np.integer],
    gate: float,
    rounds: int,
) -> Similarity:
    """The turn and shift, of scale one, that bring `points` (N, 3) onto the surface `triangles` (T, 3) over `vertices` (V, 3),
    after so many `rounds`. Points further away than `gate`, in the same unit, do not count."""
    surface = np.asarray(vertices, np.float64)
    start = np.asarray(points, np.float64)
    normals = np.asarray(face_normals(surface, triangles), np.float64)
    found = Similarity(np.eye(3), np.zeros(3))
    for _ in range(rounds):
        moved = found(start)
        nearest = closest_points(moved, surface, triangles)
        used = nearest.distance < gate
        if used.sum() < 6:
            break
        there = nearest[used].interpolated(surface, np.asarray(triangles))
        found = _onto_planes(moved[used], there, normals[nearest.triangle[used]], found)
    return found


def rigid_onto_cloud(
    points: NDArray[np.floating],
    cloud: NDArray[np.floating],
    normals: NDArray[np.floating],
    gate: float,
    rounds: int,
) -> Similarity:
    """The rigid motion of points onto a surface that is known by points on it, `cloud` (M, 3), with its unit `normals`
    (M, 3) there."""
    start, surface = np.asarray(points, np.float64), np.asarray(cloud, np.float64)
    across = np.asarray(normals, np.float64)
    tree = cKDTree(surface)
    found = Similarity(np.eye(3), np.zeros(3))
    for _ in range(rounds):
        moved = found(start)
        distance, found_at = tree.query(moved, distance_upper_bound=gate)
        used, nearest = np.isfinite(distance), np.asarray(found_at)
        if used.sum() < 6:
            break
        found = _onto_planes(moved[used], surface[nearest[used]], across[nearest[used]], found)
    return found


def _onto_planes(
    at: NDArray[np.float64], there: NDArray[np.float64], across: NDArray[np.float64], found: Similarity
) -> Similarity:
    """`found`, followed by the turn and shift that bring points (N, 3) to the planes through points `there`, `across` to which
    are their normals."""
    middle = at.mean(0)
    rows = np.concatenate([np.cross(at - middle, across), across], 1)
    off = ((there - at) * across).sum(1)
    hessian = rows.T @ rows
    step = np.linalg.solve(hessian + MOTION_DAMPING * np.trace(hessian) * np.eye(6), rows.T @ off)
    turn = Rotation.from_rotvec(step[:3]).as_matrix()
    shift = middle + step[3:] - turn @ middle
    return Similarity(turn @ found.linear, turn @ found.shift + shift)
