"""Seams of a texture are no seams of the surface."""

from dataclasses import replace

import numpy as np
from template_character import template_character

from engine.geometry.mesh.surface import vertex_normals
from engine.geometry.mesh.welding import is_closed, same_rows, seamless_normals, weld

SQUARE = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0]], np.float32)


def test_rows_alike_in_all_columns_have_one_number() -> None:
    places = np.concatenate([SQUARE, SQUARE[:2] * [1, 1, -1]]).astype(np.float32)  # zeros below zero are zeros
    assert same_rows(places)[4:].tolist() == same_rows(places)[:2].tolist()
    assert len(np.unique(same_rows(places))) == 4
    assert len(np.unique(same_rows(places, np.arange(6)))) == 6


def test_a_closed_surface_has_every_edge_in_both_directions() -> None:
    tetrahedron = np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]])
    assert is_closed(tetrahedron)
    assert not is_closed(tetrahedron[:3])
    assert not is_closed(np.concatenate([tetrahedron[:3], tetrahedron[3:, ::-1]]))
    assert is_closed((tetrahedron + 100_000).astype(np.int32)), "so many points that pairs of them are no int32"


def test_a_mesh_cut_along_seams_is_one_surface_again() -> None:
    """All triangles apart: welded, as many points as before, and the normals of the uncut mesh."""
    whole = template_character()
    corners = whole.triangles.ravel()
    apart = replace(
        whole,
        vertices=whole.vertices[corners],
        bones=whole.bones[corners],
        weights=whole.weights[corners],
        uv=whole.uv[corners],
        triangles=np.arange(len(corners), dtype=np.int32).reshape(-1, 3),
    )
    used = np.unique(weld(whole)[corners])
    assert len(np.unique(weld(apart))) == len(used)
    point = weld(whole)
    places = np.zeros((int(point.max()) + 1, 3), np.float32)
    places[point] = whole.vertices
    expected = vertex_normals(places, point[whole.triangles])[point][corners]
    found = seamless_normals(apart)
    sized = np.linalg.norm(expected, axis=1) > 0.5
    np.testing.assert_allclose(found[sized], expected[sized], atol=1e-3)
    np.testing.assert_allclose(np.linalg.norm(found, axis=1), 1, atol=1e-5)
