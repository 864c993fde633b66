"""What the method says of its own result, on meshes whose faults are known."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial import cKDTree
from template_character import template_character

from engine.character.rig.fewer_triangles import fewer_triangles
from engine.character.rig.measures import border_edges, count_loops, pose, projected_areas, unseen_share
from engine.character.rig.rigging import Character
from engine.geometry.rigging.skinned_mesh import SkinnedMesh
from engine.motion.library import built_in
from engine.render.rasterisation.rasteriser import rasterise


def tube(around: int = 6, along: int = 4) -> np.ndarray:
    """A tube open at both ends: (T, 3) triangles."""
    quads = [
        (ring * around + k, ring * around + (k + 1) % around, (ring + 1) * around + (k + 1) % around, (ring + 1) * around + k)
        for ring in range(along)
        for k in range(around)
    ]  # fmt: skip
    return np.array([half for a, b, c, d in quads for half in ((a, b, c), (a, c, d))])


def test_a_tube_has_two_holes_and_a_lid_closes_one() -> None:
    border, crowded = border_edges(tube())
    assert len(border) == 12 and crowded == 0
    assert count_loops(border) == 2
    lid = np.array([(0, k + 1, k) for k in range(1, 5)])
    assert count_loops(border_edges(np.concatenate([tube(), lid]))[0]) == 1


def test_a_closed_surface_has_no_hole_and_a_missing_triangle_is_one() -> None:
    tetrahedron = np.array([(0, 1, 2), (0, 3, 1), (1, 3, 2), (2, 3, 0)])
    border, crowded = border_edges(tetrahedron)
    assert count_loops(border) == 0 and crowded == 0
    assert count_loops(border_edges(tetrahedron[1:])[0]) == 1


def test_a_fin_on_a_surface_is_not_a_manifold() -> None:
    tetrahedron = np.array([(0, 1, 2), (0, 3, 1), (1, 3, 2), (2, 3, 0), (0, 1, 4)])
    border, crowded = border_edges(tetrahedron)
    assert crowded == 1
    assert count_loops(border) == 1, "the fin's own border"


def test_a_triangle_that_turns_the_other_way_shows_its_back() -> None:
    corners = np.array(
        [[0, 0, 1], [0, 10, 1], [10, 0, 1]], np.float32
    )  # down, then right: counter-clockwise for y down
    np.testing.assert_array_equal(projected_areas(corners, np.array([[0, 1, 2], [0, 2, 1]])), [50, -50])


def card(corner: float, side: float, depth: float) -> np.ndarray:
    """A square on the screen: (4, 3) corners."""
    ends = [(corner, corner), (corner, corner + side), (corner + side, corner + side), (corner + side, corner)]
    return np.array([(x, y, depth) for x, y in ends], np.float32)


def test_backs_and_what_is_behind_something_are_unseen() -> None:
    """A card with a front and a back, 400 pixels each, behind one of 100: 400 of 1000 are seen."""
    front = np.array([[0, 1, 2], [0, 2, 3]])
    sides = np.concatenate([front, front[:, ::-1]])
    placed = np.concatenate([card(3.5, 20, 2), card(8.5, 10, 1.98)])
    triangles = np.concatenate([sides, sides + 4])
    seen = rasterise(placed, triangles, (30, 30), cull=True).triangle
    flat = placed * [1, 1, 0]
    assert unseen_share(flat, placed, triangles, seen[seen >= 0]) == pytest.approx(0.6, abs=1e-6)
    alone = rasterise(placed[:4], sides, (30, 30), cull=True).triangle
    assert unseen_share(flat[:4], placed[:4], sides, alone[alone >= 0]) == pytest.approx(0.5, abs=1e-6)


def test_of_a_ball_finer_than_the_pixels_half_is_seen() -> None:
    turn, along = np.meshgrid(np.linspace(0, 2 * np.pi, 161), np.linspace(0, np.pi, 81))
    ball = np.stack([np.sin(along) * np.cos(turn), np.cos(along), np.sin(along) * np.sin(turn)], -1).reshape(-1, 3)
    at = np.arange(80 * 161).reshape(80, 161)[:, :-1].ravel()
    triangles = np.concatenate([np.stack([at, at + 161, at + 1], 1), np.stack([at + 1, at + 161, at + 162], 1)])
    placed = (30 * ball + 31.7).astype(np.float32)
    seen = rasterise(placed, triangles, (64, 64)).triangle
    assert unseen_share(ball.astype(np.float32), placed, triangles, seen[seen >= 0]) == pytest.approx(0.5, abs=0.02)


def test_fewer_triangles_are_chosen_as_pictured_and_stay_in_t_pose() -> None:
    mesh = template_character(texture_size=64)
    dance = built_in("dance", mesh.skeleton)
    pictured = replace(dance, rotations=dance.rotations[60:61], root=dance.root[60:61])
    character = Character(mesh, pictured, np.zeros(3))
    fewer = fewer_triangles(character, 6000)
    assert len(fewer.triangles) <= 6000
    assert fewer_triangles(character, len(mesh.triangles)) is mesh

    def rows(of: SkinnedMesh) -> set[bytes]:
        return {row.tobytes() for row in np.hstack([of.vertices, of.uv, of.weights, of.bones.astype(np.float32)])}

    assert rows(fewer) <= rows(mesh), "what is left is as it was"
    as_pictured, whole = pose(replace(character, mesh=fewer), pictured), pose(character, pictured)
    distance, _ = cKDTree(as_pictured).query(whole)
    assert np.median(distance) < 0.01
