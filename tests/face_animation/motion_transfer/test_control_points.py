"""Where the control points of a target are, and what carries the peripheral ones."""

from __future__ import annotations

import cv2
import numpy as np
import pytest
from made_face import placed
from numpy.typing import NDArray

from engine.face_animation.motion_transfer.control_points import ControlPoints, carry_periphery, place_control_points
from engine.geometry.registration.rigid import Similarity
from engine.perception.face.landmarks import FACE_OVAL, MESH_SIZE
from engine.perception.face_track.periphery import tracked_weights

SHAPE = (240, 200)
IDENTITY = Similarity(np.eye(2), np.zeros(2))


@pytest.fixture(scope="module")
def person() -> NDArray[np.float32]:
    """Head and shoulders."""
    mask = np.zeros(SHAPE, np.float32)
    cv2.ellipse(mask, (100, 100), (48, 65), 0, 0, 360, 1.0, -1)
    cv2.ellipse(mask, (100, 240), (85, 70), 0, 0, 360, 1.0, -1)
    return mask


@pytest.fixture(scope="module")
def control(person: NDArray) -> ControlPoints:
    return place_control_points(placed(36, (100, 90)), person)


def test_the_face_s_mesh_comes_first(control: ControlPoints) -> None:
    np.testing.assert_allclose(control.points[:MESH_SIZE], placed(36, (100, 90))[:, :2])


def test_peripheral_points_lie_outside_the_face_on_and_around_the_person(control: ControlPoints, person) -> None:
    points = control.points[control.periphery]
    assert len(points) > 20
    oval = placed(36, (100, 90))[list(FACE_OVAL), :2]
    assert all(cv2.pointPolygonTest(oval, (float(x), float(y)), False) < 0 for x, y in points)
    away = cv2.distanceTransform((person < 0.3).astype(np.uint8), cv2.DIST_L2, 5)
    at = away[points[:, 1].astype(int), points[:, 0].astype(int)]
    assert at.max() < 36
    assert (at == 0).any() and (at > 0).any()


def test_border_points_lie_on_the_border_corners_included(control: ControlPoints) -> None:
    points = control.points[control.border]
    height, width = SHAPE
    on_edge = np.isin(points[:, 0], (0, width - 1)) | np.isin(points[:, 1], (0, height - 1))
    assert on_edge.all()
    corners = {(0.0, 0.0), (width - 1.0, 0.0), (0.0, height - 1.0), (width - 1.0, height - 1.0)}
    assert corners <= {tuple(p) for p in points.tolist()}
    assert len({tuple(p) for p in points.tolist()}) == len(points)


def test_no_two_points_coincide(control: ControlPoints) -> None:
    others = control.points[MESH_SIZE:]
    apart = np.linalg.norm(others[:, None] - others[None], axis=2) + 1e9 * np.eye(len(others))
    assert apart.min() > 1


def test_points_that_the_picture_sees_edge_on_are_not_used(person: NDArray) -> None:
    frontal = place_control_points(placed(36, (100, 90)), person)
    assert frontal.usable.mean() > 0.9
    for yaw, hidden, seen in ((35, 454, 234), (-35, 234, 454)):  # the cheek that the face turns towards is behind it
        turned = place_control_points(placed(36, (100, 90), yaw=yaw), person)
        assert not turned.usable[hidden] and turned.usable[seen]
        assert turned.usable[[4, 13, 152]].all()
    assert frontal.usable[MESH_SIZE:].all()


def test_a_face_that_fills_the_picture_still_has_a_border(person: NDArray) -> None:
    control = place_control_points(placed(120, (100, 60)), np.ones(SHAPE, np.float32))
    assert len(control.points[control.border]) >= 8


@pytest.fixture(scope="module")
def tracked() -> NDArray[np.float64]:
    return np.random.default_rng(0).uniform(0, 200, (60, 2))


def test_tracks_that_all_do_the_same_carry_just_that(tracked: NDArray) -> None:
    """Every peripheral point gets phi's linear part of it: here doubled, and turned by 90 degrees."""
    phi = Similarity(2 * np.array([[0.0, -1.0], [1.0, 0.0]]), np.array([5.0, 5.0]))
    offsets = np.broadcast_to(np.array([1.0, 3.0]), (4, 60, 2))
    points = np.random.default_rng(1).uniform(-300, 500, (30, 2))
    carried = carry_periphery(phi, tracked, offsets, np.ones((4, 60)), points, 40)
    np.testing.assert_allclose(carried, np.broadcast_to([-6.0, 2.0], (4, 30, 2)), atol=1e-4)


def test_points_that_are_not_trusted_do_not_count(tracked: NDArray) -> None:
    offsets = np.ones((1, 60, 2))
    trusted = np.ones((1, 60))
    wild = np.random.default_rng(2).permutation(60)[:25]
    offsets[0, wild], trusted[0, wild] = 500.0, 0
    carried = carry_periphery(IDENTITY, tracked, offsets, trusted, tracked[:20], 40)
    np.testing.assert_allclose(carried, 1.0, atol=1e-3)


def test_near_tracks_count_for_more_than_far_ones() -> None:
    places = np.array([[0.0, 0.0], [100.0, 0.0]])
    offsets = np.array([[[0.0, 0.0], [10.0, 0.0]]])
    points = np.array([[0.0, 0.0], [25.0, 0.0], [50.0, 0.0], [75.0, 0.0], [100.0, 0.0]])
    carried = carry_periphery(IDENTITY, places, offsets, np.ones((1, 2)), points, 30)[0, :, 0]
    assert (np.diff(carried) > 0).all()
    assert carried[0] < 0.1 and carried[4] > 9.9
    assert carried[2] == pytest.approx(5, abs=1e-3)


def test_tracks_that_are_lost_fade_out_and_in(tracked: NDArray) -> None:
    """All points go the same way and are lost for a while, held: shoulders come to rest, and no step is a jump."""
    lost = np.ones((120, 60), bool)
    lost[40:80] = False
    trust = tracked_weights(lost)
    assert trust.max() == 1 and trust[50:70].max() == 0
    moved = np.broadcast_to([20.0, 0.0], (120, 60, 2))
    carried = carry_periphery(IDENTITY, tracked, moved, trust, tracked[:5], 40)[..., 0]
    np.testing.assert_allclose(carried[:30], 20, rtol=1e-4)
    np.testing.assert_array_equal(carried[50:70], 0)
    one = lost.copy()
    one[:, 1:] = True  # the first alone is lost: it goes elsewhere, and the others outvote it little by little
    elsewhere = moved.copy()
    elsewhere[:, 0] = (-200.0, 0.0)
    near = carry_periphery(IDENTITY, tracked, elsewhere, tracked_weights(one), tracked[:1], 40)[:, 0, 0]
    assert np.abs(np.diff(near)).max() < 0.2 * np.ptp(near)


@pytest.mark.parametrize(("tracks", "points"), [(0, 5), (5, 0), (0, 0)])
def test_without_tracks_the_periphery_rests(tracks: int, points: int) -> None:
    carried = carry_periphery(
        IDENTITY, np.zeros((tracks, 2)), np.ones((3, tracks, 2)), np.ones((3, tracks)), np.zeros((points, 2)), 40
    )
    assert carried.shape == (3, points, 2) and not carried.any()


def test_when_no_track_is_trusted_the_periphery_rests(tracked: NDArray) -> None:
    carried = carry_periphery(IDENTITY, tracked, np.full((2, 60, 2), 9.0), np.zeros((2, 60)), tracked[:5], 40)
    np.testing.assert_array_equal(carried, 0)
