"""The mesh of a face parts along lips and lids."""

from __future__ import annotations

import numpy as np
from made_face import placed

from engine.face_animation.motion_transfer.lids_and_lips import INNER_LIP_PAIRS
from engine.face_animation.warping.dense_field import build_warp_mesh
from engine.face_animation.warping.lip_edges import MIN_LIP_GAP_PIXELS, parted_lips, parting_edges
from engine.geometry.mesh.adjacency import edges
from engine.perception.landmarks import LIPS_INNER, LIPS_OUTER

FACE = placed(90, (300, 300)).astype(np.float64)
TOP, BOTTOM = np.array(INNER_LIP_PAIRS).T


def _closed() -> np.ndarray:
    """The face with inner lips that lie on one another, the upper one a little too low."""
    face = FACE.copy()
    middle = (face[TOP] + face[BOTTOM]) / 2
    face[TOP], face[BOTTOM] = middle + np.array([0, 0.4, 0]), middle - np.array([0, 0.4, 0])
    return face


def test_closed_lips_are_in_their_order_and_others_stay() -> None:
    parted = parted_lips(_closed())
    np.testing.assert_allclose(parted[BOTTOM, 1] - parted[TOP, 1], MIN_LIP_GAP_PIXELS, atol=1e-6)
    rest = np.setdiff1d(np.arange(len(FACE)), [*TOP, *BOTTOM])
    np.testing.assert_array_equal(parted[rest], _closed()[rest])
    wide = FACE.copy()
    wide[BOTTOM, 1] += 20
    np.testing.assert_array_equal(parted_lips(wide), wide)


def test_no_triangle_spans_the_lips_edges_where_they_are_closed() -> None:
    face = _closed()
    mesh = build_warp_mesh(face[:, :2], face, (600, 600))
    known = {tuple(edge) for edge in edges(mesh.triangles).tolist()}
    lips = {*LIPS_INNER, *LIPS_OUTER}
    wanted = [tuple(sorted(edge)) for edge in parting_edges(np.arange(len(face))).tolist() if set(edge) <= lips]
    assert len(wanted) == len(LIPS_INNER) + len(LIPS_OUTER)
    assert [edge for edge in wanted if edge not in known] == []


def test_only_edges_between_usable_vertices_are_asked_for() -> None:
    usable = np.setdiff1d(np.arange(len(FACE)), [LIPS_OUTER[3]])
    assert len(parting_edges(usable)) == len(parting_edges(np.arange(len(FACE)))) - 2
