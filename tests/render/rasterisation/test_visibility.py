"""Two squares, one before the other: what is hidden, what is beside an edge, what is outside the picture."""

from __future__ import annotations

import numpy as np

from engine.geometry.camera import Camera
from engine.render.rasterisation.visibility import depth_buffer, seen_points, view_cosines
from engine.render.textures.sampling import bilinear

CAMERA = Camera((0, 0, 0), 100, (49.5, 49.5), (100, 100))
SQUARE = np.array([[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]], float)
POINTS = np.concatenate([SQUARE * 0.2 + [0, 0, -1], SQUARE * 2 + [0, 0, -3]])
FACES = np.array([[0, 1, 2], [0, 2, 3], [4, 5, 6], [4, 6, 7]], np.int32)


def seen(*points: tuple[float, float, float]) -> list[bool]:
    return seen_points(depth_buffer(CAMERA, POINTS, FACES), CAMERA.project(np.array(points))).tolist()


def test_the_nearer_square_hides_the_further() -> None:
    assert seen((0, 0, -1), (0, 0, -3), (1.2, 0, -3)) == [True, False, True]


def test_a_little_behind_is_seen_and_more_is_not() -> None:
    assert seen((0, 0, -1.003), (0, 0, -1.006)) == [True, False]


def test_beside_an_edge_nothing_is_seen() -> None:
    assert seen((0.195, 0, -1), (0.62, 0, -3), (0.15, 0, -1), (0.75, 0, -3)) == [False, False, True, True]


def test_outside_the_picture_and_behind_the_camera_nothing_is_seen() -> None:
    assert seen((5, 0, -3), (0, 0, 1)) == [False, False]


def test_cosines_are_of_the_angle_to_the_camera() -> None:
    points = np.array([[0, 0, -2], [0, 0, -2], [2, 0, -2], [0, 0, 2]], float)
    normals = np.array([[0, 0, 1], [0, 0.6, 0.8], [0, 0, 1], [0, 0, 1]], float)
    np.testing.assert_allclose(view_cosines(CAMERA, points, normals), [1, 0.8, np.sqrt(0.5), -1], atol=1e-6)


def test_colours_between_pixels_are_means_and_go_on_beyond_the_border() -> None:
    picture = np.array([[[0], [100]], [[50], [150]]], np.uint8)
    pixels = np.array([[0, 0], [0.5, 0], [0.25, 0.5], [-3, 9], [np.nan, 0]])
    np.testing.assert_allclose(bilinear(picture, pixels)[:, 0], [0, 50, 50, 50, 0])
