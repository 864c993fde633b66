"""The head's own cloud, brought to the body's world and joined with the body's: section 3.4."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from engine.avatar.landmarks.spatial import SpatialLandmarks
from engine.avatar.registration.fine import FIRST_INNER_FACE_POINT
from engine.avatar.registration.template_skin.skin import Skin, grown
from engine.geometry.point_clouds.point_cloud import PointCloud, joined
from engine.geometry.registration.iterative_closest_point import rigid_onto_cloud
from engine.geometry.registration.rigid import Similarity, fit_rigid, fit_robustly, fit_similarity

HEAD_CLOUD_LANDMARK_SIGMA_METRES = 0.006
"""Metres by which face landmarks are off, usually."""
MIN_FACE_LANDMARKS = 20
"""Face landmarks without which a head's cloud has no place."""
HEAD_CLOUD_ROUNDS = 12
"""Of closest points, rigid."""
ALIGNMENT_REACH_METRES = 0.25
"""Metres about the head's middle within which the two clouds are laid on each other: hair, neck and shoulders tell how a round
head is turned."""
HEAD_CLOUD_GATE_METRES = 0.03
"""Metres within which points of one cloud are of what the other shows there."""
AGREEMENT_DISTANCE_METRES = 0.005
"""Metres within which a point agrees with the other cloud."""
MAX_ALIGNED_HEAD_POINTS = 20000
"""Points of the head's cloud that are laid on the body's, at most."""
CLOUD_RINGS = 10
"""Rings of vertices below the head for which the head's cloud counts, too."""


def head_to_body(
    skin: Skin,
    fitted: NDArray[np.float64],
    body: PointCloud,
    cloud: PointCloud,
    landmarks: SpatialLandmarks,
    sized: bool,
) -> Similarity | None:
    """From the world of the head's clip to that of the body's, whose own cloud is `body`. None where the face was not found in
    the head's clip.

    It begins with face landmarks. They give its scale, unless it is `sized` as the body is, and where it is. It begins
    with no motion at all, too, since both clips were then measured in one world. From each the clouds are laid on each
    other rigidly, by closest points; the one in which more points agree is taken. The template is not asked how the
    head is turned: the body's clip shows it small, and under a hat or hair it is another shape.
    """
    known = np.flatnonzero(np.isfinite(landmarks.face).all(1))
    known = known[known >= FIRST_INNER_FACE_POINT]
    if len(known) < MIN_FACE_LANDMARKS:
        return None
    target = fitted[skin.face_points[known]]
    fit = fit_rigid if sized else fit_similarity
    starts = [fit_robustly(landmarks.face[known], target, HEAD_CLOUD_LANDMARK_SIGMA_METRES, fit).transform]
    if sized:
        starts.append(Similarity(np.eye(3), np.zeros(3)))
    middle = fitted[skin.regions["head"]].mean(0)
    around = body[np.linalg.norm(body.points - middle, axis=1) < ALIGNMENT_REACH_METRES + HEAD_CLOUD_GATE_METRES]
    tree = cKDTree(around.points)
    best, most = starts[0], -1
    for start in starts:
        points = start(cloud.points)
        points = points[np.linalg.norm(points - middle, axis=1) < ALIGNMENT_REACH_METRES]
        points = points[:: max(len(points) // MAX_ALIGNED_HEAD_POINTS, 1)]
        turn = rigid_onto_cloud(points, around.points, around.normals, HEAD_CLOUD_GATE_METRES, HEAD_CLOUD_ROUNDS)
        agreed = int(
            np.count_nonzero(np.isfinite(tree.query(turn(points), distance_upper_bound=AGREEMENT_DISTANCE_METRES)[0]))
        )
        if agreed > most:
            best, most = Similarity(turn.linear @ start.linear, turn(start.shift)), agreed
    return best


def one_cloud(skin: Skin, fitted: NDArray[np.float64], body: PointCloud, head: PointCloud) -> PointCloud:
    """The body's cloud, with the head's in place of its own head."""
    of_head = skin.regions["head"]
    around = grown(of_head, skin.triangles, CLOUD_RINGS)
    tree = cKDTree(fitted)
    kept = ~of_head[tree.query(body.points)[1]]
    near = around[tree.query(head.points)[1]]
    return joined([body[kept], head[near]])
