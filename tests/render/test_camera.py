"""Cameras and their moves: what stays in place, and that pixels and rays are each other's inverse."""

import numpy as np
import pytest

from engine.render.camera import Camera
from engine.render.camera_moves import MOVES, ORBIT, PERIOD, camera_at

START = Camera(eye=(0.2, 1.5, 3.0), focal=800, centre=(319.5, 200.0), size=(480, 640))
TARGET = (0.1, 0.9, 0.0)


def test_a_camera_aimed_at_a_point_sees_it_in_the_middle_and_stands_level() -> None:
    camera = START.aimed((2.0, 3.0, 1.0), TARGET)
    np.testing.assert_allclose(camera.project(np.array([TARGET]))[0, :2], camera.centre, atol=1e-3)
    axes = np.array(camera.axes)
    np.testing.assert_allclose(axes @ axes.T, np.eye(3), atol=1e-12)
    assert np.linalg.det(axes) == pytest.approx(1)
    assert axes[0, 1] == pytest.approx(0) and axes[1, 1] > 0


def test_the_ray_of_a_points_pixel_passes_through_the_point() -> None:
    camera = START.aimed((1.0, 2.0, 2.5), TARGET)
    points = np.random.default_rng(0).uniform(-0.5, 0.5, (20, 3))
    seen = camera.project(points)
    found = np.array(camera.eye) + camera.rays(seen[:, :2]) * seen[:, 2:]
    np.testing.assert_allclose(found, points, atol=1e-5)


def test_an_upright_camera_is_the_plain_pinhole() -> None:
    point = np.array([[0.5, 1.0, 1.0]])
    np.testing.assert_allclose(START.project(point), [[319.5 + 800 * 0.3 / 2, 200 + 800 * 0.5 / 2, 2.0]], rtol=1e-6)
    assert START.aimed(START.eye, np.array(START.eye) - [0, 0, 1]).axes == START.axes


@pytest.mark.parametrize("move", MOVES)
def test_every_move_starts_from_the_pictures_camera(move: str) -> None:
    start = camera_at(move, START, TARGET, 0.0)
    np.testing.assert_allclose(start.eye, START.eye)
    np.testing.assert_allclose(start.axes, START.axes)
    np.testing.assert_allclose(start.centre, START.centre)
    if move == "fixed":
        assert camera_at(move, START, TARGET, 1.7) == START
    else:
        assert camera_at(move, START, TARGET, PERIOD / 4) != START


def test_an_orbit_keeps_its_distance_its_height_and_the_targets_pixel() -> None:
    side = camera_at("orbit", START, TARGET, PERIOD / 4)
    arms = [np.array(camera.eye) - TARGET for camera in (START, side)]
    assert np.linalg.norm(arms[0]) == pytest.approx(np.linalg.norm(arms[1]))
    assert side.eye[1] == pytest.approx(START.eye[1])
    assert arms[0][[0, 2]] @ arms[1][[0, 2]] == pytest.approx(
        np.cos(np.radians(ORBIT)) * np.linalg.norm(arms[0][[0, 2]]) ** 2
    )
    pixels = [camera.project(np.array([TARGET]))[0] for camera in (START, side)]
    np.testing.assert_allclose(pixels[0], pixels[1], atol=1e-3)


def test_parallax_leaves_the_targets_plane_and_moves_what_lies_behind_it() -> None:
    side = camera_at("parallax", START, TARGET, PERIOD / 4)
    plane = np.array([[x, y, TARGET[2]] for x in (-1, 0, 1) for y in (0, 2)], float)
    np.testing.assert_allclose(side.project(plane), START.project(plane), atol=1e-3)
    behind = plane - [0, 0, 3]
    assert (side.project(behind)[:, 0] - START.project(behind)[:, 0] > 20).all()
