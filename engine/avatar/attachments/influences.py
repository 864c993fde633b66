"""Which joints move what stands off the body: the head alone what is on it, else those of the skin below, smoothly.

Nothing is worn on arms, hands and feet: what hangs beside an arm goes with the trunk when the arm is raised.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from engine.avatar.attachments.body_surface import BodySurface
from engine.geometry.mesh.adjacency import neighbours
from engine.geometry.mesh.closest_points import closest_points
from engine.geometry.rigging.skinning import MAX_VERTEX_INFLUENCES

INFLUENCE_SMOOTHING_ROUNDS = 300
"""Rounds in which a vertex' influences become the mean of those around, a hand's breadth and more. A coat's tail that
lies between both legs follows what they do together, and is not folded between them when they close."""


def influences(
    vertices: NDArray[np.floating],
    triangles: NDArray[np.integer],
    body: BodySurface,
    joint_weights: NDArray[np.floating],
    head: NDArray[np.bool_],
) -> tuple[NDArray[np.uint8], NDArray[np.float32]]:
    """(V, 4) joints, strongest first, and their weights, summing to one, of a piece, `vertices` (V, 3) and `triangles` (T, 3).

    `joint_weights` (S, J) are those of the skin; `head` (J,) bool the joints of the head, the first of which turns all of it: a
    piece that lies mostly on the head is rigid.
    """
    wearing = body.triangles[~body.own[body.triangles].any(1)]
    own = closest_points(vertices, body.vertices, wearing).interpolated(joint_weights, wearing)
    if own[:, head].sum(1).mean() > 0.5:
        own = np.zeros_like(own)
        own[:, np.flatnonzero(head)[0]] = 1
    beside = neighbours(triangles, len(vertices))
    number = np.maximum(np.asarray(beside.sum(1)).reshape(-1, 1), 1)
    for _ in range(INFLUENCE_SMOOTHING_ROUNDS):
        own = (own + beside @ own / number) / 2
    return strongest(own)


def strongest(own: NDArray[np.floating]) -> tuple[NDArray[np.uint8], NDArray[np.float32]]:
    """(V, 4) the strongest joints of those that move each vertex by weights (V, J), strongest first, and what these are then, summing to
    one."""
    joints = np.argsort(-own, axis=1, kind="stable")[:, :MAX_VERTEX_INFLUENCES]
    kept = np.take_along_axis(own, joints, 1)
    kept /= kept.sum(1, keepdims=True)
    return np.where(kept > 0, joints, 0).astype(np.uint8), kept.astype(np.float32)
