"""Point clouds: what is chosen, joined and thinned is what was there."""

import numpy as np
import pytest

from engine.geometry.point_clouds.point_cloud import PointCloud, joined, thinned


def cloud_of(points: np.ndarray) -> PointCloud:
    count = len(points)
    numbers = np.arange(count, dtype=np.uint8)[:, None].repeat(3, axis=1)
    return PointCloud(points.astype(np.float32), np.tile(np.float32([0, 0, 1]), (count, 1)), numbers)


def test_a_cloud_without_a_normal_for_each_point_is_refused() -> None:
    with pytest.raises(ValueError, match="as many points as normals"):
        PointCloud(np.zeros((3, 3), np.float32), np.zeros((2, 3), np.float32), np.zeros((3, 3), np.uint8))


def test_parts_of_a_cloud_joined_are_the_cloud() -> None:
    whole = cloud_of(np.random.default_rng(1).normal(size=(50, 3)))
    again = joined([whole[:20], whole[np.arange(20, 50)]])
    assert (again.points == whole.points).all()
    assert (again.colours == whole.colours).all()


def test_a_thinned_cloud_has_one_point_a_cell_and_it_is_the_one_nearest_to_the_mean() -> None:
    # two cells of 1 m: in the first the mean is at 0.3, and its second point is nearest to it
    points = np.array([[0.0, 0, 0], [0.2, 0, 0], [0.7, 0, 0], [-0.5, 0, 0]])
    thin = thinned(cloud_of(points), 1.0)
    assert thin.colours[:, 0].tolist() == [1, 3]


def test_a_thinned_cloud_of_the_cells_size_is_itself() -> None:
    grid = np.stack(np.meshgrid(*[np.arange(4) + 0.5] * 3), axis=-1).reshape(-1, 3)
    assert len(thinned(cloud_of(grid), 1.0)) == len(grid)


def test_an_empty_cloud_thinned_is_empty() -> None:
    assert len(thinned(cloud_of(np.zeros((0, 3))), 1.0)) == 0
