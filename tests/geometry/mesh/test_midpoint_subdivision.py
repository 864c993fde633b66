"""Triangles split in four: the same surface, in smaller parts."""

from __future__ import annotations

import numpy as np

from engine.geometry.mesh.subdivision import midpoint_subdivision

VERTICES = np.array([[0.0, 0, 0], [2, 0, 1], [2, 2, 0], [0, 2, 3], [1, 3, 1]])
TRIANGLES = np.array([[0, 1, 2], [0, 2, 3], [3, 2, 4]])


def areas(vertices: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    a, b, c = vertices[triangles].transpose(1, 0, 2)
    return np.cross(b - a, c - a) / 2


def test_there_is_a_vertex_more_for_each_edge_and_four_triangles_for_one() -> None:
    matrix, triangles = midpoint_subdivision(TRIANGLES, 5)
    assert matrix.shape == (5 + 7, 5) and triangles.shape == (12, 3)
    np.testing.assert_allclose(matrix @ VERTICES[:, :1] * 0 + matrix.sum(axis=1)[:, None], 1)


def test_the_surface_is_the_same_and_turns_the_same_way() -> None:
    for rounds in (0, 1, 2, 3):
        matrix, triangles = midpoint_subdivision(TRIANGLES, 5, rounds)
        finer = matrix @ VERTICES
        np.testing.assert_array_equal(finer[:5], VERTICES)
        parts = areas(finer, triangles)
        assert len(parts) == 3 * 4**rounds
        if rounds:
            before = midpoint_subdivision(TRIANGLES, 5, rounds - 1)
            np.testing.assert_allclose(parts.sum(0), areas(before[0] @ VERTICES, before[1]).sum(0))
    np.testing.assert_allclose(parts.sum(0), areas(VERTICES, TRIANGLES).sum(0))


def test_neighbours_share_the_middles_of_their_edges() -> None:
    matrix, triangles = midpoint_subdivision(TRIANGLES, 5, 2)
    places = np.round(matrix @ VERTICES, 9)
    assert len(np.unique(places, axis=0)) == len(places) == len(np.unique(triangles))


def test_a_rim_that_is_to_be_a_curve_is_one() -> None:
    angles = np.linspace(0, 2 * np.pi, 12, endpoint=False)
    fan = np.vstack([[0, 0], np.stack([np.cos(angles), np.sin(angles)], 1)])
    triangles = np.array([[0, k + 1, (k + 1) % 12 + 1] for k in range(12)])
    for order in (range(1, 13), range(12, 0, -1)):
        matrix, finer = midpoint_subdivision(triangles, 13, 3, tuple(order))
        edges = np.sort(np.concatenate([finer[:, [0, 1]], finer[:, [1, 2]], finer[:, [2, 0]]]), axis=1)
        unique, count = np.unique(edges, axis=0, return_counts=True)
        rim = np.unique(unique[count == 1])
        assert len(rim) == 12 * 8
        np.testing.assert_allclose(np.linalg.norm((matrix @ fan)[rim], axis=1), 1, atol=0.004)
