"""Cameras: what they see where, and that pixels and rays are each other's inverse."""

from dataclasses import replace

import cv2
import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from engine.geometry.camera import Camera
from engine.geometry.registration.rigid import Similarity

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
    coarse, fine = camera.project(points), camera.scaled(3).project(points)
    np.testing.assert_allclose((fine[:, :2] - 1) / 3, coarse[:, :2], atol=1e-4)


LENSES = {
    "none": (),
    "barrel": (-0.28, 0.09, 0.0012, -0.0008),
    "phone": (0.11, -0.24, -0.0005, 0.001, 0.13),
    "pincushion": (0.2, 0.05, 0.003, 0.004, 0.01),
}


def lens(name: str) -> Camera:
    """A camera that stands anywhere and has pixels that are not square."""
    return replace(START, distortion=LENSES[name], aspect=1.07).aimed((1.0, 2.0, 2.5), TARGET)


def points_before(camera: Camera, count: int = 200) -> np.ndarray:
    """All over the picture and at all distances, told by their rays without distortion."""
    random = np.random.default_rng(3)
    away = random.uniform(0.5, 8, count)
    x, y = random.uniform(-0.42, 0.42, count), random.uniform(-0.32, 0.32, count)
    return np.array(camera.eye) + np.stack([x * away, y * away, -away], 1) @ np.array(camera.axes)


@pytest.mark.parametrize("name", LENSES)
def test_points_are_seen_where_opencv_sees_them(name: str) -> None:
    camera = lens(name)
    points = points_before(camera)
    turn = cv2.Rodrigues(camera.rotation)[0]
    expected, _ = cv2.projectPoints(points, turn, camera.translation, camera.intrinsics, np.array(camera.distortion or [0.0] * 4))  # fmt: skip
    found = camera.project(points, np.float64)
    np.testing.assert_allclose(found[:, :2], expected[:, 0], atol=1e-8)
    np.testing.assert_allclose(found[:, 2], points @ camera.rotation[2] + camera.translation[2], atol=1e-12)
    np.testing.assert_array_equal(camera.project(points), found.astype(np.float32))


@pytest.mark.parametrize("name", LENSES)
def test_unprojecting_is_the_inverse_of_projecting(name: str) -> None:
    camera = lens(name)
    points = points_before(camera).reshape(20, 10, 3)
    seen = camera.project(points, np.float64)
    np.testing.assert_allclose(camera.unproject(seen[..., :2], seen[..., 2]), points, atol=1e-9)
    np.testing.assert_allclose(camera.depth(points), seen[..., 2], atol=1e-12)
    rays = camera.rays(seen[:, 0, :2])
    np.testing.assert_allclose(camera.eye + rays * seen[:, 0, 2:], points[:, 0], atol=1e-9)


def test_one_depth_for_all_pixels_is_a_plane_before_the_camera() -> None:
    pixels = np.random.default_rng(0).uniform(0, 400, (5, 2))
    plane = lens("barrel").unproject(pixels, 2.5)
    np.testing.assert_allclose(lens("barrel").depth(plane), 2.5)


@pytest.mark.parametrize("distortion", [(-0.3, 0.0, 0.0, 0.0), (0.05, -0.01, 0.0, 0.0), (-0.2, 0.04, 0.0, 0.0, -0.02)])
def test_what_is_further_aside_is_seen_further_out_even_where_the_lens_s_polynomial_turns_back(
    distortion: tuple[float, ...],
) -> None:
    camera = replace(START, distortion=distortion).aimed((0.0, 0.0, 3.0), (0.0, 0.0, 0.0))
    angles = np.radians(np.linspace(0, 89, 400))
    around = np.array([0.6, 0.8]) * np.sin(angles)[:, None]
    seen = camera.project(np.column_stack([around, 3 - np.cos(angles)]), np.float64)[:, :2] - camera.centre
    out = np.hypot(seen[:, 0] / camera.focal, seen[:, 1] / (camera.focal * camera.aspect))
    assert (np.diff(out) >= 0).all() and out[-1] > 10


def test_where_a_lens_shows_nothing_there_is_no_point() -> None:
    """A barrel that folds back shows nothing further out than where it does."""
    camera = replace(START, distortion=(-0.5, 0.0, 0.0, 0.0))
    assert np.isnan(camera.unproject(np.array([[5000.0, 200.0]]), 1.0)).all()


@pytest.mark.parametrize("name", LENSES)
def test_a_camera_is_made_of_its_matrices_again(name: str) -> None:
    camera = lens(name)
    again = Camera.of_matrices(camera.intrinsics, camera.rotation, camera.translation, camera.size, camera.distortion)
    points = points_before(camera)
    np.testing.assert_allclose(again.project(points, np.float64), camera.project(points, np.float64), atol=1e-8)
    np.testing.assert_allclose(again.eye, camera.eye, atol=1e-12)
    assert (again.size, again.distortion) == (camera.size, camera.distortion)


def test_a_known_camera_of_vision_sees_a_point_where_it_should() -> None:
    """y down and z forwards: what lies right, below and before the camera is right and below in the picture."""
    intrinsics = np.array([[500.0, 0, 320], [0, 500, 240], [0, 0, 1]])
    camera = Camera.of_matrices(intrinsics, np.eye(3), np.zeros(3), (480, 640))
    np.testing.assert_allclose(camera.project(np.array([[0.2, 0.4, 2.0]])), [[370, 340, 2]])


def test_skew_and_lenses_of_other_models_are_refused() -> None:
    with pytest.raises(ValueError, match="skew"):
        Camera.of_matrices(np.array([[500.0, 3, 320], [0, 500, 240], [0, 0, 1]]), np.eye(3), np.zeros(3), (480, 640))
    with pytest.raises(ValueError, match="coefficients"):
        replace(START, distortion=(0.1, 0.2))


def test_what_is_nearer_than_allowed_is_seen_as_at_that_distance() -> None:
    camera = Camera((0, 0, 0), 100.0, (0.0, 0.0), (10, 10))
    seen = camera.project(np.array([[0.1, 0, -0.5], [0.1, 0, -0.01], [0.1, 0, 3.0]]), np.float64, 0.1)
    np.testing.assert_allclose(seen[:, 0], [20, 100, 100])
    np.testing.assert_allclose(seen[:, 2], [0.5, 0.01, -3.0])


@pytest.mark.parametrize("name", LENSES)
def test_a_resized_or_cut_picture_has_its_camera(name: str) -> None:
    camera, points = lens(name), points_before(lens(name))
    seen = camera.project(points, np.float64)[:, :2]
    small = camera.scaled(0.5)
    np.testing.assert_allclose((small.project(points, np.float64)[:, :2] + 0.5) * 2 - 0.5, seen, atol=1e-9)
    assert small.size == (240, 320)
    part = camera.cropped(30, 50, (100, 120))
    np.testing.assert_allclose(part.project(points, np.float64)[:, :2] + [30, 50], seen, atol=1e-9)
    assert part.size == (100, 120)


def test_the_projection_matrix_sees_points_where_the_camera_does() -> None:
    camera = Camera((0.3, 1.2, 2.0), 500.0, (100.0, 80.0), (160, 200), aspect=1.1).aimed(
        (0.5, 1.4, 1.8), (0.0, 1.0, 0.1)
    )
    points = np.random.default_rng(5).normal([0, 1, 0], 0.3, (20, 3))
    seen = np.c_[points, np.ones(20)] @ camera.projection.T
    assert np.allclose(np.c_[seen[:, :2] / seen[:, 2:], seen[:, 2]], camera.project(points, np.float64))


def test_a_moved_camera_sees_moved_points_where_it_saw_them() -> None:
    camera = Camera((0.3, 1.2, 2.0), 500.0, (100.0, 80.0), (160, 200)).aimed((0.5, 1.4, 1.8), (0.0, 1.0, 0.1))
    turn = Rotation.from_rotvec([0.2, -0.4, 0.1]).as_matrix()
    motion = Similarity(1.3 * turn, np.array([0.1, -0.2, 0.5]))
    points = np.random.default_rng(5).normal([0, 1, 0], 0.3, (20, 3))
    before, after = camera.project(points, np.float64), camera.moved(motion).project(motion(points), np.float64)
    assert np.allclose(after, before * [1, 1, 1.3])
