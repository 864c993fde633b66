"""What the body does under a head that moves.

The neck holds a head within a little of where it rests on the shoulders, and it keeps its length. Whatever a head does
beyond that, its body does too: people who lean aside take their shoulders along. How much of it the driver's shoulders
really do is what its tracked points say; where they say nothing, the neck alone decides.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from engine.face_animation.motion_transfer.contour import rim_distance
from engine.face_animation.motion_transfer.head_motion import HeadMotion
from engine.face_animation.motion_transfer.head_proxy import (
    HeadProxy,
    chin_length,
    chin_lengths_below,
    head_share,
    move_head,
)
from engine.face_animation.motion_transfer.head_room import soft_limit
from engine.face_animation.smoothstep import smoothstep
from engine.perception.face.landmarks import CHIN_VERTEX, FACE_OVAL, MESH_SIZE

NECK_ROOM_FACE_LENGTHS = (0.35, (0.18, 0.25))
"""How far a head goes from its place on the shoulders, in lengths from eyes to chin: to either side; up and down."""
SHOULDER_FACE_LENGTHS, WAIST_FACE_LENGTHS = 2.2, 6.2
"""Lengths from eyes to chin below the eyes: from the shoulders, which move most, to where a body that leans stays."""
MAX_BODY_POINT_HEAD_SHARE = 0.6
"""Tracked points that belong to the head by less say what the body does, the less they do the more."""
HAIR_START_FACE_LENGTHS, HAIR_ROOM_FACE_LENGTHS = 0.3, 0.1
"""Lengths from eyes to chin: from the face's rim to where hair is followed fully, and how
far away its points are still believed: further away they have slipped."""
HELD_CUT_SHARES = (0.4, 0.8)
"""Shares of a head's width that the upper border cuts, up to which its hair comes down with it, and from which on it stays at the border."""
MIN_TRUSTED_POINTS = 5.0
"""With fewer trusted points of the body, or of the hair, what they say fades."""


def tracked_body(
    neutral: NDArray[np.floating],
    places: NDArray[np.floating],
    moved: NDArray[np.floating],
    trust: NDArray[np.floating],
) -> NDArray[np.float64]:
    """(N, 2) how far the driver's body went, pixels of the driver.

    Parameters
    ----------
    neutral : (478, 3) its face at rest. places : (K, 2) its tracked points at rest. moved : (N, K, 2) their offsets.
    trust : (N, K) [0, 1].
    """
    return _trusted_mean(moved, trust * np.maximum(1 - head_share(neutral, places) / MAX_BODY_POINT_HEAD_SHARE, 0))


def tracked_hair(
    motion: HeadMotion,
    proxy: HeadProxy,
    moved: NDArray[np.floating],
    trust: NDArray[np.floating],
    at: NDArray[np.floating],
) -> NDArray[np.float64]:
    """(N, P, 2) by how much the driver's hair went elsewhere than its face's motion carries it, at places `at` (P, 2), pixels of the driver; `proxy`
    is its neutral face with its tracked points, other parameters as of `tracked_body`.

    A tracker sees turns of the face too small, takes a smile for a tilt, and the skull lies far behind: what the face alone says of it
    errs by that. Hair stays one solid: it is a shift, a turn in the plane and a scale that it is off by.
    """
    neutral, places = motion.neutral, proxy.points[MESH_SIZE:, :2]
    carried = move_head(proxy, motion, neutral)[:, MESH_SIZE:, :2] - places
    weight = trust * proxy.share[MESH_SIZE:] * hair_share(neutral, places)
    away, middle = _trusted_mean(moved - carried, weight), _trusted_mean(np.broadcast_to(places, moved.shape), weight)
    total = weight.sum(axis=1)
    middle *= (np.maximum(total, MIN_TRUSTED_POINTS) / np.maximum(total, 1e-9))[:, None]
    length = chin_length(neutral)
    arm, left = places - middle[:, None], moved - carried - away[:, None]
    spread = np.einsum("nk,nkd->n", weight, arm**2) + MIN_TRUSTED_POINTS * length**2
    scale = np.einsum("nk,nkd,nkd->n", weight, arm, left) / spread
    turn = np.einsum("nk,nk->n", weight, arm[..., 0] * left[..., 1] - arm[..., 1] * left[..., 0]) / spread
    size = np.hypot(np.linalg.norm(away, axis=1), np.hypot(scale, turn) * length) / (HAIR_ROOM_FACE_LENGTHS * length)
    linear = np.stack([np.stack([scale, -turn], axis=-1), np.stack([turn, scale], axis=-1)], axis=-2)
    found = away[:, None] + np.einsum("nij,npj->npi", linear, at - middle[:, None])
    return np.asarray(found * np.exp(-(size**4))[:, None, None])


def hair_share(mesh: NDArray[np.floating], points: NDArray[np.floating]) -> NDArray[np.float64]:
    """(P,) how far points (P, 2) outside the face belong to hair and skull: rising from 0 at the face's rim to 1."""
    return smoothstep(rim_distance(mesh, points) / chin_length(mesh), 0, HAIR_START_FACE_LENGTHS)


def _trusted_mean(values: NDArray[np.floating], weight: NDArray[np.floating]) -> NDArray[np.float64]:
    """(N, 2) means of values (N, K, 2); they fade where fewer than `MIN_TRUSTED_POINTS` are left."""
    total = weight.sum(axis=1)
    mean = np.einsum("nk,nkd->nd", weight, values) / np.maximum(total, 1e-9)[:, None]
    return np.asarray(np.minimum(total / MIN_TRUSTED_POINTS, 1)[:, None] * mean)


def body_shift(skull: NDArray[np.floating], body: NDArray[np.floating], chin_length: float) -> NDArray[np.float64]:
    """(N, 2) how far the target's shoulders go.

    Parameters
    ----------
    skull : (N, 2) how far the middle of its skull does, pixels. body : (N, 2) what the driver's body does, pixels of the
    target. chin_length : from the eyes to the chin, pixels.
    """
    side, (up, down) = NECK_ROOM_FACE_LENGTHS
    low, high = chin_length * np.array([-side, -up]), chin_length * np.array([side, down])
    return np.asarray(skull - soft_limit(skull - body, low, high))


def body_share(mesh: NDArray[np.floating], points: NDArray[np.floating]) -> NDArray[np.float64]:
    """(P,) how much of the shoulders' shift points (P, 2) take: all of it down to the shoulders, none at the waist."""
    return np.asarray(
        np.clip(
            (WAIST_FACE_LENGTHS - chin_lengths_below(mesh, points)) / (WAIST_FACE_LENGTHS - SHOULDER_FACE_LENGTHS), 0, 1
        )
    )


def keep_at_borders(
    offsets: NDArray[np.floating],
    points: NDArray[np.floating],
    mesh: NDArray[np.floating],
    borders: NDArray[np.floating],
) -> None:
    """Keep points (P, 2) around the face of a mesh (478, 2 or 3) from leaving the borders of the picture that cut the body, in place: offsets (N, P, 2).

    `borders` (3,) are those to the left, to the right and below, pixels; one that cuts nobody lies at infinity. None has anything to show beyond
    itself: inwards, the offsets of the body become less from the face on and none at the border.
    """
    left, right, floor = borders.tolist()
    chin = float(mesh[CHIN_VERTEX, 1])
    free = np.clip((floor - points[:, 1]) / max(floor - chin, 1.0), 0, 1)
    offsets[..., 1] = np.where(offsets[..., 1] < 0, free * offsets[..., 1], offsets[..., 1])
    body = 1 - head_share(mesh, points)
    for border, face, inwards in ((left, mesh[:, 0].min(), 1), (right, mesh[:, 0].max(), -1)):
        if np.isfinite(border):
            held = body * (1 - np.clip((points[:, 0] - border) / (inwards * max(abs(float(face) - border), 1.0)), 0, 1))
            offsets[..., 0] = np.where(inwards * offsets[..., 0] > 0, (1 - held) * offsets[..., 0], offsets[..., 0])


def keep_hair_at_border(
    offsets: NDArray[np.floating], points: NDArray[np.floating], mesh: NDArray[np.floating], top: float, cut: float
) -> None:
    """Keep hair that the picture's upper border at the height `top` cuts there, where a head comes down, in place: offsets (N, P, 2) of points (P, 2) around the
    face of a mesh (478, 2 or 3). From the face's top on they become less, and none at the border: hair is drawn out. Nothing has to be
    made up beyond the border, and to both sides all goes with its head. `cut` : the share of the head's width that is cut (`cut_above`); a head of
    which little is cut comes down whole.
    """
    face = float(mesh[list(FACE_OVAL), 1].min())
    held = smoothstep(cut, *HELD_CUT_SHARES) * (1 - np.clip((points[:, 1] - top) / max(face - top, 1.0), 0, 1))
    offsets[..., 1] = np.where(offsets[..., 1] > 0, (1 - held) * offsets[..., 1], offsets[..., 1])
