"""Normals and charts of surfaces one can write down."""

import numpy as np

from engine.geometry.surface import chart_tangents, triangulate, vertex_normals


def test_a_spheres_normals_point_from_its_middle() -> None:
    u, v = np.meshgrid(np.linspace(0, 2 * np.pi, 61), np.linspace(0.3, np.pi - 0.3, 41))
    points = np.stack([np.sin(v) * np.cos(u), np.cos(v), np.sin(v) * np.sin(u)], -1)
    index = np.arange(61 * 41).reshape(41, 61)
    quads = np.stack([index[:-1, :-1], index[:-1, 1:], index[1:, 1:], index[1:, :-1]], -1).reshape(-1, 4)
    flat = points.reshape(-1, 3)
    normals = vertex_normals(flat, triangulate(quads)).reshape(points.shape)[3:-3, 3:-3]
    np.testing.assert_allclose((normals * points[3:-3, 3:-3]).sum(-1), 1, atol=2e-3)


def test_tangents_of_a_stretched_sheet() -> None:
    u, v = np.meshgrid(np.linspace(0, 1, 9), np.linspace(0, 1, 7))
    sheet = np.stack([3 * u, 0.5 * v, u + v], -1).reshape(-1, 3)
    index = np.arange(63).reshape(7, 9)
    quads = np.stack([index[:-1, :-1], index[:-1, 1:], index[1:, 1:], index[1:, :-1]], -1).reshape(-1, 4)
    chart = np.stack([u, v], -1).reshape(-1, 2)
    found = chart_tangents(sheet, chart, triangulate(quads))
    np.testing.assert_allclose(found, np.tile([3, 0, 1, 0, 0.5, 1], (63, 1)), atol=1e-5)
