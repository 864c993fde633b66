"""Deformation transfer: what is known of it by construction, and the template's smile on another head."""

from __future__ import annotations

import numpy as np
import pytest
import trimesh
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from engine.geometry.deformation.deformation_transfer import DeformationTransfer, deformation_gradients

TURN = Rotation.from_rotvec([0.5, 0.3, -1.2]).as_matrix()


def ball(subdivisions: int = 2) -> tuple[NDArray, NDArray]:
    mesh = trimesh.creation.icosphere(subdivisions)
    return np.asarray(mesh.vertices) * [1.0, 1.4, 0.7], np.asarray(mesh.faces)


def bent(vertices: NDArray) -> NDArray:
    """Something uneven: a bulge, a twist about y that grows with height, a shift."""
    out = vertices * (1 + 0.2 * np.exp(-8 * ((vertices - [0, 1, 0.3]) ** 2).sum(1, keepdims=True)))
    turns = Rotation.from_rotvec(0.4 * out[:, 1:2] * [0, 1, 0]).as_matrix()
    return np.einsum("vij,vj->vi", turns, out) + np.array([0.1, 0.2, 0])


def other(vertices: NDArray) -> NDArray:
    """A surface of the same triangles and another shape, twice as large."""
    return 2 * vertices * [0.8, 1.2, 1.1] + 0.1 * np.sin(3 * vertices[:, [1, 2, 0]])


@pytest.mark.parametrize("held", [None, np.array([0, 7])])
def test_no_deformation_deforms_nothing(held) -> None:
    vertices, triangles = ball()
    transfer = DeformationTransfer(vertices, triangles, other(vertices), triangles, held=held)
    np.testing.assert_allclose(transfer(vertices), other(vertices), atol=1e-9)


def test_to_itself_a_deformation_is_what_it_was() -> None:
    vertices, triangles = ball()
    np.testing.assert_allclose(
        DeformationTransfer(vertices, triangles, vertices, triangles)(bent(vertices)), bent(vertices), atol=1e-9
    )
    held = np.array([4, 100])
    transfer = DeformationTransfer(vertices, triangles, vertices, triangles, held=held)
    np.testing.assert_allclose(transfer(bent(vertices), bent(vertices)[held]), bent(vertices), atol=1e-9)


def test_turned_and_enlarged_the_target_is_turned_and_enlarged_too() -> None:
    vertices, triangles = ball()
    matrix = 1.3 * TURN
    found = DeformationTransfer(vertices, triangles, other(vertices), triangles)(vertices @ matrix.T)
    away = found - other(vertices) @ matrix.T
    np.testing.assert_allclose(away, np.broadcast_to(away[0], away.shape), atol=1e-9)


def test_a_linear_map_is_done_alike_to_a_surface_whose_triangles_face_alike() -> None:
    vertices, triangles = ball()
    matrix = TURN @ np.diag([1.2, 0.9, 1.0]) @ np.array([[1, 0.2, 0], [0, 1, 0], [0, 0, 1]])
    found = DeformationTransfer(vertices, triangles, 2 * vertices, triangles)(vertices @ matrix.T)
    np.testing.assert_allclose(found, 2 * vertices @ matrix.T, atol=1e-9)


def test_how_far_it_moves_goes_with_the_size() -> None:
    vertices, triangles = ball()
    found = DeformationTransfer(vertices, triangles, 3 * vertices, triangles)(vertices + np.array([0.5, 0, 0]))
    np.testing.assert_allclose(found, 3 * vertices + [1.5, 0, 0], atol=1e-9)


def test_triangles_in_another_order_and_fewer_of_them_follow_their_matches() -> None:
    vertices, triangles = ball()
    order = np.random.default_rng(1).permutation(len(triangles))[:250]
    used, renumbered = np.unique(triangles[order], return_inverse=True)
    part = DeformationTransfer(vertices, triangles, vertices[used], renumbered.reshape(-1, 3), matches=order)
    np.testing.assert_allclose(part(bent(vertices)), bent(vertices)[used], atol=1e-9)


def test_held_vertices_stay_and_the_rest_goes_on_from_there() -> None:
    vertices, triangles = ball()
    held = np.flatnonzero(vertices[:, 1] < -0.8)
    target = other(vertices)
    found = DeformationTransfer(vertices, triangles, target, triangles, held=held)(bent(vertices))
    np.testing.assert_array_equal(found[held], target[held])
    long = found[triangles] - found[triangles][:, [1, 2, 0]]
    before = target[triangles] - target[triangles][:, [1, 2, 0]]
    stretched = np.linalg.norm(long, axis=2) / np.linalg.norm(before, axis=2)
    assert stretched.min() > 0.5 and stretched.max() < 2


def test_screened_vertices_go_where_they_are_drawn_over_far_and_as_their_triangles_say_over_near() -> None:
    vertices, triangles = ball()
    target, held = other(vertices), np.array([0])
    goal = target + np.array([0.3, -0.2, 0.1])
    for length, wanted in ((1e-4, goal), (1e4, None)):
        transfer = DeformationTransfer(vertices, triangles, target, triangles, held=held, screening=length)
        plain = DeformationTransfer(vertices, triangles, target, triangles, held=held)(bent(vertices))
        found = transfer(bent(vertices), drawn_to=goal)
        np.testing.assert_allclose(found[1:], (plain if wanted is None else wanted)[1:], atol=1e-5)
    with pytest.raises(ValueError, match="targets are needed"):
        transfer(bent(vertices))


def test_each_piece_moves_as_its_counterpart() -> None:
    vertices, triangles = ball(1)
    count = len(vertices)
    both, faces = np.concatenate([vertices, 0.3 * vertices + [4, 0, 0]]), np.concatenate([triangles, triangles + count])
    moved = np.concatenate([bent(vertices), (0.3 * vertices) @ TURN.T + [4, 1, 2]])
    np.testing.assert_allclose(DeformationTransfer(both, faces, both, faces)(moved), moved, atol=1e-9)
    held = DeformationTransfer(both, faces, both, faces, held=np.array([0]))
    np.testing.assert_allclose(held(moved, moved[:1]), moved, atol=1e-9)


def test_ten_thousand_vertices_that_nothing_holds_are_no_more_than_that() -> None:
    """What ties all vertices to one another, as a middle does, would take a system of a hundred million numbers."""
    vertices, triangles = ball(5)
    assert len(vertices) > 10_000
    found = DeformationTransfer(vertices, triangles, vertices, triangles)(bent(vertices))
    np.testing.assert_allclose(found, bent(vertices), atol=1e-8)


def test_triangles_without_area_and_vertices_of_none() -> None:
    vertices, triangles = ball(1)
    count = len(vertices)
    a, b = triangles[0, :2]
    more = np.concatenate([vertices, [[9.0, 9, 9]]])
    faces = np.concatenate([triangles, [[a, b, a]]])
    moved = np.concatenate([bent(vertices), [[1.0, 2, 3]]])
    found = DeformationTransfer(more, faces, more, faces)(moved)
    np.testing.assert_allclose(found[:count], moved[:count], atol=1e-9)
    np.testing.assert_array_equal(found[count], more[count])
    hanging = np.concatenate([triangles, [[a, b, count]]])  # a vertex of one triangle, on the line of the others
    line = np.concatenate([vertices, [2 * vertices[b] - vertices[a]]])
    with pytest.raises(ValueError, match=f"1 vertices, the first {count}, have only triangles without area"):
        DeformationTransfer(line, hanging, line, hanging)
    there = DeformationTransfer(line, hanging, line, hanging, held=np.array([count]))
    assert np.isfinite(there(np.concatenate([bent(vertices), line[-1:]]))).all()


def test_a_triangle_that_collapses_in_the_deformed_source_is_no_fault() -> None:
    vertices, triangles = ball(1)
    moved = vertices.copy()
    moved[triangles[0, 0]] = moved[triangles[0, 1]]
    found = DeformationTransfer(vertices, triangles, vertices, triangles)(moved)
    np.testing.assert_allclose(found, moved, atol=1e-9)


def test_what_does_not_match_is_refused() -> None:
    vertices, triangles = ball(1)
    with pytest.raises(ValueError, match="say which match"):
        DeformationTransfer(vertices, triangles, vertices, triangles[:-1])
    for matches in (np.zeros(5, int), np.full(len(triangles), len(triangles))):
        with pytest.raises(ValueError, match="needs one of the source"):
            DeformationTransfer(vertices, triangles, vertices, triangles, matches)
    with pytest.raises(ValueError, match="not finite"):
        DeformationTransfer(vertices * np.nan, triangles, vertices, triangles)
    transfer = DeformationTransfer(vertices, triangles, vertices, triangles)
    for wrong in (vertices[:-1], vertices * np.inf):
        with pytest.raises(ValueError, match="other vertices"):
            transfer(wrong)


def test_the_gradient_of_a_turned_triangle_is_the_turn() -> None:
    vertices, triangles = ball(1)
    found = deformation_gradients(vertices, vertices @ TURN.T + [1, 2, 3], triangles)
    np.testing.assert_allclose(found, np.broadcast_to(TURN, found.shape), atol=1e-9)
