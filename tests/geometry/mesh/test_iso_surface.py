"""The zero surface of a field: closed, where it should be, and seen from outside."""

from __future__ import annotations

import numpy as np
import pytest

from engine.geometry.mesh.iso_surface import iso_surface
from engine.geometry.mesh.surface import triangle_areas
from engine.geometry.mesh.welding import is_closed


def volume(vertices: np.ndarray, triangles: np.ndarray) -> float:
    a, b, c = (vertices[triangles[:, k]] for k in range(3))
    return float(np.einsum("ij,ij->i", a, np.cross(b, c)).sum() / 6)


def grid(count: int, spacing: float) -> np.ndarray:
    axis = spacing * np.arange(count)
    return np.stack(np.meshgrid(axis, axis, axis, indexing="ij"), -1)


def test_a_ball_has_its_volume_area_and_radius() -> None:
    centre, radius = np.array([0.101, 0.097, 0.1]), 0.07
    field = radius - np.linalg.norm(grid(51, 0.004) - centre, axis=-1)
    vertices, triangles = iso_surface(field, np.zeros(3), 0.004)
    assert np.linalg.norm(vertices - centre, axis=1) == pytest.approx(radius, abs=2e-4)
    assert volume(vertices - centre, triangles) == pytest.approx(4 / 3 * np.pi * radius**3, rel=0.01)
    assert triangle_areas(vertices, triangles).sum() == pytest.approx(4 * np.pi * radius**2, rel=0.02)
    assert is_closed(triangles)
    assert len(vertices) - len(triangles) * 3 // 2 + len(triangles) == 2, "Euler's number of a sphere"


def test_a_plane_is_where_a_linear_field_says_and_what_leaves_the_grid_is_closed_there() -> None:
    origin = np.array([1.0, 2.0, 3.0])
    field = 0.35 - grid(11, 0.1)[..., 2]
    vertices, triangles = iso_surface(field, origin, 0.1)
    top = vertices[np.isclose(vertices[:, 2], 3.35)]
    assert len(top) >= 121 and is_closed(triangles)
    assert volume(vertices - origin, triangles) > 0


def test_the_wildest_field_gives_a_closed_surface() -> None:
    field = np.random.default_rng(3).normal(size=(12, 11, 10))
    vertices, triangles = iso_surface(field, np.zeros(3), 1.0)
    assert is_closed(triangles) and len(np.unique(triangles)) == len(vertices)
    assert volume(vertices, triangles) > 0


def test_nothing_above_zero_has_no_surface() -> None:
    vertices, triangles = iso_surface(np.full((4, 4, 4), -1.0), np.zeros(3), 1.0)
    assert len(vertices) == len(triangles) == 0
