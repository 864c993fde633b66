"""The nearest points of a surface."""

from __future__ import annotations

import numpy as np
import pytest

from engine.geometry.mesh.closest_points import closest_points

TRIANGLE = np.array([[0.0, 0, 0], [4, 0, 0], [0, 3, 0]])


@pytest.mark.parametrize(
    ("point", "nearest"),
    [
        ((1, 1, 2), (1, 1, 0)),  # above the inside
        ((-1, -2, 0), (0, 0, 0)),
        ((6, -1, 1), (4, 0, 0)),
        ((-1, 5, 0), (0, 3, 0)),
        ((2, -3, 0), (2, 0, 0)),
        ((-2, 1, 1), (0, 1, 0)),
        ((2 + 3, 1.5 + 4, 0), (2, 1.5, 0)),  # beside the long edge, square to it
    ],
)
def test_each_region_of_a_triangle(point: tuple[float, ...], nearest: tuple[float, ...]) -> None:
    found = closest_points(np.array([point]), TRIANGLE, np.array([[0, 1, 2]]))
    assert np.allclose(found.barycentrics[0] @ TRIANGLE, nearest, atol=1e-12)
    assert found.distance[0] == pytest.approx(np.linalg.norm(np.subtract(point, nearest)))


def test_points_lifted_from_a_sheet_are_found_where_they_came_from() -> None:
    random = np.random.default_rng(3)
    x, y = np.meshgrid(np.arange(12.0), np.arange(9.0))
    sheet = np.column_stack([x.ravel(), y.ravel(), np.zeros(x.size)])
    at = np.arange(x.size).reshape(x.shape)
    corner = at[:-1, :-1].ravel()
    triangles = np.concatenate([
        np.column_stack([corner, corner + 1, corner + 13]), np.column_stack([corner, corner + 13, corner + 12])
    ])  # fmt: skip
    shares = random.dirichlet(np.ones(3), 400)
    which = random.integers(0, len(triangles), 400)
    places = np.einsum("nk,nkc->nc", shares, sheet[triangles[which]])
    heights = random.uniform(-0.5, 0.5, 400)
    found = closest_points(places + heights[:, None] * [0, 0, 1], sheet, triangles)
    assert np.allclose(found.interpolated(sheet, triangles), places)
    assert np.allclose(found.distance, np.abs(heights))
    assert np.allclose(found[5:9].beneath(np.full(4, 0.25), sheet, triangles), places[5:9] - [0, 0, 0.25])


def test_without_triangles_nothing_is_near() -> None:
    with pytest.raises(ValueError, match="without triangles"):
        closest_points(np.zeros((1, 3)), TRIANGLE, np.zeros((0, 3), int))
