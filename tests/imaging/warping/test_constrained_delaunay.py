"""Triangles that keep to given lines."""

from __future__ import annotations

import numpy as np

from engine.geometry.mesh.adjacency import edges
from engine.imaging.warping.constrained_delaunay import constrained_delaunay
from engine.imaging.warping.delaunay import delaunay

POINTS = np.random.default_rng(3).random((400, 2)) * 100
ACROSS = np.argsort(POINTS[:, 0])[::40]
LINES = np.stack([ACROSS[:-1], ACROSS[1:]], axis=1)


def _areas(triangles: np.ndarray) -> np.ndarray:
    a, b, c = (POINTS[triangles[:, k]] for k in range(3))
    return (b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0]


def _has(triangles: np.ndarray, lines: np.ndarray) -> np.ndarray:
    known = {tuple(edge) for edge in edges(triangles).tolist()}
    return np.array([tuple(sorted(line)) in known for line in lines.tolist()])


def test_each_line_is_an_edge_and_the_triangles_cover_what_they_did() -> None:
    before, triangles = delaunay(POINTS), constrained_delaunay(POINTS, LINES)
    assert not _has(before, LINES).all()
    assert _has(triangles, LINES).all()
    assert len(triangles) == len(before)
    assert (_areas(triangles) > 0).all()
    np.testing.assert_allclose(_areas(triangles).sum(), _areas(before).sum())


def test_edges_that_are_there_change_nothing() -> None:
    before = delaunay(POINTS)
    triangles = constrained_delaunay(POINTS, edges(before)[::7])
    np.testing.assert_array_equal(edges(triangles), edges(before))
    np.testing.assert_array_equal(constrained_delaunay(POINTS, np.zeros((0, 2), int)), before)


def test_a_line_across_an_earlier_one_is_left_out() -> None:
    square = np.array([[0, 0], [10, 0], [10, 10], [0, 10.0]])
    triangles = constrained_delaunay(square, np.array([[0, 2], [1, 3]]))
    assert _has(triangles, np.array([[0, 2], [1, 3]])).tolist() == [True, False]


def test_a_line_through_a_point_is_left_out() -> None:
    points = np.array([[0, 0], [5, 5], [10, 10], [10, 0], [0, 10.0]])
    triangles = constrained_delaunay(points, np.array([[0, 2]]))
    np.testing.assert_array_equal(edges(triangles), edges(delaunay(points)))
