"""Rings around a face's contour: round, at their distances, and moved with it where they touch it."""

from __future__ import annotations

import numpy as np
from made_face import placed, turn

from engine.face_animation.motion_transfer.contour import contour_spots, rim_distance
from engine.face_animation.motion_transfer.head_motion import split_motion
from engine.face_animation.motion_transfer.head_proxy import build_head_proxy, move_head
from engine.face_animation.warping.contour_rings import CURVE_STEPS, RING_EYE_DISTANCES, contour_rings, rings_end
from engine.perception.face.landmarks import FACE_OVAL, MESH_SIZE

UNIT, SHAPE = 40.0, (300, 260)
FACE = placed(UNIT, (130.0, 130.0))
COUNT = len(FACE_OVAL)


def test_rings_lie_at_their_distances_from_the_contour() -> None:
    points = contour_rings(FACE, SHAPE)
    on_contour, around = points[: (CURVE_STEPS - 1) * COUNT], points[(CURVE_STEPS - 1) * COUNT :]
    assert np.abs(rim_distance(FACE, on_contour)).max() < 0.02 * UNIT
    apart = rim_distance(FACE, around).reshape(len(RING_EYE_DISTANCES), -1) / UNIT
    np.testing.assert_allclose(
        apart, np.repeat(np.array(RING_EYE_DISTANCES)[:, None], apart.shape[1], axis=1), atol=0.02
    )
    assert rings_end(FACE) == np.float32(RING_EYE_DISTANCES[-1] * UNIT)


def test_nothing_lies_outside_the_picture() -> None:
    points = contour_rings(placed(UNIT, (20.0, 130.0)), SHAPE)
    assert 50 < len(points) < len(contour_rings(FACE, SHAPE))
    assert (points > 0).all() and (points < (SHAPE[1] - 1, SHAPE[0] - 1)).all()


def test_a_point_of_the_contour_is_the_spot_next_to_it() -> None:
    """Two vertices hold it, and where it lies on their edge they give the point itself."""
    oval = FACE[list(FACE_OVAL), :2].astype(float)
    on_edges = 0.3 * oval + 0.7 * np.roll(oval, -1, axis=0)
    spots = contour_spots(FACE, on_edges)
    assert ((spots > 0).sum(axis=1) == 2).all()
    np.testing.assert_allclose(spots @ oval, on_edges, atol=1e-6)


def test_what_touches_the_contour_of_a_turned_head_goes_with_it() -> None:
    """However fast the motion changes beside a face, points on its contour move as the contour there does."""
    oval = FACE[list(FACE_OVAL), :2].astype(float)
    touching = 0.5 * (oval + np.roll(oval, -1, axis=0))
    proxy = build_head_proxy(np.concatenate([FACE[:, :2], touching]), FACE)
    middle = FACE.mean(axis=0)
    motion = split_motion(((FACE - middle) @ turn(yaw=20.0).T + middle)[None], FACE)
    moved = move_head(proxy, motion, FACE)[0, :, :2]
    rim = moved[list(FACE_OVAL)]
    np.testing.assert_allclose(moved[MESH_SIZE:], 0.5 * (rim + np.roll(rim, -1, axis=0)), atol=0.05)
