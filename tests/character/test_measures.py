"""What the method says of its own result, on meshes whose faults are known."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from scipy.spatial import cKDTree
from template_character import template_character

from engine.character.measures import _loops, _odd_edges, _turned_away, pose
from engine.character.rigging import Character
from engine.character.stages import fewer_triangles
from engine.geometry.skinned_mesh import SkinnedMesh
from engine.motion.library import built_in


def tube(around: int = 6, along: int = 4) -> np.ndarray:
    """A tube open at both ends: (T, 3) triangles."""
    quads = [
        (ring * around + k, ring * around + (k + 1) % around, (ring + 1) * around + (k + 1) % around, (ring + 1) * around + k)
        for ring in range(along)
        for k in range(around)
    ]  # fmt: skip
    return np.array([half for a, b, c, d in quads for half in ((a, b, c), (a, c, d))])


def test_a_tube_has_two_holes_and_a_lid_closes_one() -> None:
    border, crowded = _odd_edges(tube())
    assert len(border) == 12 and crowded == 0
    assert _loops(border) == 2
    lid = np.array([(0, k + 1, k) for k in range(1, 5)])
    assert _loops(_odd_edges(np.concatenate([tube(), lid]))[0]) == 1


def test_a_closed_surface_has_no_hole_and_a_missing_triangle_is_one() -> None:
    tetrahedron = np.array([(0, 1, 2), (0, 3, 1), (1, 3, 2), (2, 3, 0)])
    border, crowded = _odd_edges(tetrahedron)
    assert _loops(border) == 0 and crowded == 0
    assert _loops(_odd_edges(tetrahedron[1:])[0]) == 1


def test_a_fin_on_a_surface_is_not_a_manifold() -> None:
    tetrahedron = np.array([(0, 1, 2), (0, 3, 1), (1, 3, 2), (2, 3, 0), (0, 1, 4)])
    border, crowded = _odd_edges(tetrahedron)
    assert crowded == 1
    assert _loops(border) == 1, "the fin's own border"


def test_a_triangle_that_turns_the_other_way_shows_its_back() -> None:
    corners = np.array(
        [[0, 0, 1], [0, 10, 1], [10, 0, 1]], np.float32
    )  # down, then right: counter-clockwise for y down
    turned = _turned_away(corners, np.array([[0, 1, 2], [0, 2, 1]]))
    np.testing.assert_array_equal(turned, [False, True])


def test_fewer_triangles_are_chosen_as_pictured_and_stay_in_t_pose() -> None:
    mesh = template_character(texture_size=64)
    dance = built_in("dance", mesh.skeleton)
    pictured = replace(dance, rotations=dance.rotations[60:61], root=dance.root[60:61])
    character = Character(mesh, pictured, np.zeros(3), 1.0)
    fewer = fewer_triangles(character, 6000)
    assert len(fewer.triangles) <= 6000
    assert fewer_triangles(character, len(mesh.triangles)) is mesh

    def rows(of: SkinnedMesh) -> set[bytes]:
        return {row.tobytes() for row in np.hstack([of.vertices, of.uv, of.weights, of.bones.astype(np.float32)])}

    assert rows(fewer) <= rows(mesh), "what is left is as it was"
    as_pictured, whole = pose(replace(character, mesh=fewer), pictured), pose(character, pictured)
    distance, _ = cKDTree(as_pictured).query(whole)
    assert np.median(distance) < 0.01
