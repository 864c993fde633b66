"""Cameras: what they see where, and that pixels and rays are each other's inverse."""

import numpy as np
import pytest

from engine.geometry.camera import Camera

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


def test_the_camera_maps_known_points() -> None:
    camera = Camera(eye=(0, 1, 2), focal=100, centre=(49.5, 59.5), size=(120, 100))
    found = camera.project(np.array([[0, 1, 0], [0.5, 1, 0], [0, 1.5, 1]]))
    np.testing.assert_allclose(found, [[49.5, 59.5, 2], [74.5, 59.5, 2], [49.5, 9.5, 1]])


def test_supersampling_looks_at_the_same_view() -> None:
    """The middle of the block of fine pixels is the coarse pixel."""
    camera = Camera(eye=(0, 0, 2), focal=100, centre=(30.0, 20.0), size=(40, 60))
    points = np.random.default_rng(0).uniform(-0.3, 0.3, (20, 3))
    coarse, fine = camera.project(points), camera.enlarged(3).project(points)
    np.testing.assert_allclose((fine[:, :2] - 1) / 3, coarse[:, :2], atol=1e-4)
