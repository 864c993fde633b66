"""The face mesh is a surface with three openings, and a disk where these are closed."""

from __future__ import annotations

from collections import Counter
from itertools import combinations

import numpy as np

from engine.perception.face.face_tessellation import face_triangles, opening_triangles
from engine.perception.face.head_pose import canonical_face
from engine.perception.face.landmarks import FACE_OVAL, LEFT_EYE, LIPS_INNER, RIGHT_EYE


def rim(triangles: np.ndarray) -> set[int]:
    owners = Counter(tuple(sorted(edge)) for one in triangles.tolist() for edge in combinations(one, 2))
    assert max(owners.values()) == 2, "no edge has a third triangle"
    return {vertex for edge, count in owners.items() if count == 1 for vertex in edge}


def test_the_surface_ends_at_its_oval_lids_and_lips() -> None:
    triangles = face_triangles()
    assert triangles.shape == (852, 3) and len(np.unique(triangles)) == 468
    assert rim(triangles) == {*FACE_OVAL, *LIPS_INNER, *LEFT_EYE, *RIGHT_EYE}


def test_with_its_openings_closed_it_is_a_disk() -> None:
    closed = np.concatenate([face_triangles(), opening_triangles()])
    assert rim(closed) == set(FACE_OVAL)
    edges = {tuple(sorted(edge)) for one in closed.tolist() for edge in combinations(one, 2)}
    assert 468 - len(edges) + len(closed) == 1, "Euler's characteristic"


def test_neighbours_turn_alike() -> None:
    closed = np.concatenate([face_triangles(), opening_triangles()])
    directed = Counter((int(one[k]), int(one[(k + 1) % 3])) for one in closed for k in range(3))
    assert max(directed.values()) == 1, "an edge is walked once each way"


def test_from_before_most_of_it_faces_us() -> None:
    corners = canonical_face()[face_triangles()]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    assert (normals[:, 2] > 0).mean() > 0.99
