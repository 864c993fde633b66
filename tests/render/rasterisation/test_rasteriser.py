"""The rasteriser against a slow reference that tests every triangle at every pixel in exact integers."""

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.spatial import Delaunay

from engine.render.rasterisation.rasteriser import (
    MAX_COORDINATE_PIXELS,
    SUBPIXEL_STEPS,
    barycentrics_at,
    depth_map,
    rasterise,
    triangle_map,
)


def reference(vertices: NDArray, triangles: NDArray, size: tuple[int, int], cull: bool = False):
    """Nearest triangle and depth by brute force, in Python integers and double precision."""
    ys, xs = np.mgrid[: size[0], : size[1]] * SUBPIXEL_STEPS
    ids, depths = np.full(size, -1), np.full(size, np.inf)
    points = np.floor(vertices[:, :2].astype(np.float32) * np.float32(SUBPIXEL_STEPS) + 0.5).astype(np.int64)
    for t, face in enumerate(triangles):
        p, z = points[face], vertices[face, 2].astype(np.float64)
        (dx, dy), (ex, ey) = p[1] - p[0], p[2] - p[0]
        area = dx * ey - dy * ex
        if area == 0 or (cull and area > 0):
            continue
        if area < 0:
            p, z, area = p[[0, 2, 1]], z[[0, 2, 1]], -area
        covered, depth = np.ones(size, bool), np.zeros(size)
        for corner in range(3):
            a, b = p[(corner + 1) % 3], p[(corner + 2) % 3]
            edge = (b[0] - a[0]) * (ys - a[1]) - (b[1] - a[1]) * (xs - a[0])
            top_or_left = b[1] < a[1] or (b[1] == a[1] and b[0] > a[0])
            covered &= (edge > 0) | ((edge == 0) & top_or_left)
            depth += edge / area * z[corner]
        nearer = covered & (depth < depths)
        ids[nearer], depths[nearer] = t, depth[nearer]
    return ids, depths


def soup(rng: np.random.Generator, count: int, size: tuple[int, int]) -> tuple[NDArray, NDArray]:
    """Random triangles, many of them reaching out of the picture."""
    vertices = rng.uniform((-20, -20, 1), (size[1] + 20, size[0] + 20, 9), (3 * count, 3)).astype(np.float32)
    return vertices, np.arange(3 * count).reshape(-1, 3)


@pytest.mark.parametrize("seed", range(5))
@pytest.mark.parametrize("cull", [False, True])
def test_random_triangles_agree_with_brute_force(seed: int, cull: bool) -> None:
    size = (48, 64)
    vertices, triangles = soup(np.random.default_rng(seed), 40, size)
    raster = rasterise(vertices, triangles, size, cull=cull)
    ids, depths = reference(vertices, triangles, size, cull)
    covered = ids >= 0
    assert (raster.triangle == ids).all()
    np.testing.assert_allclose(raster.depth[covered], depths[covered], rtol=1e-5)
    assert np.isinf(raster.depth[~covered]).all()


def test_vertices_on_pixel_centres_agree_with_brute_force() -> None:
    """The fill rule decides every edge here: all vertices lie on whole or half pixels."""
    rng = np.random.default_rng(7)
    vertices = np.concatenate([rng.integers(0, 48, (90, 2)) / 2, rng.uniform(1, 2, (90, 1))], 1).astype(np.float32)
    triangles = np.arange(90).reshape(-1, 3)
    ids, _ = reference(vertices, triangles, (24, 24))
    assert (rasterise(vertices, triangles, (24, 24)).triangle == ids).all()


@pytest.mark.parametrize("seed", range(3))
def test_a_triangulated_rectangle_is_covered_exactly_once(seed: int) -> None:
    """Each triangle alone, counted: no pixel of the rectangle is missed or drawn by two neighbours."""
    rng = np.random.default_rng(seed)
    inner = np.round(rng.uniform(0, 40, (60, 2)) * 2) / 2  # many on pixel centres
    points = np.unique(np.concatenate([inner, [[0, 0], [40, 0], [0, 40], [40, 40]]]), axis=0)
    triangles = Delaunay(points).simplices
    vertices = np.concatenate([points, np.ones((len(points), 1))], 1).astype(np.float32)
    times = sum((rasterise(vertices, face[None], (44, 44)).triangle >= 0).astype(int) for face in triangles)
    expected = np.zeros((44, 44), int)
    expected[:40, :40] = 1  # left and top borders belong to the rectangle, right and bottom ones do not
    assert (times == expected).all()


def test_a_slope_has_its_known_depth_and_barycentrics() -> None:
    vertices = np.array([[0, 0, 10], [20, 0, 30], [0, 20, 50]], np.float32)
    raster = rasterise(vertices, np.array([[0, 1, 2]]), (24, 24))
    assert raster.depth[4, 6] == pytest.approx(10 + 20 * 6 / 20 + 40 * 4 / 20)
    np.testing.assert_allclose(raster.barycentrics[4, 6], [0.5, 0.3, 0.2], atol=1e-6)
    covered = raster.triangle >= 0
    np.testing.assert_allclose(raster.barycentrics[covered].sum(1), 1, atol=1e-6)
    assert not raster.barycentrics[~covered].any()


def test_perspective_depth_is_that_of_the_plane() -> None:
    """A tilted plane z = 2 + x seen through a pinhole: the depth at each pixel is known in closed form."""
    corners = np.array([[-1, -1], [1, -1], [-1, 1], [1, 1]], np.float64)
    z = 2 + corners[:, 0]
    focal, centre = 30.0, 32.0
    vertices = np.stack([focal * corners[:, 0] / z + centre, focal * corners[:, 1] / z + centre, z], 1)
    raster = rasterise(vertices, np.array([[0, 1, 2], [1, 3, 2]]), (64, 64), perspective=True)
    slope = (np.arange(64) - centre) / focal  # x / z
    expected = np.broadcast_to(2 / np.maximum(1 - slope, 0.1), (64, 64))
    covered = raster.triangle >= 0
    assert covered.sum() > 500
    np.testing.assert_allclose(raster.depth[covered], expected[covered], rtol=2e-2)  # vertices are snapped
    blended = (raster.barycentrics * vertices[np.array([[0, 1, 2], [1, 3, 2]])[raster.triangle], 2]).sum(2)
    np.testing.assert_allclose(blended[covered], raster.depth[covered], rtol=1e-4)


def test_triangles_behind_the_eye_or_out_of_reach_are_left_out() -> None:
    behind = np.array([[0, 0, -1], [9, 0, 2], [0, 9, 2]], np.float32)
    far_out = np.array([[0, 0, 1], [MAX_COORDINATE_PIXELS * 2, 0, 1], [0, 9, 1]], np.float32)
    lost = np.array([[0, 0, 1], [np.nan, 0, 1], [0, 9, 1]], np.float32)
    face = np.array([[0, 1, 2]])
    assert (rasterise(behind, face, (8, 8), perspective=True).triangle == -1).all()
    assert (rasterise(far_out, face, (8, 8)).triangle == -1).all()
    assert (rasterise(lost, face, (8, 8)).triangle == -1).all()


def test_the_nearer_triangle_hides_the_other_whatever_their_order() -> None:
    vertices = np.array([[0, 0, 5], [20, 0, 5], [0, 20, 5], [0, 0, 3], [20, 0, 3], [0, 20, 3]], np.float32)
    for order in ([[0, 1, 2], [3, 4, 5]], [[3, 4, 5], [0, 1, 2]]):
        raster = rasterise(vertices, np.array(order), (12, 12))
        assert raster.depth[2, 2] == 3
        assert order[raster.triangle[2, 2]] == [3, 4, 5]


@pytest.mark.parametrize("perspective", [False, True])
def test_depth_map_is_the_rasters_depth(perspective: bool) -> None:
    vertices, triangles = soup(np.random.default_rng(3), 30, (33, 47))
    raster = rasterise(vertices, triangles, (33, 47), perspective)
    assert (depth_map(vertices, triangles, (33, 47), perspective) == raster.depth).all()


@pytest.mark.parametrize("perspective", [False, True])
def test_triangles_alone_and_barycentrics_at_some_pixels_are_the_rasters(perspective: bool) -> None:
    vertices, triangles = soup(np.random.default_rng(4), 30, (33, 47))
    raster = rasterise(vertices, triangles, (33, 47), perspective)
    found = triangle_map(vertices, triangles, (33, 47), perspective)
    assert (found == raster.triangle).all()
    some = np.argwhere(found >= 0)[::3]
    at = tuple(some.T)
    assert (barycentrics_at(vertices, triangles[found[at]], some, perspective) == raster.barycentrics[at]).all()
