"""What is left of a surface above a level, and the solid between it and one beneath."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from engine.geometry.mesh.clipping import clip, walled
from engine.geometry.mesh.surface import area_vectors
from engine.geometry.mesh.welding import is_closed, same_rows

SIDE = 6


def square() -> tuple[NDArray[np.float64], NDArray[np.int32]]:
    """The unit square as a grid of triangles, counter-clockwise from above."""
    x, y = np.meshgrid(np.linspace(0, 1, SIDE), np.linspace(0, 1, SIDE))
    number = np.arange(SIDE * SIDE).reshape(SIDE, SIDE)
    a, b, c, d = (number[i : SIDE - 1 + i, j : SIDE - 1 + j].ravel() for i, j in ((0, 0), (0, 1), (1, 1), (1, 0)))
    triangles = np.concatenate([np.stack([a, b, c], 1), np.stack([a, c, d], 1)]).astype(np.int32)
    return np.stack([x.ravel(), y.ravel(), 0 * x.ravel()], 1), triangles


@pytest.mark.parametrize(
    ("field", "area"),
    [
        (lambda x, y: 0.37 - x, 0.37),
        (lambda x, y: x + y - 1.5, 0.125),
        (lambda x, y: np.minimum(x - 0.1, 0.9 - x), 0.8),
        (lambda x, y: x + 1, 1.0),
        (lambda x, y: -x - 1, 0.0),
    ],
    ids=["a strip", "a corner", "the middle", "all", "nothing"],
)
def test_the_area_above_a_level_is_left(field, area: float) -> None:  # type: ignore[no-untyped-def]
    places, triangles = square()
    cut = clip(triangles, field(*places[:, :2].T))
    left = cut.extended(places)
    vectors = area_vectors(left, cut.triangles)
    assert (vectors[:, 2] >= 0).all(), "none is turned over"
    np.testing.assert_allclose(np.linalg.norm(vectors, axis=1).sum() / 2, area, atol=0.012)


def test_a_level_is_met_where_it_is_linear_along_edges() -> None:
    places, triangles = square()
    cut = clip(triangles, 0.53 - places[:, 0])
    assert cut.extended(places)[np.unique(cut.triangles), 0].max() == pytest.approx(0.53)


def test_a_walled_surface_is_closed_and_has_the_volume_between_both() -> None:
    places, triangles = square()
    cut = clip(triangles, 0.25 - np.hypot(places[:, 0] - 0.5, places[:, 1] - 0.5))
    upper = cut.extended(places)
    used, count = np.unique(cut.triangles), len(upper)
    solid = walled(cut.triangles, same_rows(upper), count)
    whole = np.concatenate([upper, upper - [0, 0, 0.5], upper - [0, 0, 0.5]])
    assert is_closed(same_rows(whole)[solid])
    corners = whole[solid]
    volume = np.linalg.det(corners).sum() / 6
    area = np.linalg.norm(area_vectors(upper, cut.triangles), axis=1).sum() / 2
    assert len(used) > 8 and volume == pytest.approx(0.5 * area)


def test_no_wall_stands_along_a_seam() -> None:
    """A ring whose first and last column are at one place."""
    angles = np.linspace(0, 2 * np.pi, 9)
    angles[-1] = 0
    ring = np.stack([np.cos(angles), np.sin(angles), 0 * angles], 1)
    places = np.concatenate([ring, ring + np.array([0, 0, 1])])
    a = np.arange(8)
    triangles = np.concatenate([np.stack([a, a + 1, a + 10], 1), np.stack([a, a + 10, a + 9], 1)]).astype(np.int32)
    solid = walled(triangles, same_rows(places), len(places))
    inner = places * [0.5, 0.5, 1]
    whole = np.concatenate([places, inner, inner])
    assert is_closed(same_rows(whole)[solid])
    assert len(solid) == 2 * len(triangles) + 2 * 2 * 8
