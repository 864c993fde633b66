"""Normals, charts and bumps of surfaces one can write down."""

import numpy as np

from engine.render.camera import Camera
from engine.render.film import develop, shrink
from engine.render.surface import bump, chart_tangents, triangulate, vertex_normals


def test_a_spheres_normals_point_from_its_middle() -> None:
    u, v = np.meshgrid(np.linspace(0, 2 * np.pi, 61), np.linspace(0.3, np.pi - 0.3, 41))
    points = np.stack([np.sin(v) * np.cos(u), np.cos(v), np.sin(v) * np.sin(u)], -1)
    index = np.arange(61 * 41).reshape(41, 61)
    quads = np.stack([index[:-1, :-1], index[:-1, 1:], index[1:, 1:], index[1:, :-1]], -1).reshape(-1, 4)
    flat = points.reshape(-1, 3)
    normals = vertex_normals(flat, triangulate(quads)).reshape(points.shape)[3:-3, 3:-3]
    np.testing.assert_allclose((normals * points[3:-3, 3:-3]).sum(-1), 1, atol=2e-3)


def test_tangents_of_a_stretched_sheet() -> None:
    u, v = np.meshgrid(np.linspace(0, 1, 9), np.linspace(0, 1, 7))
    sheet = np.stack([3 * u, 0.5 * v, u + v], -1).reshape(-1, 3)
    index = np.arange(63).reshape(7, 9)
    quads = np.stack([index[:-1, :-1], index[:-1, 1:], index[1:, 1:], index[1:, :-1]], -1).reshape(-1, 4)
    chart = np.stack([u, v], -1).reshape(-1, 2)
    found = chart_tangents(sheet, chart, triangulate(quads))
    np.testing.assert_allclose(found, np.tile([3, 0, 1, 0, 0.5, 1], (63, 1)), atol=1e-5)


def test_a_ramp_tilts_the_normal_by_its_slope() -> None:
    """Height rising by 0.1 for each metre of u on a chart that is stretched fourfold: a slope of 0.025."""
    normals = np.array([[0.0, 0.0, 1.0]])
    tangents = np.array([[4.0, 0, 0, 0, 1, 0]])
    found = bump(normals, tangents, np.array([[0.1, 0.0]]))
    expected = np.array([-0.025, 0, 1]) / np.hypot(0.025, 1)
    np.testing.assert_allclose(found[0], expected, atol=1e-6)


def test_a_mirrored_chart_gives_the_same_relief() -> None:
    normals = np.array([[0.0, 0.0, 1.0]])
    found = bump(normals, np.array([[-4.0, 0, 0, 0, 1, 0]]), np.array([[-0.1, 0.0]]))
    np.testing.assert_allclose(found[0, 0], -0.025 / np.hypot(0.025, 1), atol=1e-6)


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


def test_film_keeps_middle_tones_and_rolls_off_highlights() -> None:
    steps = np.linspace(0, 8, 400, dtype=np.float32)
    shown = develop(np.repeat(steps[None, :, None], 3, 2), exposure=1.0)[0, :, 0].astype(int)
    assert (np.diff(shown) >= 0).all()
    assert shown[0] == 0 and 250 <= shown[-1] <= 255
    middle = develop(np.full((1, 1, 3), 0.2140, np.float32), exposure=1.0)
    assert (middle == 127).all() or (middle == 128).all()  # half of sRGB's range


def test_shrinking_takes_the_mean() -> None:
    picture = np.arange(16, dtype=np.float32).reshape(4, 4)
    np.testing.assert_allclose(shrink(picture, 2), [[2.5, 4.5], [10.5, 12.5]])
