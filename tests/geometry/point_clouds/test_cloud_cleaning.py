"""Lone points and small pieces go, and noise becomes less."""

import numpy as np

from engine.geometry.point_clouds.cloud_cleaning import crowded, in_large_pieces, smoothed_along_normals
from engine.geometry.point_clouds.point_cloud import PointCloud


def plane(count: int, noise: float = 0.0) -> PointCloud:
    """A square metre at y = 0, seen from above."""
    rng = np.random.default_rng(5)
    points = np.stack([rng.uniform(0, 1, count), rng.normal(0, noise, count), rng.uniform(0, 1, count)], axis=-1)
    normals = np.tile(np.float32([0, 1, 0]), (count, 1))
    return PointCloud(points.astype(np.float32), normals, np.zeros((count, 3), np.uint8))


def with_points(cloud: PointCloud, points: list[list[float]]) -> PointCloud:
    more = np.float32(points)
    up = np.tile(np.float32([0, 1, 0]), (len(more), 1))
    return PointCloud(
        np.concatenate([cloud.points, more]),
        np.concatenate([cloud.normals, up]),
        np.concatenate([cloud.colours, np.zeros((len(more), 3), np.uint8)]),
    )


def test_a_point_by_itself_is_not_crowded() -> None:
    cloud = with_points(plane(10000), [[0.5, 0.2, 0.5]])
    found = crowded(cloud, 0.03, 6)
    assert found[:-1].mean() > 0.99
    assert not found[-1]


def test_pieces_are_judged_by_the_largest() -> None:
    crumb = (np.array([0.5, 0.3, 0.5]) + np.random.default_rng(1).uniform(0, 0.02, (50, 3))).tolist()
    found = in_large_pieces(with_points(plane(10000), crumb), 0.03, 0.01)
    assert found[:-50].all()
    assert not found[-50:].any()


def test_smoothing_lessens_noise_and_leaves_what_is_plane() -> None:
    noisy = smoothed_along_normals(plane(20000, 0.003), 0.03)
    assert noisy.points[:, 1].std() < 0.003 / 2
    exact = plane(20000)
    assert np.abs(smoothed_along_normals(exact, 0.03).points - exact.points).max() < 1e-6


def test_the_other_side_of_a_sheet_does_not_count() -> None:
    above, below = plane(10000), plane(10000)
    back = PointCloud(below.points - np.float32([0, 0.005, 0]), -below.normals, below.colours)
    both = PointCloud(
        *(
            np.concatenate(pair)
            for pair in ((above.points, back.points), (above.normals, back.normals), (above.colours, back.colours))
        )
    )
    assert np.abs(smoothed_along_normals(both, 0.03).points - both.points).max() < 1e-6


def test_an_empty_cloud_has_nothing_to_clean() -> None:
    nothing = plane(0)
    assert crowded(nothing, 0.1, 3).shape == in_large_pieces(nothing, 0.1, 0.1).shape == (0,)
