"""Surfaces laid flat without folds."""

from __future__ import annotations

import numpy as np
import pytest
import trimesh
from numpy.typing import NDArray

from engine.geometry.texture_charts.injective_disk import injective_disk


def _dome() -> tuple[NDArray[np.intp], NDArray[np.float64], int]:
    """The upper half of a ball, its inner vertices first, then its border in order, which lies on the unit circle."""
    ball = trimesh.creation.icosphere(2)
    vertices, faces = np.asarray(ball.vertices), np.asarray(ball.faces)
    faces = faces[(vertices[faces][:, :, 2] > -1e-6).all(1)]
    used = np.unique(faces)
    border = used[np.abs(vertices[used, 2]) < 1e-6]
    border = border[np.argsort(np.arctan2(vertices[border, 1], vertices[border, 0]))]
    inner = np.setdiff1d(used, border)
    number = np.full(len(vertices), -1)
    number[np.concatenate([inner, border])] = np.arange(len(used))
    return number[faces], vertices[border][:, :2], len(inner)


def _areas(places: NDArray[np.float64], corners: NDArray[np.intp]) -> NDArray[np.float64]:
    a, b, c = (places[corners[:, k]] for k in range(3))
    return ((b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0]) / 2


def test_no_triangle_is_turned_over_and_areas_are_alike() -> None:
    corners, edge, free = _dome()
    flat = injective_disk(corners, edge, free)
    areas = _areas(np.concatenate([flat, edge]), corners)
    assert (areas > 0).all()
    assert areas.max() / areas.min() < 4


def test_the_border_may_run_the_other_way() -> None:
    corners, edge, free = _dome()
    flat = injective_disk(corners[:, ::-1], edge, free)
    assert (_areas(np.concatenate([flat, edge]), corners) > 0).all()


def test_what_hangs_by_one_vertex_is_no_disk() -> None:
    """Two inner vertices in one ear fall on one place."""
    edge = np.array([[1.0, 0], [0, 1], [-1, 0], [0, -1]])
    corners = np.array([[2, 3, 0], [3, 4, 0], [4, 5, 0], [5, 2, 0], [0, 1, 0]])
    with pytest.raises(ValueError, match="no disk"):
        injective_disk(corners, edge, 2)
