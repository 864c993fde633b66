"""Laplacian and as-rigid-as-possible deformation: truths that hold for any surface, and a bar that is bent."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
import trimesh
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from engine.geometry.deformation.as_rigid_as_possible import AsRigidAsPossible
from engine.geometry.deformation.cotangent_laplacian import cotangent_laplacian
from engine.geometry.deformation.handles import handles, surface_points
from engine.geometry.deformation.laplacian_deformation import LaplacianDeformation
from engine.geometry.mesh.surface import vertex_areas

TURN = Rotation.from_rotvec([0.4, -1.9, 0.7]).as_matrix()
SHIFT = np.array([0.3, -2.0, 1.1])


def ball(subdivisions: int = 2) -> tuple[NDArray, NDArray]:
    mesh = trimesh.creation.icosphere(subdivisions)
    return np.asarray(mesh.vertices) * [1.0, 1.4, 0.7], np.asarray(mesh.faces)


def bar(length: int = 24, sides: int = 12) -> tuple[NDArray, NDArray]:
    """An open tube of radius 0.1 along y from 0 to 1, `length` rings of `sides` vertices."""
    angle = 2 * np.pi * np.arange(sides) / sides
    ring = np.stack([0.1 * np.cos(angle), np.zeros(sides), -0.1 * np.sin(angle)], 1)
    vertices = (ring[None] + np.linspace(0, 1, length)[:, None, None] * [0, 1, 0]).reshape(-1, 3)
    a = (np.arange(length - 1)[:, None] * sides + np.arange(sides)).ravel()
    b = (np.arange(length - 1)[:, None] * sides + (np.arange(sides) + 1) % sides).ravel()
    return vertices, np.concatenate([np.stack([a, b, b + sides], 1), np.stack([a, b + sides, a + sides], 1)])


def grid(count: int = 9) -> tuple[NDArray, NDArray]:
    """A flat square of side 1, `count` vertices along each side."""
    y, x = np.mgrid[:count, :count] / (count - 1)
    a = (np.arange(count - 1)[:, None] * count + np.arange(count - 1)).ravel()
    quads = np.stack([a, a + 1, a + count + 1, a + count], 1)
    return np.stack([x, y, 0 * x], 2).reshape(-1, 3), np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])


METHODS = [
    pytest.param(lambda *given: LaplacianDeformation(*given, order=1), id="harmonic"),
    pytest.param(lambda *given: LaplacianDeformation(*given, order=2), id="biharmonic"),
    pytest.param(AsRigidAsPossible, id="as rigid as possible"),
]


@pytest.mark.parametrize("method", METHODS)
def test_targets_moved_rigidly_move_the_surface_rigidly(method) -> None:
    vertices, triangles = ball()
    corners = np.arange(0, len(triangles), 40)
    points = surface_points(triangles, corners, np.full((len(corners), 3), [0.2, 0.3, 0.5]), len(vertices))
    deform = method(vertices, triangles, handles(len(vertices), np.array([3, 17, 80]), points, 0.3))
    wanted = vertices @ TURN.T + SHIFT
    found = deform(wanted[[3, 17, 80]], points @ wanted)
    np.testing.assert_allclose(found, wanted, atol=1e-9)


@pytest.mark.parametrize("method", METHODS)
def test_each_piece_follows_its_own_targets(method) -> None:
    vertices, triangles = ball(1)
    count = len(vertices)
    both = np.concatenate([vertices, vertices + np.array([5, 0, 0])])
    held = np.array([0, 5, 9, count, count + 5, count + 9])
    wanted = np.concatenate([vertices @ TURN.T, both[count:] + SHIFT])
    deform = method(both, np.concatenate([triangles, triangles + count]), handles(2 * count, held))
    np.testing.assert_allclose(deform(wanted[held]), wanted, atol=1e-9)


@pytest.mark.parametrize("method", METHODS)
def test_hard_targets_are_met_and_soft_ones_the_nearer_the_heavier(method) -> None:
    vertices, triangles = ball()
    random = np.random.default_rng(1)
    held, drawn = np.arange(0, 20), np.arange(60, 70)
    hard, soft = vertices[held] + random.normal(0, 0.2, (20, 3)), vertices[drawn] + random.normal(0, 0.2, (10, 3))
    left = []
    for weight in (0.01, 1.0, 1e6):
        found = method(vertices, triangles, handles(len(vertices), held, drawn, weight))(hard, soft)
        np.testing.assert_allclose(found[held], hard, atol=1e-9)
        left.append(np.linalg.norm(found[drawn] - soft))
    assert left[0] > left[1] > left[2] and left[2] < 1e-3 * np.linalg.norm(vertices[drawn] - soft)


@pytest.mark.parametrize("method", METHODS)
def test_one_made_ready_serves_many_targets(method) -> None:
    vertices, triangles = ball(1)
    held = np.array([0, 1, 2, 30])
    ready = method(vertices, triangles, handles(len(vertices), held))
    for seed in range(3):
        hard = vertices[held] + np.random.default_rng(seed).normal(0, 0.3, (4, 3))
        fresh = method(vertices, triangles, handles(len(vertices), held))
        np.testing.assert_array_equal(ready(hard), fresh(hard))


def test_harmonic_displacements_keep_between_those_of_the_targets() -> None:
    """Shifts of two ends that need no rotation: what lies between is shifted by something between."""
    vertices, triangles = bar()
    held = np.concatenate([np.arange(12), np.arange(len(vertices) - 12, len(vertices))])
    hard = vertices[held] + np.where(np.arange(24) < 12, 0.0, 0.5)[:, None] * [0, 1, 0]
    away = LaplacianDeformation(vertices, triangles, handles(len(vertices), held), order=1)(hard) - vertices
    assert away[:, 1].min() >= -1e-9 and away[:, 1].max() <= 0.5 + 1e-9
    np.testing.assert_allclose(away[:, 1], 0.5 * vertices[:, 1], atol=1e-9)  # linear along the bar


def test_a_biharmonic_bump_is_smooth_where_a_harmonic_one_is_a_spike() -> None:
    vertices, triangles = grid(17)
    rim = np.flatnonzero((np.abs(vertices[:, :2] - 0.5) > 0.49).any(1))
    held = np.append(rim, 17 * 8 + 8)
    hard = vertices[held].copy()
    hard[-1, 2] = 0.2
    heights = [
        LaplacianDeformation(vertices, triangles, handles(len(vertices), held), order=order)(hard)[17 * 8 + 9, 2]
        for order in (1, 2)
    ]
    assert heights[1] > 0.9 * 0.2 > 0.7 * 0.2 > heights[0]


def test_a_bar_bent_by_its_ends_keeps_its_lengths() -> None:
    """One end held, the other turned by 90 degrees and brought where a quarter circle of the bar's length ends."""
    vertices, triangles = bar()
    ends = np.arange(12), np.arange(len(vertices) - 12, len(vertices))
    quarter = Rotation.from_euler("z", -90, degrees=True).as_matrix()
    radius = 2 / np.pi
    turned = (vertices[ends[1]] - [0, 1, 0]) @ quarter.T + [radius, radius, 0]
    deform = AsRigidAsPossible(vertices, triangles, handles(len(vertices), np.concatenate(ends)))
    hard = np.concatenate([vertices[ends[0]], turned])
    bent = deform(hard, iterations=400)
    middles = bent.reshape(24, 12, 3).mean(1)
    lengths = np.linalg.norm(np.diff(middles, axis=0), axis=1)
    assert abs(lengths.sum() - 1) < 0.03
    rings = np.linalg.norm(bent.reshape(24, 12, 3) - middles[:, None], axis=2)
    assert np.abs(rings / 0.1 - 1).max() < 0.1  # a tube still, not a flattened one
    away = np.linalg.norm(middles - [radius, 0, 0], axis=1)
    assert np.abs(away / radius - 1).max() < 0.08  # along the circle
    straight = LaplacianDeformation(vertices, triangles, handles(len(vertices), np.concatenate(ends)))(hard)
    assert deform.energy(bent) < 0.5 * deform.energy(straight)


def test_the_energy_never_rises() -> None:
    vertices, triangles = bar()
    held = np.array([0, 3, 6, len(vertices) - 1, len(vertices) - 7])
    hard = vertices[held] + np.random.default_rng(3).normal(0, 0.15, (5, 3))
    soft = vertices[[100, 150]] + [[0.2, 0, 0], [0, 0, 0.2]]
    deform = AsRigidAsPossible(vertices, triangles, handles(len(vertices), held, np.array([100, 150]), 0.5))
    found = [deform(hard, soft, iterations=1)]
    for _ in range(15):
        found.append(deform(hard, soft, start=found[-1], iterations=1))
    energies = [deform.energy(each, soft) for each in found]
    assert all(later <= before * (1 + 1e-12) for before, later in pairwise(energies))
    assert energies[-1] < 0.95 * energies[0]


def test_what_is_stiff_keeps_its_shape() -> None:
    vertices, triangles = bar()
    held = np.concatenate([np.arange(12), np.arange(len(vertices) - 12, len(vertices))])
    hard = vertices[held].copy()
    hard[12:, 1] += 0.3
    stiff = np.where(vertices[:, 1] < 0.5, 100.0, 1.0)
    found = AsRigidAsPossible(vertices, triangles, handles(len(vertices), held), stiff)(hard, iterations=300)
    heights = found.reshape(24, 12, 3)[:, :, 1].mean(1)
    assert heights[11] - heights[0] < 1.03 * (vertices[11 * 12, 1] - vertices[0, 1])


def test_two_targets_or_points_on_a_line_turn_nothing_about_it() -> None:
    vertices, triangles = bar()
    poles = np.array([0, len(vertices) - 12])  # one above the other
    for method in (LaplacianDeformation, AsRigidAsPossible):
        found = method(vertices, triangles, handles(len(vertices), poles))(vertices[poles] + SHIFT)
        np.testing.assert_allclose(found, vertices + SHIFT, atol=1e-9)


@pytest.mark.parametrize("method", METHODS)
def test_triangles_without_area_do_no_harm(method) -> None:
    """A vertex on an edge's middle, one on top of another, and a triangle that names a vertex twice."""
    vertices, triangles = ball(1)
    count = len(vertices)
    a, b = triangles[0, :2]
    more = np.concatenate([vertices, [(vertices[a] + vertices[b]) / 2, vertices[7]]])
    faces = np.concatenate([triangles, [[a, b, count], [7, count + 1, triangles[triangles == 7][0]], [3, 3, 4]]])
    faces = np.concatenate([faces, [[7, count + 1, 8]]])
    held = np.array([1, 20, 33])
    wanted = more @ TURN.T + SHIFT
    found = method(more, faces, handles(len(more), held))(wanted[held])
    np.testing.assert_allclose(found, wanted, atol=1e-7)
    pulled = method(more, faces, handles(len(more), held))(wanted[held] + [[0.2, 0, 0], [0, 0, 0], [0, 0.1, 0]])
    assert np.isfinite(pulled).all() and np.abs(pulled - wanted).max() < 0.6


@pytest.mark.parametrize("method", METHODS)
def test_vertices_of_no_triangle_stay_but_for_their_own_targets(method) -> None:
    vertices, triangles = ball(1)
    count = len(vertices)
    more = np.concatenate([vertices, [[9.0, 9, 9], [8.0, 8, 8], [7.0, 7, 7]]])
    held, drawn = np.array([0, 1, 2, count]), np.array([count + 1])
    hard = np.concatenate([vertices[:3] + SHIFT, [[1.0, 2, 3]]])
    found = method(more, triangles, handles(count + 3, held, drawn))(hard, np.array([[4.0, 5, 6]]))
    np.testing.assert_allclose(found[:count], vertices + SHIFT, atol=1e-9)
    np.testing.assert_allclose(found[count:], [[1, 2, 3], [4, 5, 6], [7, 7, 7]], atol=1e-9)


@pytest.mark.parametrize("method", METHODS)
def test_a_piece_without_a_target_is_named(method) -> None:
    vertices, triangles = ball(1)
    count = len(vertices)
    both, faces = np.concatenate([vertices, vertices + 5]), np.concatenate([triangles, triangles + count])
    with pytest.raises(ValueError, match=f"1 of the surface's pieces .* {count} vertices about vertex {count}"):
        method(both, faces, handles(2 * count, np.array([0, 1, 2])))
    with pytest.raises(ValueError, match="no target"):  # a target of no weight is none
        method(vertices, triangles, handles(count, None, np.array([4, 5]), 0.0))


@pytest.mark.parametrize("method", METHODS)
def test_all_vertices_held_are_where_they_are_held(method) -> None:
    vertices, triangles = ball(1)
    wanted = np.random.default_rng(2).normal(0, 1, vertices.shape)
    deform = method(vertices, triangles, handles(len(vertices), np.arange(len(vertices))))
    np.testing.assert_array_equal(deform(wanted), wanted)


def test_what_is_no_target_is_refused() -> None:
    vertices, triangles = ball(1)
    deform = AsRigidAsPossible(vertices, triangles, handles(len(vertices), np.array([0, 1])))
    with pytest.raises(ValueError, match="2 targets are needed"):
        deform(vertices[:1])
    with pytest.raises(ValueError, match="not finite"):
        deform(np.full((2, 3), np.nan))
    with pytest.raises(ValueError, match="not finite"):
        AsRigidAsPossible(np.where(vertices > 1, np.inf, vertices), triangles, handles(len(vertices), np.array([0])))
    with pytest.raises(ValueError, match="held twice"):
        handles(5, np.array([1, 1]))
    for wrong in (handles, lambda n, v: handles(n, None, v)):
        with pytest.raises(ValueError, match="not"):
            wrong(5, np.array([5]))
    with pytest.raises(ValueError, match="not negative"):
        handles(5, None, np.array([1]), -1.0)


def test_the_laplacian_is_zero_on_linear_functions_of_the_plane_and_areas_sum_up() -> None:
    """Equilateral triangles: all cotangents are within the bounds, and inner vertices balance exactly."""
    vertices, triangles = grid(7)
    sheared = vertices @ np.array([[1, 0, 0], [-0.5, np.sqrt(0.75), 0], [0, 0, 1.0]])
    laplacian = cotangent_laplacian(sheared, triangles)
    inner = (np.abs(vertices[:, :2] - 0.5) < 0.49).all(1)
    np.testing.assert_allclose((laplacian @ sheared)[inner], 0, atol=1e-12)
    np.testing.assert_allclose(laplacian @ np.ones(len(vertices)), 0, atol=1e-12)
    assert vertex_areas(sheared, triangles).sum() == pytest.approx(np.sqrt(0.75))
