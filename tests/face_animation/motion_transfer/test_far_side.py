"""The sheet behind a face that turns: what the face covers keeps its width, and elsewhere there is one sheet."""

from __future__ import annotations

import numpy as np
import pytest
from made_face import placed, turn
from numpy.typing import NDArray

from engine.face_animation.motion_transfer.far_side import FarSide
from engine.face_animation.motion_transfer.head_motion import split_motion
from engine.face_animation.motion_transfer.head_proxy import build_head_proxy, move_head, roll_head
from engine.face_animation.motion_transfer.head_room import skull_centre
from engine.perception.face.landmarks import MESH_SIZE

UNIT, CENTRE, DEGREES = 50.0, (150.0, 120.0), 20.0


def beside_the_cheeks(mesh: NDArray) -> NDArray[np.float64]:
    """Of each side, the right of the face first, a row of points from the cheek's contour outwards."""
    right, left = mesh[234, :2], mesh[454, :2]
    away = np.linspace(0, 0.4, 9)[:, None] * UNIT * np.array([1.0, 0.0])
    return np.concatenate([right - away, left + away]).astype(float)


@pytest.fixture(scope="module")
def turned() -> tuple[NDArray, NDArray, NDArray, NDArray]:
    """Points of a face and beside it; where they go as it turns to the picture's left, with the face and with the skull; how far they withdraw."""
    mesh = placed(UNIT, CENTRE)
    points = np.concatenate([mesh[:, :2].astype(float), beside_the_cheeks(mesh)])
    proxy, pivot = build_head_proxy(points, mesh), skull_centre(mesh)
    motion = split_motion(((mesh - pivot) @ turn(yaw=-DEGREES).T + pivot)[None], mesh)
    carried, skull = move_head(proxy, motion, mesh)[..., :2], roll_head(proxy, motion, mesh)
    return points, carried[0], skull[0], FarSide(mesh, points).withdrawn(carried, skull)[0]


def test_a_face_that_stays_on_its_skull_covers_nothing() -> None:
    mesh = placed(UNIT, CENTRE)
    points = np.concatenate([mesh[:, :2].astype(float), beside_the_cheeks(mesh)])
    there = (points + np.array([7.0, -3.0]))[None]
    np.testing.assert_array_equal(FarSide(mesh, points).withdrawn(there, there), 0)


def test_what_a_cheek_passes_before_keeps_its_width(turned: tuple[NDArray, ...]) -> None:
    points, carried, _, withdrawn = turned
    rows = np.arange(MESH_SIZE, MESH_SIZE + 18).reshape(2, 9)
    far = min(rows, key=lambda row: float(np.ptp(carried[row, 0])))  # the side that one sheet would squeeze
    assert np.ptp(carried[far, 0]) < 0.75 * np.ptp(points[far, 0])
    assert np.ptp((carried + withdrawn)[far, 0]) == pytest.approx(np.ptp(points[far, 0]), rel=0.03)


def test_cheek_and_ear_that_come_nearer_stay_one_sheet(turned: tuple[NDArray, ...]) -> None:
    _, carried, _, withdrawn = turned
    rows = np.arange(MESH_SIZE, MESH_SIZE + 18).reshape(2, 9)
    near = max(rows, key=lambda row: float(np.ptp(carried[row, 0])))
    np.testing.assert_allclose(withdrawn[near], 0, atol=0.02 * UNIT)


def test_the_top_of_the_forehead_covers_no_hair(turned: tuple[NDArray, ...]) -> None:
    np.testing.assert_allclose(turned[3][[10, 338, 297, 109, 67]], 0, atol=1e-6)
