"""The body under a head that moves: a neck of a length, and shoulders that follow."""

from __future__ import annotations

import numpy as np
import pytest
from made_face import placed

from engine.face_animation.motion_transfer.body_motion import (
    NECK_ROOM_FACE_LENGTHS,
    body_share,
    body_shift,
    keep_at_borders,
    keep_hair_at_border,
    tracked_body,
    tracked_hair,
)
from engine.face_animation.motion_transfer.head_motion import split_motion
from engine.face_animation.motion_transfer.head_proxy import build_head_proxy, move_head
from engine.perception.face.landmarks import FACE_OVAL, MESH_SIZE

FACE = placed(40.0, (150.0, 120.0))


def test_a_head_that_goes_a_little_leaves_the_shoulders() -> None:
    skull = np.array([[0.1 * 50, -0.05 * 50]])
    np.testing.assert_allclose(body_shift(skull, np.zeros((1, 2)), 50.0), 0, atol=1e-9)


def test_the_neck_never_gets_longer_than_it_can() -> None:
    skull = np.stack(np.meshgrid(np.linspace(-200, 200, 21), np.linspace(-200, 200, 21)), axis=-1).reshape(-1, 2)
    neck = skull - body_shift(skull, np.zeros_like(skull), 50.0)
    side, (up, down) = NECK_ROOM_FACE_LENGTHS
    assert np.abs(neck[:, 0]).max() <= 50 * side
    assert neck[:, 1].min() >= -50 * up and neck[:, 1].max() <= 50 * down


def test_who_leans_with_the_whole_body_keeps_the_neck_as_it_is() -> None:
    leaning = np.array([[60.0, 10.0]])
    np.testing.assert_allclose(body_shift(leaning, leaning, 50.0), leaning)


def test_the_body_s_points_alone_tell_what_it_does() -> None:
    """Ten on the chest go right, ten in the hair go left; with too few trusted, they say less."""
    chest = np.column_stack([np.linspace(100, 200, 10), np.full(10, FACE[152, 1] + 120)])
    hair = np.column_stack([np.linspace(100, 200, 10), np.full(10, FACE[10, 1] - 10)])
    offsets = np.concatenate([np.full((10, 2), (7.0, 1.0)), np.full((10, 2), (-30.0, 0.0))])[None]
    places, trust = np.concatenate([chest, hair]), np.ones((1, 20))
    np.testing.assert_allclose(tracked_body(FACE, places, offsets, trust), [[7, 1]])
    trust[0, 1:10] = 0
    np.testing.assert_allclose(tracked_body(FACE, places, offsets, trust), [[1.4, 0.2]])
    np.testing.assert_array_equal(tracked_body(FACE, places[:0], offsets[:, :0], trust[:, :0]), [[0, 0]])


def test_shoulders_go_and_the_waist_stays() -> None:
    down = np.column_stack([np.full(100, 150.0), np.linspace(0, 900, 100)])
    share = body_share(FACE, down)
    assert (np.diff(share) <= 0).all() and share[0] == 1 and share[-1] == 0


@pytest.mark.parametrize(("away", "kept"), [((2.0, 0.0), 0.93), ((0.0, 60.0), 0.0)])
def test_hair_that_goes_a_little_further_than_its_face_is_followed(away: tuple[float, float], kept: float) -> None:
    """And points that slip off it are not."""
    hair = np.column_stack([np.linspace(100, 200, 10), np.full(10, FACE[10, 1] - 40)])
    motion = split_motion(FACE[None] + [5.0, 2.0, 0.0], FACE)
    proxy = build_head_proxy(np.concatenate([FACE[:, :2], hair]), FACE)
    found = tracked_hair(motion, proxy, np.full((1, 10, 2), (5.0, 2.0)) + away, np.ones((1, 10)), hair)
    wanted = np.tile(np.array(away) * kept, (10, 1))
    assert found[0] == pytest.approx(wanted, abs=0.1 * max(away) * (kept > 0) + 0.05)


def test_hair_that_stays_undoes_most_of_a_tilt_that_its_face_seems_to_make() -> None:
    """A tracker takes a crooked smile for a tilt of two degrees."""
    angle = np.deg2rad(2.0)
    tilt = np.array([[np.cos(angle), -np.sin(angle), 0], [np.sin(angle), np.cos(angle), 0], [0, 0, 1]])
    motion = split_motion((FACE @ tilt.T)[None] + (FACE.mean(axis=0) - tilt @ FACE.mean(axis=0)), FACE)
    x, y = np.meshgrid(np.linspace(90, 210, 9), np.linspace(FACE[10, 1] - 60, FACE[10, 1] - 25, 4))
    hair = np.column_stack([x.ravel(), y.ravel()])
    still, trust = np.zeros((1, len(hair), 2)), np.ones((1, len(hair)))
    proxy = build_head_proxy(np.concatenate([FACE[:, :2], hair]), FACE)
    carried = move_head(proxy, motion, FACE)[0, MESH_SIZE:, :2] - hair
    left = carried + tracked_hair(motion, proxy, still, trust, hair)[0]
    assert np.linalg.norm(left, axis=1).mean() < 0.35 * np.linalg.norm(carried, axis=1).mean()


def test_a_body_that_the_picture_cuts_does_not_rise_off_its_border() -> None:
    """Half-way between chin and border it rises half as far; nothing that sinks or goes aside is held."""
    chin = float(FACE[152, 1])
    floor = chin + 100.0
    points = np.array([[100.0, chin - 20], [100.0, chin + 50], [100.0, floor], [100.0, floor + 30]])
    offsets = np.tile([[6.0, -10.0]], (1, 4, 1))
    sinking = -offsets
    keep_at_borders(offsets, points, FACE, np.array([-np.inf, np.inf, floor]))
    np.testing.assert_allclose(offsets[0], [[6, -10], [6, -5], [6, 0], [6, 0]])
    kept = sinking.copy()
    keep_at_borders(kept, points, FACE, np.array([-np.inf, np.inf, floor]))
    np.testing.assert_array_equal(kept, sinking)


def test_a_side_that_cuts_the_body_keeps_it() -> None:
    """What goes inwards from the left border is stretched between it and the face; the head, and what goes outwards, are free."""
    chest, left, face = float(FACE[152, 1]) + 150, 10.0, float(FACE[:, 0].min())
    points = np.array([[left, chest], [(left + face) / 2, chest], [face, chest], [left, FACE[10, 1]]])
    inwards, outwards = np.full((1, 4, 2), (8.0, 0.0)), np.full((1, 4, 2), (-8.0, 0.0))
    for offsets in (inwards, outwards):
        keep_at_borders(offsets, points, FACE, np.array([left, np.inf, 600.0]))
    np.testing.assert_allclose(inwards[0, :, 0], [0, 4, 8, 8], atol=1e-6)
    np.testing.assert_array_equal(outwards[0, :, 0], -8)


def test_hair_that_is_cut_is_drawn_out_from_the_border_and_goes_aside_with_its_head() -> None:
    top, face = 10.0, float(FACE[list(FACE_OVAL), 1].min())
    points = np.array([[300, top], [300, (top + face) / 2], [300, face], [300, face + 50]])
    offsets = np.tile([12.0, 20.0], (1, 4, 1))
    keep_hair_at_border(offsets, points, FACE, top, 1.0)
    np.testing.assert_allclose(offsets[0, :, 0], 12)
    np.testing.assert_allclose(offsets[0, :, 1], [0, 10, 20, 20])
    upwards = np.tile([0.0, -20.0], (1, 4, 1))
    keep_hair_at_border(upwards, points, FACE, top, 1.0)
    np.testing.assert_allclose(upwards[..., 1], -20)


def test_a_head_of_which_little_is_cut_comes_down_whole() -> None:
    offsets = np.tile([0.0, 20.0], (1, 1, 1))
    keep_hair_at_border(offsets, np.array([[300.0, 10.0]]), FACE, 10.0, 0.3)
    np.testing.assert_allclose(offsets[..., 1], 20)
