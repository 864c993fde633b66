"""Surfaces laid on points."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
import scipy.sparse as sp
import trimesh
from numpy.typing import NDArray

from engine.geometry.mesh.closest_points import closest_points
from engine.geometry.mesh.surface import vertex_normals
from engine.geometry.registration.nonrigid_registration import (
    ElasticSurface,
    SurfaceLandmarks,
    geometric_steps,
    lay_on_points,
)

STEPS = geometric_steps(5, (1e-5, 1e-10), (1, 1e-2), (0.08, 0.03))


def icosphere(subdivisions: int) -> tuple[NDArray[np.float64], NDArray[np.int32]]:
    mesh = trimesh.creation.icosphere(subdivisions)
    return np.asarray(mesh.vertices, np.float64), np.asarray(mesh.faces, np.int32)


def _surface(vertices: NDArray[np.float64], triangles: NDArray[np.int32]) -> ElasticSurface:
    ones = np.ones(len(vertices))
    return ElasticSurface(vertices, triangles, np.ones(len(triangles), np.bool_), ones, ones)


def test_a_sphere_becomes_the_ellipsoid_that_was_measured() -> None:
    vertices, triangles = icosphere(3)
    sphere, ellipsoid = vertices * 0.2, vertices * [0.22, 0.25, 0.18]
    fine, fine_triangles = icosphere(5)
    points = fine * [0.22, 0.25, 0.18]
    laid = lay_on_points(_surface(sphere, triangles), points, vertex_normals(points, fine_triangles), STEPS)
    assert closest_points(points, laid, triangles).distance.mean() < 1e-3
    assert np.linalg.norm(laid - ellipsoid, axis=1).mean() < 0.01  # slides little


def test_a_hole_is_bridged_and_outliers_are_ignored() -> None:
    vertices, triangles = icosphere(3)
    fine, fine_triangles = icosphere(5)
    points, normals = fine * 0.21, vertex_normals(fine, fine_triangles)
    there = points[:, 1] < 0.15
    stray = np.array([[0.0, 0.5, 0], [0.5, 0, 0], [0, 0, -0.6]])
    seen = np.concatenate([points[there], stray])
    facing = np.concatenate([normals[there], stray / np.linalg.norm(stray, axis=1, keepdims=True)])
    laid = lay_on_points(_surface(vertices * 0.2, triangles), seen, facing, STEPS)
    assert np.abs(np.linalg.norm(laid, axis=1) - 0.21).max() < 6e-3


def test_a_limb_that_no_point_is_of_stays_where_it_was_if_it_is_anchored() -> None:
    """Points of one half of a rod that was turned by three degrees about its middle: the other half would swing along."""
    rod = trimesh.creation.cylinder(0.04, 1.0, 24).subdivide_to_size(0.05)
    vertices, triangles = np.asarray(rod.vertices, np.float64), np.asarray(rod.faces, np.int32)
    turned = rod.copy().apply_transform(trimesh.transformations.rotation_matrix(np.radians(3), [0, 1, 0]))
    points, faces = trimesh.sample.sample_surface(turned, 4000, seed=0)
    there = points[:, 2] < 0
    measured = points[there], turned.face_normals[faces[there]]
    free, anchored = (
        lay_on_points(replace(_surface(vertices, triangles), anchor=anchor), *measured, STEPS) for anchor in (0.0, 0.01)
    )
    far, near = vertices[:, 2] > 0.3, vertices[:, 2] < -0.1
    moved = [np.linalg.norm(laid - vertices, axis=1)[far].mean() for laid in (free, anchored)]
    assert moved[0] > 0.015  # metres
    assert moved[1] < 0.002
    assert closest_points(points[there], anchored, triangles).distance.mean() < 1e-3
    assert np.linalg.norm(anchored - free, axis=1)[near].mean() < 2e-3  # what points tell stands


def test_landmarks_pull_along_the_surface() -> None:
    """Points of a sphere do not tell how it was turned; landmarks do."""
    vertices, triangles = icosphere(3)
    rest = vertices * 0.2
    angle = 0.25
    turn = np.array([[np.cos(angle), 0, np.sin(angle)], [0, 1, 0], [-np.sin(angle), 0, np.cos(angle)]])
    turned = rest @ turn.T
    chosen = np.arange(0, len(rest), 40)
    rows = sp.csr_array((np.ones(len(chosen)), (np.arange(len(chosen)), chosen)), (len(chosen), len(rest)))
    normals = vertex_normals(turned, triangles)
    free = lay_on_points(_surface(rest, triangles), turned, normals, STEPS)
    drawn = lay_on_points(_surface(rest, triangles), turned, normals, STEPS, SurfaceLandmarks(rows, turned[chosen]))
    off = [np.linalg.norm(laid - turned, axis=1).mean() for laid in (free, drawn)]
    assert off[0] > 0.02  # metres
    assert off[1] < 0.008  # and less with more iterations


def test_what_is_held_stays_and_the_rest_follows() -> None:
    vertices, triangles = icosphere(2)
    held = vertices[:, 1] < -0.5
    cloud, normals = 1.1 * vertices, vertices
    surface = replace(_surface(vertices, triangles), held=held)
    moved = lay_on_points(surface, cloud, normals, geometric_steps(4, (1e-3, 1e-7), (1.0, 1.0), (0.5, 0.3)))
    np.testing.assert_array_equal(moved[held], vertices[held])
    top = vertices[:, 1] > 0.5
    assert np.linalg.norm(moved[top] - cloud[top], axis=1).mean() < 0.02


def test_noise_crumples_nothing_and_what_is_measured_well_is_followed() -> None:
    vertices, triangles = icosphere(3)
    fine, _ = icosphere(5)
    noise = np.where(fine[:, 1] > 0, 0.012, 0.0005)
    random = np.random.default_rng(4)
    points = fine * (0.205 + random.normal(0, noise))[:, None]
    believing = replace(_surface(vertices * 0.2, triangles), point_sigma=0.0015)
    laid, plain = (lay_on_points(of, points, fine, STEPS) for of in (believing, _surface(vertices * 0.2, triangles)))
    upper = vertices[:, 1] > 0.2
    roughness = [np.linalg.norm(of[upper], axis=1).std() for of in (laid, plain)]
    assert roughness[0] < 0.5 * roughness[1]
    assert np.abs(np.linalg.norm(laid[vertices[:, 1] < -0.2], axis=1) - 0.205).max() < 0.0015


def test_nothing_near_is_said() -> None:
    vertices, triangles = icosphere(1)
    with pytest.raises(ValueError, match="no point"):
        lay_on_points(_surface(vertices, triangles), np.full((4, 3), 9.0), np.ones((4, 3)), STEPS)
