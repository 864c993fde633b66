"""Moves of a camera: what stays in place."""

import numpy as np
import pytest

from engine.geometry.camera import Camera
from engine.render.scene.camera_moves import CAMERA_MOVES, ORBIT_DEGREES, PERIOD_SECONDS, camera_at

START = Camera(eye=(0.2, 1.5, 3.0), focal=800, centre=(319.5, 200.0), size=(480, 640))
TARGET = (0.1, 0.9, 0.0)


@pytest.mark.parametrize("move", CAMERA_MOVES)
def test_every_move_starts_from_the_pictures_camera(move: str) -> None:
    start = camera_at(move, START, TARGET, 0.0)
    np.testing.assert_allclose(start.eye, START.eye)
    np.testing.assert_allclose(start.axes, START.axes)
    np.testing.assert_allclose(start.centre, START.centre)
    if move == "fixed":
        assert camera_at(move, START, TARGET, 1.7) == START
    else:
        assert camera_at(move, START, TARGET, PERIOD_SECONDS / 4) != START


def test_an_orbit_keeps_its_distance_its_height_and_the_targets_pixel() -> None:
    side = camera_at("orbit", START, TARGET, PERIOD_SECONDS / 4)
    arms = [np.array(camera.eye) - TARGET for camera in (START, side)]
    assert np.linalg.norm(arms[0]) == pytest.approx(np.linalg.norm(arms[1]))
    assert side.eye[1] == pytest.approx(START.eye[1])
    assert arms[0][[0, 2]] @ arms[1][[0, 2]] == pytest.approx(
        np.cos(np.radians(ORBIT_DEGREES)) * np.linalg.norm(arms[0][[0, 2]]) ** 2
    )
    pixels = [camera.project(np.array([TARGET]))[0] for camera in (START, side)]
    np.testing.assert_allclose(pixels[0], pixels[1], atol=1e-3)


def test_parallax_leaves_the_targets_plane_and_moves_what_lies_behind_it() -> None:
    side = camera_at("parallax", START, TARGET, PERIOD_SECONDS / 4)
    plane = np.array([[x, y, TARGET[2]] for x in (-1, 0, 1) for y in (0, 2)], float)
    np.testing.assert_allclose(side.project(plane), START.project(plane), atol=1e-3)
    behind = plane - [0, 0, 3]
    assert (side.project(behind)[:, 0] - START.project(behind)[:, 0] > 20).all()
