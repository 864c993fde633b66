"""Areas, normals and charts of surfaces one can write down."""

import numpy as np

from engine.geometry.mesh.surface import (
    chart_tangents,
    face_normals,
    triangle_areas,
    triangulate,
    vertex_areas,
    vertex_normals,
)


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


def test_areas_and_normals_of_triangles_by_hand() -> None:
    """Half a unit square on the floor, a 3-4-5 triangle on a wall, and one that is a line."""
    vertices = np.array([[0, 0, 0], [0, 0, 1], [1, 0, 0], [3, 0, 0], [0, 4, 0], [2, 0, 0]], np.float64)
    triangles = np.array([[0, 1, 2], [0, 3, 4], [0, 2, 5]])
    np.testing.assert_allclose(triangle_areas(vertices, triangles), [0.5, 6, 0])
    np.testing.assert_allclose(face_normals(vertices, triangles), [[0, 1, 0], [0, 0, 1], [0, 0, 0]])
    np.testing.assert_allclose(vertex_areas(vertices, triangles), [6.5 / 3, 0.5 / 3, 0.5 / 3, 2, 2, 0])


def test_a_cubes_corners_share_its_surface_and_point_outwards() -> None:
    """However its squares are cut in two: what counts is area, not how many triangles meet in a corner."""
    corners = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)], np.float64)
    quads = np.array([[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]])
    triangles = triangulate(quads)
    assert vertex_areas(corners, triangles).sum() == 24
    assert ((vertex_normals(corners, triangles) * corners).sum(1) > 0.9 * np.sqrt(3) * np.sqrt(2 / 3)).all()
    middles = corners[triangles].mean(1)
    assert ((face_normals(corners, triangles) * middles).sum(1) > 0.99).all()
