"""The head's own cloud, brought to the body's world and joined with the body's: section 3.4."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from engine.avatar.landmarks.spatial import SpatialLandmarks
from engine.avatar.registration.fine import FIRST_INNER_FACE_POINT
from engine.avatar.registration.skin import Skin, grown
from engine.geometry.point_cloud import PointCloud, joined
from engine.geometry.registration.iterative_closest_point import rigid_onto_surface
from engine.geometry.registration.rigid import Similarity, fit_rigid, fit_robustly, fit_similarity

LANDMARK_SIGMA = 0.006
"""Metres by which face landmarks are off, usually."""
MIN_FACE_LANDMARKS = 20
"""Face landmarks without which a head's cloud has no place."""
ALIGNMENT_ROUNDS = 12
"""Of closest points, rigid."""
ALIGNMENT_REACH = 0.03
"""Metres about the head within which points are looked at, once landmarks have brought them there."""
ALIGNMENT_GATE = 0.015
"""Metres within which points are of the surface there."""
CLOUD_RINGS = 10
"""Rings of vertices below the head for which the head's cloud counts, too."""


def head_to_body(
    skin: Skin, fitted: NDArray[np.float64], cloud: PointCloud, landmarks: SpatialLandmarks, sized: bool
) -> Similarity | None:
    """From the world of the head's clip to the body's: by face landmarks, which give its scale unless it is `sized` as the
    body is, then rigidly by closest points. None where the face was not found in the head's clip."""
    known = np.flatnonzero(np.isfinite(landmarks.face).all(1))
    known = known[known >= FIRST_INNER_FACE_POINT]
    if len(known) < MIN_FACE_LANDMARKS:
        return None
    target = fitted[skin.face_points[known]]
    fit = fit_rigid if sized else fit_similarity
    placed = fit_robustly(landmarks.face[known], target, LANDMARK_SIGMA, fit).transform
    solid = skin.regions["head"] & ~skin.regions["lips"] & ~skin.regions["lids"]
    surface = skin.triangles[skin.visible & solid[skin.triangles].all(1)]
    points = placed(cloud.points)
    near = cKDTree(fitted[solid]).query(points, distance_upper_bound=ALIGNMENT_REACH)[0] < np.inf
    turn = rigid_onto_surface(points[near], fitted, surface, ALIGNMENT_GATE, ALIGNMENT_ROUNDS)
    return Similarity(turn.linear @ placed.linear, turn(placed.shift))


def one_cloud(skin: Skin, fitted: NDArray[np.float64], body: PointCloud, head: PointCloud) -> PointCloud:
    """The body's cloud, with the head's in place of its own head."""
    of_head = skin.regions["head"]
    around = grown(of_head, skin.triangles, CLOUD_RINGS)
    tree = cKDTree(fitted)
    kept = ~of_head[tree.query(body.points)[1]]
    near = around[tree.query(head.points)[1]]
    return joined([body[kept], head[near]])
