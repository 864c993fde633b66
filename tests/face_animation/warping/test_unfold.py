"""A sheet that does not fold."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from engine.face_animation.warping.unfold import AREA_TOLERANCE_SHARE, MIN_AREA_SHARE, unfold
from engine.imaging.warping.delaunay import delaunay


@pytest.fixture
def sheet() -> NDArray[np.float32]:
    """A square, its ten fixed vertices first, in the middle."""
    grid = np.stack(np.meshgrid(np.arange(0.0, 100, 8), np.arange(0.0, 100, 8)), axis=-1).reshape(-1, 2)
    order = np.argsort(np.abs(grid - 48).max(axis=1), kind="stable")
    return grid[order].astype(np.float32) + np.random.default_rng(0).normal(0, 0.5, grid.shape).astype(np.float32)


def held(sheet: NDArray) -> NDArray[np.bool_]:
    return np.arange(len(sheet)) < 10


def areas(places: NDArray, triangles: NDArray) -> NDArray[np.float64]:
    a, b, c = places[triangles].astype(float).transpose(1, 0, 2)
    return (b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0]


def test_what_does_not_fold_stays(sheet: NDArray) -> None:
    triangles = delaunay(sheet)
    bent = np.column_stack([0.2 * sheet[:, 1], 0.3 * sheet[:, 0] - 5, sheet[:, 0]]).astype(np.float32)
    before = bent.copy()
    assert unfold(bent, sheet, triangles, held(sheet), np.full(len(triangles), MIN_AREA_SHARE)) == 0
    np.testing.assert_array_equal(bent, before)


@pytest.mark.parametrize("push", [9.0, 13.0, 17.0])
def test_where_fixed_vertices_are_pushed_over_others_those_give_way(sheet: NDArray, push: float) -> None:
    triangles = delaunay(sheet)
    offsets = np.zeros((len(sheet), 3), np.float32)
    offsets[:10, 0] = push
    before = offsets.copy()
    kept = areas(sheet + before[:, :2], triangles) / areas(sheet, triangles)
    unfold(offsets, sheet, triangles, held(sheet), np.full(len(triangles), MIN_AREA_SHARE))
    after = areas(sheet + offsets[:, :2], triangles) / areas(sheet, triangles)
    free = triangles.max(axis=1) >= 10
    assert kept[free].min() < 0 or push < 13
    assert after[free].min() > MIN_AREA_SHARE - AREA_TOLERANCE_SHARE - 1e-3
    np.testing.assert_array_equal(offsets[:10], before[:10])
    np.testing.assert_array_equal(offsets[:, 2], before[:, 2])


def test_a_little_more_of_a_push_is_a_little_more_of_a_way(sheet: NDArray) -> None:
    """Frame follows frame without a jump."""
    triangles, made = delaunay(sheet), []
    for push in np.linspace(0, 17, 69):
        offsets = np.zeros((len(sheet), 2), np.float32)
        offsets[:10, 0] = push
        unfold(offsets, sheet, triangles, held(sheet), np.full(len(triangles), MIN_AREA_SHARE))
        made.append(offsets)
    assert np.abs(np.diff(made, axis=0)).max() < 1.5


@pytest.mark.parametrize("width", [1.0, 0.1, 0.01])
def test_beside_an_edge_that_closes_nothing_is_thrown_out(width: float) -> None:
    """Two lips that meet, and a vertex beside them that is pushed through: it comes back to its side, by its triangle's size at most."""
    rest = np.array([[0, 0], [10, 0], [5, 8]], np.float32)
    offsets = np.array([[5 - width / 2, 0], [-5 + width / 2, 0], [0, -9]], np.float32)
    fixed = np.array([True, True, False])
    unfold(offsets, rest, np.array([[0, 1, 2]], np.int32), fixed, np.array([MIN_AREA_SHARE]))
    back = rest[2] + offsets[2]
    assert np.linalg.norm(back - [5, -1]) < 10
    assert back[1] == pytest.approx(MIN_AREA_SHARE * 8, abs=0.5)


def test_what_has_shrunk_to_a_point_opens_by_its_own_size_and_no_more() -> None:
    rest = np.array([[0, 0], [10, 0], [5, 8]], np.float32)
    offsets = (np.array([[5, 3], [5.001, 3], [5, 3.001]], np.float32) - rest).astype(np.float32)
    unfold(offsets, rest, np.array([[0, 1, 2]], np.int32), np.array([True, False, False]), np.array([MIN_AREA_SHARE]))
    assert np.linalg.norm(rest + offsets - [5, 3], axis=1).max() < 20
