"""Inverse maps of deformed meshes: against affine maps, whose inverse is known, and a plain per-pixel search."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.spatial import Delaunay

from engine.imaging.warping.mesh_warp import inverse_map

SHAPE = (40, 56)


def grid(step: float = 8.0, margin: float = 0.0) -> NDArray[np.float32]:
    xs = np.arange(-margin, SHAPE[1] - 1 + margin + step, step)
    ys = np.arange(-margin, SHAPE[0] - 1 + margin + step, step)
    return np.stack(np.meshgrid(xs, ys), axis=-1).reshape(-1, 2).astype(np.float32)


def pixels() -> NDArray[np.float64]:
    ys, xs = np.mgrid[: SHAPE[0], : SHAPE[1]]
    return np.stack([xs, ys], axis=-1).astype(float)


@pytest.fixture(scope="module")
def mesh() -> tuple[NDArray[np.float32], NDArray[np.int32]]:
    points = grid(margin=40)
    return points, Delaunay(points).simplices.astype(np.int32)


@pytest.mark.parametrize(
    ("linear", "shift"),
    [
        (np.eye(2), (0.0, 0.0)),
        (np.eye(2), (3.25, -1.5)),
        (np.array([[0.9, -0.3], [0.3, 0.9]]), (5.0, 2.0)),
        (np.array([[1.3, 0.2], [0.0, 0.8]]), (-6.0, 4.0)),
        (np.array([[-1.0, 0.0], [0.0, 1.0]]), (55.0, 0.0)),
    ],
    ids=["identity", "shift", "similarity", "shear", "mirror"],
)
def test_the_inverse_of_an_affine_map_is_recovered(mesh, linear, shift) -> None:
    points, triangles = mesh
    origin = inverse_map((points @ linear.T + shift).astype(np.float32), points, triangles, SHAPE)
    expected = (pixels() - shift) @ np.linalg.inv(linear).T
    np.testing.assert_allclose(origin, expected, atol=2e-3)


def test_every_pixel_is_covered_up_to_the_border() -> None:
    """A mesh that ends at the outermost pixels' centres leaves none of them out, nor a seam inside."""
    xs, ys = np.linspace(0, SHAPE[1] - 1, 7), np.linspace(0, SHAPE[0] - 1, 5)
    points = np.stack(np.meshgrid(xs, ys), axis=-1).reshape(-1, 2).astype(np.float32)
    origin = inverse_map(points, points, Delaunay(points).simplices.astype(np.int32), SHAPE)
    np.testing.assert_allclose(origin, pixels(), atol=1e-3)


def test_no_pixel_is_missed_between_the_triangles_of_a_bent_mesh() -> None:
    rng = np.random.default_rng(1)
    points = grid(margin=16)
    triangles = Delaunay(points).simplices.astype(np.int32)
    moved = (points + rng.uniform(-2.5, 2.5, points.shape)).astype(np.float32)
    assert (inverse_map(moved, points, triangles, SHAPE) > -1000).all()


def test_a_bent_mesh_agrees_with_a_search_of_every_triangle() -> None:
    rng = np.random.default_rng(2)
    points = grid(margin=16)
    triangles = Delaunay(points).simplices.astype(np.int32)
    moved = points + rng.uniform(-2.5, 2.5, points.shape).astype(np.float32)
    origin = inverse_map(moved.astype(np.float32), points, triangles, SHAPE)
    for x, y in rng.integers(0, (SHAPE[1], SHAPE[0]), (200, 2)):
        a, b, c = (moved[triangles[:, k]].astype(float) for k in range(3))
        d = (b[:, 0] - a[:, 0]) * (c[:, 1] - a[:, 1]) - (b[:, 1] - a[:, 1]) * (c[:, 0] - a[:, 0])
        wb = ((x - a[:, 0]) * (c[:, 1] - a[:, 1]) - (y - a[:, 1]) * (c[:, 0] - a[:, 0])) / d
        wc = ((b[:, 0] - a[:, 0]) * (y - a[:, 1]) - (b[:, 1] - a[:, 1]) * (x - a[:, 0])) / d
        t = int(np.argmax(np.minimum.reduce([1 - wb - wc, wb, wc])))  # the one it is deepest inside of
        weights = np.array([1 - wb[t] - wc[t], wb[t], wc[t]])
        np.testing.assert_allclose(origin[y, x], weights @ points[triangles[t]], atol=5e-3)


@pytest.mark.parametrize("nearer", [0, 1])
@pytest.mark.parametrize("order", [1, -1])
def test_where_triangles_overlap_the_nearer_one_is_seen(nearer: int, order: int) -> None:
    corners = np.array([[-5, -5], [150, -5], [-5, 150]], np.float32)
    out = np.concatenate([corners, corners])
    source = np.repeat([[1.0], [2.0]], 3, axis=0).astype(np.float32)
    depth = np.repeat([1.0, 0.0] if nearer else [0.0, 1.0], 3).astype(np.float32)
    triangles = np.array([[0, 1, 2], [3, 4, 5]], np.int32)[::order]
    assert (inverse_map(out, source, triangles, SHAPE, depth) == nearer + 1).all()


def test_crossing_triangles_are_seen_each_where_it_is_nearer() -> None:
    corners = np.array([[0, -50], [56, -50], [0, 200], [56, 200]], np.float32)
    triangles = np.array([[0, 1, 2], [1, 3, 2], [4, 5, 6], [5, 7, 6]], np.int32)
    depth = np.array([0, 1, 0, 1, 1, 0, 1, 0], np.float32)  # equal in the middle, x = 28
    source = np.repeat([[1.0], [2.0]], 4, axis=0).astype(np.float32)
    seen = inverse_map(np.concatenate([corners, corners]), source, triangles, SHAPE, depth)[..., 0]
    assert (seen[:, :28] == 1).all() and (seen[:, 29:] == 2).all()


def test_without_depth_the_first_triangle_stays() -> None:
    corners = np.array([[-5, -5], [150, -5], [-5, 150]], np.float32)
    source = np.repeat([[1.0], [2.0]], 3, axis=0).astype(np.float32)
    triangles = np.array([[3, 4, 5], [0, 1, 2]], np.int32)
    assert (inverse_map(np.concatenate([corners, corners]), source, triangles, SHAPE) == 2).all()


@pytest.mark.parametrize("outside", [-1.0e4, 7.0])
def test_pixels_that_nothing_covers_get_the_outside_value(outside: float) -> None:
    square = np.array([[10, 8], [20, 8], [20, 18], [10, 18]], np.float32)
    triangles = np.array([[0, 1, 2], [0, 2, 3]], np.int32)
    origin = inverse_map(square, square, triangles, SHAPE, outside=outside)
    covered = np.zeros(SHAPE, bool)
    covered[8:19, 10:21] = True
    assert (origin[~covered] == outside).all()
    np.testing.assert_allclose(origin[covered], pixels()[covered], atol=1e-3)


def test_triangles_without_area_and_empty_meshes_cover_nothing() -> None:
    line = np.array([[0, 0], [10, 10], [20, 20]], np.float32)
    assert (inverse_map(line, line, np.array([[0, 1, 2]], np.int32), SHAPE) == -1.0e4).all()
    assert (inverse_map(line, line, np.zeros((0, 3), np.int32), SHAPE) == -1.0e4).all()


def test_any_attribute_is_interpolated() -> None:
    """C channels, linear over each triangle: here a plane, exactly."""
    points = grid(margin=8)
    plane = np.column_stack([points[:, 0] + points[:, 1], 2 * points[:, 0], np.ones(len(points))]).astype(np.float32)
    field = inverse_map(points, plane, Delaunay(points).simplices.astype(np.int32), SHAPE)
    x, y = pixels()[..., 0], pixels()[..., 1]
    np.testing.assert_allclose(field, np.stack([x + y, 2 * x, np.ones_like(x)], axis=-1), atol=2e-3)
