"""The face's contour: at rest nothing moves; it goes out with what would pass it; nothing beside it is torn from it."""

from __future__ import annotations

import numpy as np
import pytest
from made_face import placed
from numpy.typing import NDArray

from engine.face_animation.motion_transfer.contour import (
    DEPTH_BAND_EYE_DISTANCES,
    EAR_VERTICES,
    EVEN_BAND_EYE_DISTANCES,
    MAX_DISTANCE_GAIN,
    beside_contour,
    even_depth,
    even_expression,
    keep_inside,
    rim_distance,
)
from engine.perception.face.landmarks import FACE_OVAL, LEFT_EYE, MESH_SIZE, RIGHT_EYE

UNIT = 50.0
SEEN = np.ones(MESH_SIZE, bool)
CENTRE = (150.0, 120.0)
CHEEK, TIP, LIP = 147, 4, 17
"""Vertices inside the right cheek, of the nose's tip, and under the lower lip."""


@pytest.fixture(scope="module")
def mesh() -> NDArray[np.float64]:
    return placed(UNIT, CENTRE)[:, :2].astype(float)


def test_a_face_at_rest_stays_as_it_is_wherever_it_is(mesh: NDArray) -> None:
    faces = np.stack([mesh, 1.3 * mesh + (20, -5)])
    kept = faces.copy()
    keep_inside(kept, mesh, SEEN)
    np.testing.assert_allclose(kept, faces, atol=1e-9)


def test_where_a_cheek_passes_its_contour_that_goes_out_with_it(mesh: NDArray) -> None:
    """The greater part of the way; the other side of the face stays as it is."""
    faces = mesh[None].copy()
    faces[0, CHEEK, 0] -= 0.6 * UNIT
    kept = faces.copy()
    keep_inside(kept, mesh, SEEN)
    own, passed, now = (-rim_distance(face, face[[CHEEK]])[0] for face in (mesh, faces[0], kept[0]))
    assert passed < -0.2 * UNIT
    assert -0.01 * UNIT < now < own
    assert np.linalg.norm(kept[0, CHEEK] - faces[0, CHEEK]) < 0.5 * np.linalg.norm(faces[0, CHEEK] - mesh[CHEEK])
    other = mesh[:, 0] > mesh[TIP, 0]
    np.testing.assert_allclose(kept[0, other], faces[0, other], atol=0.02 * UNIT)


def test_no_point_of_a_turned_head_lies_beyond_the_contour_of_its_cheeks(mesh: NDArray) -> None:
    """At 20 degrees to either side many would; and the eyes keep their places."""
    faces = np.stack([placed(UNIT, CENTRE, yaw)[:, :2] for yaw in (-20.0, 20.0)]).astype(float)
    kept = faces.copy()
    keep_inside(kept, mesh, SEEN)
    cheeks = np.flatnonzero((mesh[:, 1] > mesh[EAR_VERTICES[0], 1]) & (mesh[:, 1] < mesh[LIP, 1]))
    for turned, now in zip(faces, kept, strict=True):
        assert (rim_distance(turned, turned[cheeks]) > 0.01 * UNIT).sum() >= 10
        assert rim_distance(now, now[cheeks]).max() < 0.01 * UNIT
    eyes = list(RIGHT_EYE + LEFT_EYE)
    np.testing.assert_allclose(kept[:, eyes], faces[:, eyes], atol=0.01 * UNIT)


def test_a_point_beside_the_contour_is_stretched_no_more_than_its_side(mesh: NDArray) -> None:
    faces = mesh[None].copy()
    faces[0, CHEEK, 0] += UNIT
    kept = faces.copy()
    keep_inside(kept, mesh, SEEN)
    own, now = (-rim_distance(mesh, face[[CHEEK]])[0] for face in (mesh, kept[0]))
    assert now == pytest.approx(MAX_DISTANCE_GAIN * own, rel=0.1)
    others = np.arange(MESH_SIZE) != CHEEK
    np.testing.assert_array_equal(kept[0, others], faces[0, others])


def test_where_the_contour_is_out_of_sight_all_stays_as_it_is(mesh: NDArray) -> None:
    faces = mesh[None].copy()
    faces[0, CHEEK, 0] -= UNIT
    kept = faces.copy()
    keep_inside(kept, mesh, ~SEEN)
    np.testing.assert_array_equal(kept, faces)
    assert not beside_contour(mesh, ~SEEN).any()


def test_what_lies_beside_the_cheeks_contour_is_told_from_the_contour(mesh: NDArray) -> None:
    beside = beside_contour(mesh, SEEN)
    assert beside[[177, 215, 401, 435]].all()
    assert not beside[list(FACE_OVAL)].any()
    assert not beside[[4, 10, 151, 13, 17, 152, 33, 263]].any()


def test_beside_the_contour_neighbours_do_the_same_and_the_jaw_follows() -> None:
    """Restless vertices give no teeth; above the cheekbones nothing is left of them, further in nothing is changed."""
    face = placed(50.0, (150.0, 150.0))
    even = even_expression(face, np.ones(MESH_SIZE, bool))
    inside = rim_distance(face, face[:, :2]) < -EVEN_BAND_EYE_DISTANCES * 50
    np.testing.assert_allclose(even[inside], np.eye(MESH_SIZE)[inside], atol=1e-12)
    down = np.zeros((MESH_SIZE, 2))
    down[face[:, 1] > face[14, 1]] = (0.0, 9.0)
    opened = even @ down
    assert opened[152, 1] > 8 and not opened[[10, 127, 356, 54, 284]].any()
    restless = even @ np.random.default_rng(0).normal(0, 5, (MESH_SIZE, 2))
    oval = restless[list(FACE_OVAL)]
    assert np.abs(oval - np.roll(oval, 1, axis=0)).max() < 3


def test_depth_on_the_contour_is_its_own_and_inside_the_face_s() -> None:
    face = placed(50.0, (150.0, 150.0))
    depth = even_depth(face)
    inside = rim_distance(face, face[:, :2]) < -DEPTH_BAND_EYE_DISTANCES * 50
    np.testing.assert_allclose(depth[inside], face[inside, 2])
    assert np.abs(depth[list(FACE_OVAL)] - face[list(FACE_OVAL), 2]).max() < 0.15 * 50
