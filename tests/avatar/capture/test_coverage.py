"""The share of a body that a cloud shows is what was shown of it."""

import numpy as np
import pytest

from engine.avatar.capture.coverage import coverage
from engine.geometry.point_clouds.point_cloud import PointCloud


def cloud_of(points: np.ndarray) -> PointCloud:
    return PointCloud(
        points.astype(np.float32), np.tile(np.float32([0, 0, 1]), (len(points), 1)), np.zeros(points.shape, np.uint8)
    )


def test_each_parts_share_is_that_of_its_vertices_near_points() -> None:
    rng = np.random.default_rng(3)
    vertices = rng.uniform(-0.5, 0.5, (3000, 3)) * [1, 2, 0.3]
    left = vertices[:, 0] < 0
    shown = np.where(left, rng.random(3000) < 0.43, rng.random(3000) < 0.9)
    apart = np.linalg.norm(rng.normal(size=(3000, 3)), axis=1)
    offsets = rng.normal(size=(3000, 3)) / apart[:, None] * 0.0001
    found = coverage(
        vertices, {"left": left, "right": np.flatnonzero(~left)}, cloud_of((vertices + offsets)[shown]), near=0.001
    )
    assert found["left"] == pytest.approx(shown[left].mean(), abs=0.005)
    assert found["right"] == pytest.approx(shown[~left].mean(), abs=0.005)


def test_a_vertex_is_near_up_to_five_millimetres() -> None:
    vertices = np.zeros((1, 3))
    part = {"all": np.array([True])}
    assert coverage(vertices, part, cloud_of(np.array([[0, 0.0049, 0]]))) == {"all": 1.0}
    assert coverage(vertices, part, cloud_of(np.array([[0, 0.0051, 0]]))) == {"all": 0.0}


def test_an_empty_cloud_and_an_empty_part_cover_nothing() -> None:
    vertices = np.zeros((2, 3))
    assert coverage(vertices, {"all": np.array([True, True])}, cloud_of(np.zeros((0, 3)))) == {"all": 0.0}
    assert coverage(vertices, {"none": np.array([False, False])}, cloud_of(np.zeros((1, 3)))) == {"none": 0.0}
