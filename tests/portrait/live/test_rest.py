"""The rest of the face before the camera: calm frames alone make it, and their median is it."""

from __future__ import annotations

import cv2
import numpy as np
import pytest
from numpy.typing import NDArray

from engine.face_animation.motion_transfer.lids_and_lips import LID_EDGE_VERTEX_PAIRS
from engine.perception.face.head_pose import canonical_face
from engine.perception.face_track.face_crop import CROP_SHAPE, FaceCrop, crop_place
from engine.portrait.live.rest import MAX_WAIT_SECONDS, Calibration, RestCalibration, median_look

EYE_DISTANCE = 60.0


def look(mesh: NDArray[np.floating]) -> FaceCrop:
    mesh = np.asarray(mesh, np.float32)
    return FaceCrop(mesh, crop_place(mesh), np.zeros((*CROP_SHAPE, 3), np.uint8))


def face(yaw: float = 0.0, shift: tuple[float, float] = (0, 0)) -> NDArray[np.float64]:
    """The canonical face in a frame, turned by some degrees."""
    turned = canonical_face() @ np.asarray(cv2.Rodrigues(np.array([0, np.deg2rad(yaw), 0.0]))[0]).T
    return np.asarray(turned * EYE_DISTANCE + (320 + shift[0], 240 + shift[1], 0), float)


def blinking() -> NDArray[np.float64]:
    shut = face()
    upper, lower = np.array(LID_EDGE_VERTEX_PAIRS).T
    shut[upper] = shut[lower]
    return shut


def speaking() -> NDArray[np.float64]:
    mesh = face()
    mesh[14, 1] += 0.3 * EYE_DISTANCE
    return mesh


def calibrated(meshes: list[NDArray[np.float64]], fps: float = 20) -> list[Calibration]:
    calibration = RestCalibration()
    return [calibration(look(mesh), k / fps) for k, mesh in enumerate(meshes)]


def test_a_calm_second_is_a_rest() -> None:
    found = calibrated([face()] * 30)
    first = next(k for k, one in enumerate(found) if one.rest is not None)
    assert 19 <= first <= 21
    assert [one.fraction for one in found[:first]] == sorted(one.fraction for one in found[:first])
    rest = found[first].rest
    assert rest is not None
    np.testing.assert_allclose(rest.mesh, face(), atol=1e-3)


@pytest.mark.parametrize(
    ("mesh", "obstacle"), [(face(yaw=30), "turned"), (blinking(), "eyes_shut"), (speaking(), "mouth_open")]
)
def test_what_is_not_calm_makes_no_rest_and_says_why(mesh: NDArray[np.float64], obstacle: str) -> None:
    found = calibrated([mesh] * 60)
    assert {one.obstacle for one in found} == {obstacle}
    assert all(one.rest is None for one in found)


def test_of_a_face_that_never_is_calm_the_calmest_frames_are_the_rest_after_a_while() -> None:
    less, fps = face(), 20
    less[14, 1] += 0.15 * EYE_DISTANCE
    found = calibrated([less if k % 3 == 0 else speaking() for k in range(int((MAX_WAIT_SECONDS + 1) * fps))], fps)
    first = next(k for k, one in enumerate(found) if one.rest is not None)
    assert first == pytest.approx(MAX_WAIT_SECONDS * fps, abs=2)
    rest = found[first].rest
    assert rest is not None
    np.testing.assert_allclose(rest.mesh, less, atol=1e-3)


def test_a_head_that_moves_fast_is_not_calm() -> None:
    found = calibrated([face(shift=(40.0 * (k % 2), 0)) for k in range(40)])
    assert {one.obstacle for one in found[1:]} == {"moving"} and found[-1].rest is None


def test_a_blink_among_calm_frames_costs_its_own_time_alone() -> None:
    found = calibrated([face()] * 10 + [blinking()] * 3 + [face()] * 20)
    first = next(k for k, one in enumerate(found) if one.rest is not None)
    assert 22 <= first <= 25


def test_the_median_leaves_out_who_blinks_half_and_where_the_head_was() -> None:
    half = (face() + blinking()) / 2
    meshes = [face(shift=(2.0 * k, k)) for k in range(5)] + [half]
    rest = median_look([look(mesh) for mesh in meshes])
    at_origin = rest.mesh - rest.mesh.mean(axis=0)
    np.testing.assert_allclose(at_origin, face() - face().mean(axis=0), atol=0.02)
