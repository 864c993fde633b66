"""Which joints move cloth around both legs: those of the skin of the left leg on the left, of the right one on the right, of both between."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_array
from scipy.spatial import cKDTree

from engine.avatar.attachments.body_surface import BodySurface
from engine.avatar.attachments.influences import strongest
from engine.avatar.attachments.skirt.legs import Legs
from engine.avatar.attachments.skirt.skirt_mesh import RING_THICKNESS_METRES
from engine.face_animation.smoothstep import smoothstep
from engine.geometry.mesh.adjacency import neighbours
from engine.geometry.mesh.closest_points import closest_points
from engine.geometry.rigging.joint_names import SIDE_NAMES

SAME_CLOTH_METRES = 1.5 * RING_THICKNESS_METRES
"""Metres up to which one vertex of a ring is the other side of the cloth at another; along the cloth they are farther apart."""
LEG_SMOOTHING_ROUNDS = 30
"""Rounds in which influences become the mean of those around: a few centimetres."""
HIPS_METRES = (-0.03, 0.04)
"""Metres above the crotch between which what moves cloth goes over from the legs to the skin of the hips."""


def leg_influences(
    vertices: NDArray[np.floating],
    triangles: NDArray[np.integer],
    body: BodySurface,
    legs: Legs,
    joint_weights: NDArray[np.floating],
) -> tuple[NDArray[np.uint8], NDArray[np.float32]]:
    """(V, 4) joints, strongest first, and their weights, summing to one, of cloth, `vertices` (V, 3) and `triangles` (T, 3), around both
    legs. `joint_weights` (S, J) are those of the skin.

    Before and behind a leg, from its middle outwards, cloth goes with that leg alone, which would come through it else. What hangs between takes its share of
    either by how far it is aside. Above the crotch it goes with the skin that it comes out of.
    """
    left = shares_of_left(legs.sideways(vertices))
    own = np.zeros((len(vertices), joint_weights.shape[1]))
    for side, share in zip(SIDE_NAMES, (left, 1 - left), strict=True):
        leg = body.triangles[legs.skin[side][body.triangles].all(1)]
        own += share[:, None] * closest_points(vertices, body.vertices, leg).interpolated(joint_weights, leg)
    beside = neighbours(triangles, len(vertices))
    number = np.maximum(np.asarray(beside.sum(1)).reshape(-1, 1), 1)
    for _ in range(LEG_SMOOTHING_ROUNDS):
        own = (own + beside @ own / number) / 2
    skin = closest_points(vertices, body.vertices, body.triangles).interpolated(joint_weights, body.triangles)
    above = smoothstep(vertices[:, 1] - legs.crotch, *HIPS_METRES)[:, None]
    return strongest(_both_sides(vertices, own + above * (skin - own)))


def _both_sides(vertices: NDArray[np.floating], own: NDArray[np.float64]) -> NDArray[np.float64]:
    """Weights (V, J) of a ring's vertices (V, 3), alike outside and inside: the inside would come through the outside else."""
    pairs = cKDTree(vertices).query_pairs(SAME_CLOTH_METRES, output_type="ndarray")
    across = csr_array((np.ones(len(pairs)), (pairs[:, 0], pairs[:, 1])), shape=(len(vertices), len(vertices)))
    across = across + across.T
    return np.asarray((own + across @ own) / (1 + np.asarray(across.sum(1)).reshape(-1, 1)))


def shares_of_left(sideways: NDArray[np.floating]) -> NDArray[np.float64]:
    """(N,) what the left leg does to cloth that is so far to the left, of both legs' middles: smoothly from 0 to 1."""
    return smoothstep(sideways, -1, 1)
