"""Triangles over points, against their definition and against Qhull's."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.spatial import ConvexHull, Delaunay

from engine.imaging.warping.delaunay import delaunay


def sizes(points: NDArray, triangles: NDArray) -> NDArray[np.float64]:
    corner, second, third = (points[triangles[:, k]].astype(float) for k in range(3))
    a, b = second - corner, third - corner
    return (a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]) / 2


@pytest.mark.parametrize("scale", [1e-3, 1.0, 1e4])
def test_scattered_points_have_qhulls_triangles(scale: float) -> None:
    points = scale * np.random.default_rng(0).uniform(-3, 5, (400, 2))
    ours, theirs = delaunay(points), Delaunay(points).simplices
    assert {tuple(sorted(t)) for t in ours.tolist()} == {tuple(sorted(t)) for t in theirs.tolist()}
    assert (sizes(points, ours) > 0).all()


def test_a_grid_is_covered_once_and_whole_whichever_way_its_squares_are_cut() -> None:
    xs, ys = np.meshgrid(np.linspace(0, 599, 38), np.linspace(0, 799, 52))
    points = np.stack([xs.ravel(), ys.ravel()], axis=1)
    triangles = delaunay(points)
    assert len(triangles) == 2 * 37 * 51
    np.testing.assert_allclose(sizes(points, triangles), 599 / 37 * 799 / 51 / 2)


def test_the_hull_is_filled_although_its_points_lie_nearly_on_a_line() -> None:
    """A side that is dented by a hundredth of its length."""
    x = np.linspace(0, 100, 21)
    points = np.concatenate([np.c_[x, 1 - np.abs(x - 50) / 50], np.c_[x, np.full(21, 60.0)]])
    points[0, 1] = points[20, 1] = 0
    assert sizes(points, delaunay(points)).sum() == pytest.approx(ConvexHull(points).volume, rel=1e-6)


def test_points_in_one_place_count_once() -> None:
    points = np.array([[0, 0], [4, 0], [0, 4], [4, 4], [1, 2], [1, 2]], float)
    triangles = delaunay(points)
    assert len(triangles) == 4 and len({4, 5} & set(triangles.ravel().tolist())) == 1


@pytest.mark.parametrize("points", [[[0, 0], [1, 1], [2, 2]], [[3, 3]], [[1, 2], [1, 2]]])
def test_without_an_area_there_is_no_triangle(points: list[list[float]]) -> None:
    assert delaunay(np.array(points)).shape == (0, 3)
