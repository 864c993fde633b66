"""Views that agree make points, views that do not make none."""

from dataclasses import replace

import numpy as np
from textured_sphere import CENTRE, RADIUS, ring, seen_depth, seen_points

from engine.geometry.multiview.depth_fusion import Agreement, FusedPoints, fuse_depth_maps
from engine.geometry.multiview.patch_match_stereo import DepthMap

CAMERAS = ring(24)
NEIGHBOURS = [[(i + step) % 24 for step in (1, 2, 22, 23)] for i in range(24)]


def true_map(number: int) -> DepthMap:
    depth = seen_depth(CAMERAS[number]).astype(np.float32)
    normals = (seen_points(CAMERAS[number]) - CENTRE) / RADIUS
    return DepthMap(depth, normals.astype(np.float32), np.zeros(depth.shape, np.float32))


def fused(maps: list[DepthMap], agreement: Agreement | None = None, step: int = 1) -> FusedPoints:
    images = [np.full((*camera.size, 3), number, np.uint8) for number, camera in enumerate(CAMERAS)]
    return fuse_depth_maps(maps, CAMERAS, images, NEIGHBOURS, agreement or Agreement(), step)


def test_true_depths_give_points_of_the_sphere_with_their_normals_and_colours() -> None:
    found = fused([true_map(i) for i in range(24)])
    assert len(found.cloud) > 24 * 4000
    distance = np.linalg.norm(found.cloud.points - CENTRE, axis=1)
    assert np.abs(distance - RADIUS).max() < 0.005  # a pixel is 6 mm wide, and the nearest is asked
    assert np.abs(distance - RADIUS).mean() < 0.0005
    assert (found.cloud.normals * (found.cloud.points - CENTRE)).sum(axis=1).min() > 0
    assert (found.cloud.colours[:, 0] == found.view).all()
    assert found.support.max() == 5


def test_of_a_third_of_rows_and_columns_the_same_points_come() -> None:
    maps = [true_map(i) for i in range(24)]
    every, some = (fused(maps, step=step).cloud.points for step in (1, 3))
    assert len(every) / 10 < len(some) < len(every) / 8
    assert {tuple(point) for point in some} <= {tuple(point) for point in every}


def test_noise_is_less_where_views_agree() -> None:
    rng = np.random.default_rng(2)
    maps = []
    for number in range(24):
        exact = true_map(number)
        noise = rng.normal(0, 0.002, exact.depth.shape).astype(np.float32)
        maps.append(replace(exact, depth=np.where(exact.depth > 0, exact.depth + noise, 0)))
    found = fused(maps)
    error = np.linalg.norm(found.cloud.points - CENTRE, axis=1) - RADIUS
    assert error[found.support == 5].std() < 0.6 * 0.002


def test_a_depth_that_no_other_view_confirms_is_dropped() -> None:
    maps = [true_map(i) for i in range(24)]
    maps[0].depth[50:60, 50:60] -= 0.1  # in front of the sphere: all others look through it
    found = fused(maps)
    distance = np.linalg.norm(found.cloud.points - CENTRE, axis=1)
    assert distance.max() < RADIUS + 0.01
    assert len(found.cloud) < len(fused([true_map(i) for i in range(24)]).cloud)


def test_costly_measurements_do_not_count() -> None:
    """A correlation of less than 0.3 is what plain cloth has with anything."""
    maps = [replace(true_map(i), cost=np.full(CAMERAS[i].size, 0.75, np.float32)) for i in range(24)]
    assert len(fused(maps).cloud) == 0
    assert len(fused(maps, Agreement(cost=2.0)).cloud) > 0
