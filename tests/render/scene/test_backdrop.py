"""A picture as a stage: points of its floor and wall appear where a moved camera must see them."""

import numpy as np
import pytest
from scipy.ndimage import center_of_mass

from engine.geometry.camera import Camera
from engine.render.scene.backdrop import Backdrop
from engine.render.scene.camera_moves import PERIOD_SECONDS, camera_at

CAMERA = Camera((0, 0, 0), 500, (199.5, 129.5), (300, 400)).aimed((0, 1.4, 3), (0, 0.8, 0))
WALL = 6.0


def dotted(point: np.ndarray) -> Backdrop:
    """A black plate with a soft white dot where `CAMERA` sees the point."""
    x, y = CAMERA.project(point[None])[0, :2]
    rows, columns = np.mgrid[:300, :400]
    dot = 255 * np.exp(-((columns - x) ** 2 + (rows - y) ** 2) / 18)
    return Backdrop(dot[..., None].repeat(3, 2).astype(np.uint8), CAMERA, WALL)


def test_the_camera_that_took_the_plate_sees_the_plate() -> None:
    plate = np.random.default_rng(0).integers(0, 256, (300, 400, 3), np.uint8)
    np.testing.assert_array_equal(Backdrop(plate, CAMERA, WALL).seen_by(CAMERA), plate)


def test_a_camera_that_is_the_same_within_rounding_sees_almost_the_plate() -> None:
    plate = np.full((300, 400, 3), 90, np.uint8)
    plate[:, 200:] = 160
    moved = camera_at("orbit", CAMERA, (0, 0.8, 0), 1e-6)
    assert np.abs(Backdrop(plate, CAMERA, WALL).seen_by(moved).astype(int) - plate).mean() < 0.5


@pytest.mark.parametrize("move", ["orbit", "parallax"])
@pytest.mark.parametrize("spot", ["floor", "wall"])
def test_points_of_floor_and_wall_move_as_they_must(move: str, spot: str) -> None:
    axes = np.array(CAMERA.axes)
    point = np.array([0.3, 0.0, 0.2])
    if spot == "wall":
        point = np.array(CAMERA.eye) + axes.T @ np.array([0.4, 0.9, -WALL])
    assert spot == "wall" or (np.array(CAMERA.eye) - point) @ axes[2] < WALL
    moved = camera_at(move, CAMERA, (0, 0.8, 0), PERIOD_SECONDS / 16)
    seen = dotted(point).seen_by(moved)[..., 0].astype(float)
    row, column = center_of_mass(seen)
    x, y = moved.project(point[None])[0, :2]
    assert abs(x - CAMERA.project(point[None])[0, 0]) > 3 or spot == "floor"
    assert abs(column - x) < 1 and abs(row - y) < 1
