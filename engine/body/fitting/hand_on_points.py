"""The skin of an articulated hand against points of a cloud: what tells how it is held more finely than landmarks do."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from engine.body.fitting.articulated_hand import TURNED_LANDMARKS, ArticulatedHand
from engine.geometry.mesh.closest_points import closest_points
from engine.geometry.mesh.surface import face_normals
from engine.geometry.point_clouds.point_cloud import PointCloud

HAND_POINT_SIGMA_METRES = 0.003
"""Metres by which points are off a hand's skin, usually."""
INDEPENDENT_POINTS = 60.0
"""As how many independent measurements all points of a hand count: fingers drift while others are filmed, and drift as one."""
MIN_HAND_POINTS = 50
"""Points that say something of a hand."""
MIN_HAND_NORMAL_COSINE = 0.4
"""The least cosine between the normals of a point and of the skin."""
HAND_GATES_METRES = (0.015, 0.012, 0.010, 0.008)
"""Metres within which points are the hand's, one round after the other."""


@dataclass(frozen=True)
class HandSkin:
    """A person's skin with a hand that is to be laid on `cloud`.

    vertices : (S, 3) metres, all of the skin in its pose, which the hand's own competes with for points.
    triangles : (T, 3) into them.
    moved : (H,) which of the vertices the hand moves.
    rest : (H, 3) metres, those in T-pose, around the wrist.
    bones : (H, K) what moves them: 0 the forearm, 1 to 16 the landmarks `TURNED_LANDMARKS`.
    weights : (H, K) by how much, summing to one.
    """

    cloud: PointCloud
    vertices: NDArray[np.float64]
    triangles: NDArray[np.integer]
    moved: NDArray[np.intp]
    rest: NDArray[np.float64]
    bones: NDArray[np.intp]
    weights: NDArray[np.float64]

    def posed(
        self, hand: ArticulatedHand, wrist: NDArray[np.floating], parameters: NDArray[np.float64]
    ) -> NDArray[np.float64]:
        """(N, H, 3) the hand's vertices for parameters (N, P): turn (3), shift (3), logarithm of the scale, angles."""
        count = len(parameters)
        scale = np.exp(parameters[:, 6])[:, None, None]
        rotations = hand.rotations(parameters[:, :3], parameters[:, 7:])
        axes = np.empty((count, 17, 3, 3))
        axes[:, 0] = hand.forearm_axes
        axes[:, 1] = hand.forearm_axes @ rotations[:, 0]
        for finger in range(5):
            for joint in range(3):
                own = 2 + 3 * finger + joint
                axes[:, own] = axes[:, own - 1 if joint else 1] @ rotations[:, own - 1]
        axes[:, 1:] *= scale[..., None]
        shifts = np.zeros((count, 17, 3))
        places = parameters[:, None, 3:6] + scale * hand.places(parameters[:, :3], parameters[:, 7:])
        heads = hand.rest[TURNED_LANDMARKS]
        shifts[:, 1:] = places[:, TURNED_LANDMARKS] - np.einsum("njab,jb->nja", axes[:, 1:], heads)
        out = np.zeros((count, len(self.rest), 3))
        for k in range(self.bones.shape[1]):
            bone = self.bones[:, k]
            out += self.weights[:, k, None] * (np.einsum("nhab,hb->nha", axes[:, bone], self.rest) + shifts[:, bone])
        return out + wrist

    def matched(self, posed: NDArray[np.floating], gate: float) -> PointsOfHand | None:
        """The points within a `gate`, metres, of which the hand (H, 3) is nearer than the rest of the skin, and faces their way;
        None where these are too few to tell anything."""
        vertices = self.vertices.copy()
        vertices[self.moved] = posed
        own = np.zeros(len(vertices), np.bool_)
        own[self.moved] = True
        low, high = posed.min(0) - gate, posed.max(0) + gate
        cloud = self.cloud[np.flatnonzero(((self.cloud.points > low) & (self.cloud.points < high)).all(1))]
        nearby = self.triangles[((vertices > low - gate) & (vertices < high + gate)).all(1)[self.triangles].any(1)]
        if len(cloud) < MIN_HAND_POINTS or not len(nearby):
            return None
        nearest = closest_points(cloud.points, vertices, nearby)
        corners = nearby[nearest.triangle]
        normals = face_normals(vertices, nearby)[nearest.triangle]
        used = (
            (nearest.distance < gate)
            & own[corners].all(1)
            & ((normals * cloud.normals).sum(1) > MIN_HAND_NORMAL_COSINE)
        )
        if used.sum() < MIN_HAND_POINTS:
            return None
        number = np.full(len(vertices), -1)
        number[self.moved] = np.arange(len(self.moved))
        weights = np.maximum(1 - (nearest.distance[used] / gate) ** 2, 0)
        return PointsOfHand(
            np.asarray(cloud.points[used], np.float64),
            normals[used] * (np.sqrt(weights * INDEPENDENT_POINTS / used.sum()) / HAND_POINT_SIGMA_METRES)[:, None],
            number[corners[used]],
            nearest.barycentrics[used],
        )


@dataclass(frozen=True)
class PointsOfHand:
    """Points, each on a triangle of the hand.

    points : (M, 3) metres.
    normals : (M, 3) of the triangle, as long as offsets along them count.
    corners : (M, 3) vertices of the triangle.
    shares : (M, 3) barycentrics in it.
    """

    points: NDArray[np.float64]
    normals: NDArray[np.float64]
    corners: NDArray[np.intp]
    shares: NDArray[np.float64]

    def residuals(self, posed: NDArray[np.float64]) -> NDArray[np.float64]:
        """(N, M) how far off the skin the points are, for hands (N, H, 3), in standard deviations."""
        at = np.einsum("mk,nmka->nma", self.shares, posed[:, self.corners])
        return np.asarray(np.einsum("nma,ma->nm", at - self.points, self.normals))
