"""The mesh of a face parts along lips and lids."""

from __future__ import annotations

import numpy as np
from made_face import placed

from engine.face_animation.motion_transfer.lids_and_lips import INNER_LIP_PAIRS
from engine.face_animation.warping.dense_field import build_warp_mesh
from engine.face_animation.warping.lip_edges import (
    GIVING_WAY_EYE_DISTANCES,
    MIN_LIP_GAP_PIXELS,
    gives_way_around_lips,
    parted_lips,
    parting_edges,
)
from engine.face_animation.warping.unfold import MIN_AREA_SHARE, unfold
from engine.geometry.mesh.adjacency import edges
from engine.perception.face.landmarks import CHIN_VERTEX, LEFT_EYE, LIPS_INNER, LIPS_OUTER, RIGHT_EYE, eye_distance

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


def test_what_is_around_lips_gives_way_and_inner_edges_eyes_and_chin_stay() -> None:
    gives = gives_way_around_lips(FACE)
    assert gives[list(LIPS_OUTER)].all() and not gives[[*LIPS_INNER, *LEFT_EYE, *RIGHT_EYE, CHIN_VERTEX]].any()
    away = np.linalg.norm(FACE[:, None, :2] - FACE[list(LIPS_OUTER), :2], axis=2).min(axis=1)
    assert away[gives].max() < GIVING_WAY_EYE_DISTANCES * eye_distance(FACE[:, :2])


def test_a_corner_of_the_mouth_that_is_pushed_over_the_cheek_does_not_fold_it() -> None:
    mesh = build_warp_mesh(FACE[:, :2], FACE, (600, 600))
    corner = LIPS_OUTER[0]
    offsets = np.zeros((len(mesh.vertices), 3))
    offsets[:, 0] = -14 * np.exp(-((np.linalg.norm(mesh.vertices - mesh.vertices[corner], axis=1) / 7) ** 2))
    offsets[list(LIPS_INNER)] = 0
    held = np.zeros(len(mesh.vertices), bool)
    assert _smallest_share(mesh.vertices, mesh.triangles, offsets) < 0
    held[: len(FACE)] = ~gives_way_around_lips(FACE)
    unfold(offsets, mesh.vertices, mesh.triangles, held, np.full(len(mesh.triangles), MIN_AREA_SHARE))
    assert _smallest_share(mesh.vertices, mesh.triangles, offsets) > MIN_AREA_SHARE / 2


def _smallest_share(vertices: np.ndarray, triangles: np.ndarray, offsets: np.ndarray) -> float:
    """Of their area, what the triangle that keeps least has left."""
    areas = []
    for places in (vertices, vertices + offsets[:, :2]):
        a, b, c = (places[triangles[:, k]] for k in range(3))
        areas.append((b[:, 0] - a[:, 0]) * (c[:, 1] - a[:, 1]) - (b[:, 1] - a[:, 1]) * (c[:, 0] - a[:, 0]))
    large = np.abs(areas[0]) > 1
    return float((areas[1] / areas[0])[large].min())
