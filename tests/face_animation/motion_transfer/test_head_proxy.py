"""The 3D proxy of the head: depth, belonging to the head, and turns that can be computed by hand."""

from __future__ import annotations

import cv2
import numpy as np
import pytest
from made_face import placed, turn
from numpy.typing import NDArray

from engine.face_animation.motion_transfer.contour import EVEN_BAND_EYE_DISTANCES, rim_distance
from engine.face_animation.motion_transfer.head_motion import HeadMotion, split_motion
from engine.face_animation.motion_transfer.head_proxy import (
    build_head_proxy,
    head_share,
    move_head,
    surface_depth,
)
from engine.face_animation.motion_transfer.head_room import (
    MAX_TURN_RADIANS,
    MIN_TURN_RADIANS,
    limit_rotation,
    max_counter_rotation,
    skull_centre,
    turned_in_picture,
)
from engine.perception.face.head_pose import canonical_face
from engine.perception.face.landmarks import MESH_SIZE, RIGID_VERTICES

UNIT, CENTRE = 50.0, (150.0, 120.0)


@pytest.fixture(scope="module")
def mesh() -> NDArray[np.float32]:
    return placed(UNIT, CENTRE)


def acted(mesh: NDArray, rotation: NDArray, scale: float = 1.0, shift=(0.0, 0.0, 0.0)) -> HeadMotion:
    """A driver with this very face that turns about the middle of its rigid points."""
    pivot = mesh[list(RIGID_VERTICES)].mean(axis=0)
    return split_motion((scale * (mesh - pivot) @ rotation.T + pivot + shift)[None], mesh)


def test_the_proxy_has_the_mesh_s_own_depth_inside_the_face(mesh: NDArray) -> None:
    points = np.concatenate([mesh[:, :2], [[10.0, 10.0]]])
    proxy = build_head_proxy(points, mesh)
    own = rim_distance(mesh, mesh[:, :2]) < -EVEN_BAND_EYE_DISTANCES * UNIT
    assert own.sum() > 250
    np.testing.assert_allclose(proxy.points[:MESH_SIZE][own], mesh[own], atol=1e-4)
    np.testing.assert_array_equal(proxy.points[:MESH_SIZE, :2], mesh[:, :2])
    assert (proxy.share[:MESH_SIZE] == 1).all()


@pytest.mark.parametrize("yaw", [0, 10, 20])
def test_neighbours_beside_the_contour_have_one_depth(yaw: float) -> None:
    """Where a cheek goes out of sight its own depth runs away; a turn would tear it into flaps."""
    face = placed(UNIT, CENTRE, yaw=yaw)
    depth = build_head_proxy(face[:, :2].astype(float), face).points[:MESH_SIZE, 2]
    beside = np.flatnonzero(rim_distance(face, face[:, :2]) > -0.05 * UNIT)
    apart = np.linalg.norm(face[beside, None, :2] - face[None, beside, :2], axis=2)
    close = (apart > 0) & (apart < 0.15 * UNIT)
    slope = np.abs(depth[beside, None] - depth[None, beside])[close] / np.maximum(apart[close], 0.05 * UNIT)
    assert close.sum() > 20
    assert slope.max() < 1 / np.tan(MAX_TURN_RADIANS)  # what the largest turn would fold


def test_depth_beside_the_face_falls_back_to_the_skull_s_middle(mesh: NDArray) -> None:
    """Continuous at the rim, and no further back than that however far out."""
    top = mesh[10].astype(float)
    out = np.array([[top[0], top[1] - d] for d in (0.01, 5.0, 20.0, 60.0, 500.0)])
    depth = surface_depth(mesh, out)
    assert depth[0] == pytest.approx(top[2], abs=0.1 * UNIT)
    assert (np.diff(depth) >= -1e-6).all()
    assert depth[-1] == pytest.approx(skull_centre(mesh)[2], abs=1e-3)


def test_share_is_one_on_the_head_and_fades_down_the_neck(mesh: NDArray) -> None:
    chin = mesh[152, 1]
    y = np.array([0.0, CENTRE[1], chin - 0.15 * UNIT, chin + 0.5 * UNIT, chin + 1.0 * UNIT, chin + 5 * UNIT])
    share = head_share(mesh, np.column_stack([np.full(6, CENTRE[0] + 40), y]))
    assert share[:3] == pytest.approx([1, 1, 1], abs=0.01)
    assert 0 < share[4] < share[3] < 1
    assert share[5] == 0
    line = head_share(mesh, np.column_stack([np.full(300, 100.0), np.linspace(0, 600, 300)]))
    assert (np.diff(line) <= 0).all() and np.abs(np.diff(line)).max() < 0.05


def test_share_follows_a_tilted_head() -> None:
    """Down the neck is down the face, not down the picture."""
    tilted = placed(UNIT, CENTRE, roll=90)  # the chin points to the picture's left
    left, below = head_share(tilted, np.array([[CENTRE[0] - 4 * UNIT, CENTRE[1]], [CENTRE[0], CENTRE[1] + 4 * UNIT]]))
    assert left == 0 and below == 1


@pytest.mark.parametrize("yaw", [-20.0, 10.0])
def test_a_turn_by_hand(mesh: NDArray, yaw: float) -> None:
    """About y through the pivot: x' = px + cos (x - px) - sin (z - pz), y' = y."""
    proxy = build_head_proxy(mesh[:, :2].astype(float), mesh)
    moved = move_head(proxy, acted(mesh, turn(yaw=yaw)), mesh)[0]
    pivot = mesh[list(RIGID_VERTICES)].astype(float).mean(axis=0)
    c, s = np.cos(np.deg2rad(yaw)), np.sin(np.deg2rad(yaw))
    x, z = proxy.points[:, 0] - pivot[0], proxy.points[:, 2] - pivot[2]
    np.testing.assert_allclose(moved[:, 0], pivot[0] + c * x - s * z, atol=0.02)
    np.testing.assert_allclose(moved[:, 1], proxy.points[:, 1], atol=0.02)
    np.testing.assert_allclose(moved[:, 2], pivot[2] + s * x + c * z, atol=0.02)
    assert np.sign(moved[4, 0] - mesh[4, 0]) == np.sign(yaw)  # the nose goes where the face turns to


@pytest.mark.parametrize(("yaw", "roll"), [(20, 0), (-12, 15), (0, 30)])
def test_the_outline_of_the_skull_stays_as_wide_and_turns_in_the_plane(mesh: NDArray, yaw: float, roll: float) -> None:
    far = np.array([[CENTRE[0] - 3 * UNIT, CENTRE[1]], [CENTRE[0] + 3 * UNIT, CENTRE[1]]])
    proxy = build_head_proxy(np.concatenate([mesh[:, :2], far]).astype(float), mesh)
    right, left = move_head(proxy, acted(mesh, turn(yaw=yaw, roll=roll)), mesh)[0, MESH_SIZE:, :2]
    assert np.linalg.norm(left - right) == pytest.approx(6 * UNIT, rel=1e-3)
    assert np.rad2deg(np.arctan2(*(left - right)[::-1])) == pytest.approx(roll, abs=0.7)


@pytest.mark.parametrize("yaw", [-20.0, 20.0])
def test_an_ear_that_turns_towards_the_viewer_is_not_drawn_out(mesh: NDArray, yaw: float) -> None:
    """From the contour to beyond the ear: on the near side no part becomes twice as wide, on the far one nothing folds over."""
    row = [np.linspace(mesh[rim, 0], mesh[rim, 0] + side * 1.1 * UNIT, 12) for rim, side in ((234, -1), (454, 1))]
    level = float(mesh[[234, 454], 1].mean())
    beside = np.column_stack([np.concatenate(row), np.full(24, level)])
    proxy = build_head_proxy(np.concatenate([mesh[:, :2], beside]).astype(float), mesh)
    moved = move_head(proxy, acted(mesh, turn(yaw=yaw)), mesh)[0, MESH_SIZE:, 0].reshape(2, 12)
    stretch = np.diff(moved) / np.diff(beside[:, 0].reshape(2, 12))
    near, far = stretch if yaw > 0 else stretch[::-1]
    assert (np.abs(moved - beside[:, 0].reshape(2, 12)) > 1).any()
    assert near.max() < 1.85 and far.min() > 0


def test_around_the_skull_a_turn_leaves_no_step(mesh: NDArray) -> None:
    """What is on the near side passes over into what is not."""
    around = np.deg2rad(np.arange(0, 360, 2.0))
    ring = skull_centre(mesh)[:2] + UNIT * np.column_stack([2.0 * np.cos(around), 2.8 * np.sin(around)])
    proxy = build_head_proxy(np.concatenate([mesh[:, :2], ring]).astype(float), mesh)
    for motion in (turn(yaw=20), turn(yaw=15, pitch=10)):
        offsets = (move_head(proxy, acted(mesh, motion), mesh)[0, MESH_SIZE:, :2]) - ring
        steps = np.linalg.norm(np.diff(offsets, axis=0, append=offsets[:1]), axis=1)
        assert steps.max() < 0.01 * UNIT


def test_scale_and_shift_are_carried_in_the_target_s_own_size(mesh: NDArray) -> None:
    """The driver's face is half as large: what it moves by, the target moves by twice."""
    target = placed(2 * UNIT, (300.0, 300.0))
    proxy = build_head_proxy(target[:, :2], target)
    moved = move_head(proxy, acted(mesh, turn(), 1.1, (6.0, -4.0, 0.0)), target)[0]
    pivot = target[list(RIGID_VERTICES)].mean(axis=0)
    expected = 1.1 * (target - pivot) + pivot + (12.0, -8.0, 0.0)
    np.testing.assert_allclose(moved[:, :2], expected[:, :2], atol=0.05)


def test_a_head_at_rest_stays(mesh: NDArray) -> None:
    target = placed(80, (200, 220), yaw=8, roll=-6)
    proxy = build_head_proxy(target[:, :2], target)
    np.testing.assert_allclose(move_head(proxy, acted(mesh, turn()), target)[0], proxy.points, atol=0.02)


def test_expressions_turn_with_the_head(mesh: NDArray) -> None:
    proxy = build_head_proxy(mesh[:, :2], mesh)
    expression = np.zeros((1, MESH_SIZE, 3), np.float32)
    expression[0, 14] = (0, 0, -10)  # a lip thrust out towards the viewer
    motion = acted(mesh, turn(yaw=20))
    offset = move_head(proxy, motion, mesh, expression)[0, 14] - move_head(proxy, motion, mesh)[0, 14]
    np.testing.assert_allclose(offset, turn(yaw=20) @ (0, 0, -10), atol=0.01)


@pytest.mark.parametrize("degrees", [0.0, 5.0, 19.0])
@pytest.mark.parametrize("axis", ["yaw", "pitch"])
def test_small_turns_are_kept(degrees: float, axis: str) -> None:
    rotation = turn(**{axis: degrees})
    np.testing.assert_allclose(limit_rotation(rotation[None])[0], rotation, atol=1e-12)


@pytest.mark.parametrize("roll", [-80.0, 45.0])
def test_turns_in_the_picture_plane_are_not_limited(roll: float) -> None:
    np.testing.assert_allclose(limit_rotation(turn(roll=roll)[None])[0], turn(roll=roll), atol=1e-12)


def test_large_turns_are_held_back_softly() -> None:
    """Never beyond the limit, never backwards, and without a kink."""
    asked = np.linspace(0, 80, 161)
    held = limit_rotation(np.stack([turn(yaw=a) for a in asked]))
    angles = np.array([cv2.Rodrigues(r)[0][1, 0] for r in held])
    angles = np.rad2deg(np.abs(angles))
    assert angles.max() <= np.rad2deg(MAX_TURN_RADIANS) + 1e-9
    assert angles.max() > 0.99 * np.rad2deg(MAX_TURN_RADIANS)
    assert (np.diff(angles) >= -1e-9).all()
    assert np.abs(np.diff(angles, 2)).max() < 0.1


@pytest.mark.parametrize("side", [-1, 1])
def test_a_face_that_is_turned_has_less_room_to_that_side_and_a_little_more_to_turn_back(side: int) -> None:
    own = 0.0, side * np.deg2rad(20)
    further, back = limit_rotation(np.stack([turn(yaw=40), turn(yaw=-40)])[::-side], own)
    angles = [float(np.rad2deg(np.linalg.norm(cv2.Rodrigues(r)[0]))) for r in (further, back)]
    assert angles[0] == pytest.approx(np.rad2deg(MIN_TURN_RADIANS), rel=0.02)
    assert angles[1] == pytest.approx(np.rad2deg(max_counter_rotation(np.deg2rad(20))), rel=0.02)


def test_how_a_face_is_turned_in_its_picture() -> None:
    face = 100 * canonical_face().astype(float) @ turn(yaw=17).T
    x, y = turned_in_picture(face)
    assert (abs(x), abs(y)) == pytest.approx((0, np.deg2rad(17)), abs=1e-3)
