"""Catmull-Clark against the values one can work out by hand."""

import numpy as np
import pytest

from engine.body import Template
from engine.body.subdivision import catmull_clark

CUBE = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)], float)
CUBE_FACES = np.array([[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]])


def test_a_cubes_first_step() -> None:
    step = catmull_clark(CUBE_FACES, 8)
    fine = step.points @ CUBE
    assert fine.shape == (8 + 12 + 6, 3)
    assert step.quads.shape == (24, 4)
    np.testing.assert_allclose(np.abs(fine[:8]), 5 / 9)  # (Q + 2 R) / 3 with Q = 1/3 and R = 2/3
    np.testing.assert_allclose(np.sort(np.abs(fine[8:20]), 1), np.tile([0, 0.75, 0.75], (12, 1)), atol=1e-12)
    np.testing.assert_allclose(np.sort(np.abs(fine[20:]), 1), np.tile([0, 0, 1], (6, 1)), atol=1e-12)


def test_faces_keep_their_sense() -> None:
    fine, quads = catmull_clark(CUBE_FACES, 8).points @ CUBE, catmull_clark(CUBE_FACES, 8).quads
    corners = fine[quads]
    normals = np.cross(corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1])
    assert ((normals * corners.mean(1)).sum(1) > 0).all()


@pytest.mark.parametrize("smooth", [True, False])
def test_a_flat_grid_with_borders_stays_flat_and_keeps_affine_fields(smooth: bool) -> None:
    index = np.arange(20).reshape(4, 5)
    quads = np.stack([index[:-1, :-1], index[:-1, 1:], index[1:, 1:], index[1:, :-1]], 2).reshape(-1, 4)
    step = catmull_clark(quads, 20, smooth=smooth)
    np.testing.assert_allclose(np.asarray(step.points.sum(1)), 1)
    grid = np.stack(np.unravel_index(np.arange(20), (4, 5)), 1).astype(float)
    fine = step.points @ grid
    middles = fine[
        20 + len(np.unique(np.sort(np.stack([quads, np.roll(quads, -1, 1)], 2).reshape(-1, 2), 1), axis=0)) :
    ]
    np.testing.assert_allclose(middles, grid[quads].mean(1))
    if not smooth:
        np.testing.assert_array_equal(fine[:20], grid)


def test_a_corner_that_two_faces_share_stays() -> None:
    """Four border edges meet there: no single curve goes through, so it stays."""
    places = np.array([[0, 0], [1, 0], [1, 1], [0, 1], [2, 1], [2, 2], [1, 2]], float)
    step = catmull_clark(np.array([[0, 1, 2, 3], [2, 4, 5, 6]]), len(places))
    fine = step.points @ places
    np.testing.assert_allclose(fine[2], places[2])
    np.testing.assert_allclose(fine[0], [0.125, 0.125])  # (L + 6 P + R) / 8 along a border


def test_the_template_shrinks_only_a_little(template: Template) -> None:
    faces = template.quads[slice(*template.parts["body"])]
    step = catmull_clark(faces, len(template.vertices))
    used = template.vertices_of("body")
    moved = np.linalg.norm((step.points @ template.vertices)[used] - template.vertices[used], axis=1)
    assert np.median(moved) < 5e-4
    assert moved.max() < 1e-2
