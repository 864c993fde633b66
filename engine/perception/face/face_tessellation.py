"""The triangles of the face mesh: its surface, and what closes the openings of mouth and eyes."""

from __future__ import annotations

from collections import Counter
from functools import cache
from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from engine.perception.face.head_pose import canonical_face
from engine.perception.face.landmarks import LEFT_EYE, LIPS_INNER, RIGHT_EYE
from engine.perception.solutions import load_solution

_OPENING_TRIANGLES = 2 * (len(LIPS_INNER) // 2 - 1) + 2 * (len(RIGHT_EYE) // 2 - 1) + 2 * (len(LEFT_EYE) // 2 - 1)


@cache
def face_triangles() -> NDArray[np.int32]:
    """(852, 3) the surface, but for the openings of mouth and eyes; clockwise as seen in a picture, y down.

    MediaPipe gives the edges alone: the triangles are their cycles of three, but for two about the nostrils whose three edges have
    two other triangles each.
    """
    return _disk()[:-_OPENING_TRIANGLES]


@cache
def opening_triangles() -> NDArray[np.int32]:
    """(46, 3) strips from lid to lid and from lip to lip, of the same orientation: with them the face has no hole."""
    return _disk()[-_OPENING_TRIANGLES:]


@cache
def _disk() -> NDArray[np.int32]:
    """The surface, then what closes its openings, all turned alike: a disk."""
    edges = {(min(edge), max(edge)) for edge in load_solution("face_mesh_connections").FACEMESH_TESSELATION}
    beside: dict[int, set[int]] = {}
    for a, b in edges:
        beside.setdefault(a, set()).add(b)
        beside.setdefault(b, set()).add(a)
    cycles = sorted({tuple(sorted((a, b, c))) for a, b in edges for c in beside[a] & beside[b]})
    owners = Counter(edge for cycle in cycles for edge in combinations(cycle, 2))
    surface = [cycle for cycle in cycles if min(owners[edge] for edge in combinations(cycle, 2)) < 3]
    openings = [_strip(contour) for contour in (LIPS_INNER, RIGHT_EYE, LEFT_EYE)]
    triangles = _wound_alike(np.concatenate([surface, *openings]).astype(np.int32))
    corners = canonical_face()[:, :2].astype(float)[triangles]
    first, second = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    clockwise = float((first[:, 0] * second[:, 1] - first[:, 1] * second[:, 0]).sum()) > 0
    return triangles if clockwise else np.ascontiguousarray(triangles[:, ::-1])


def _wound_alike(triangles: NDArray[np.int32]) -> NDArray[np.int32]:
    """Triangles (N, 3) of a surface in one piece, those reversed that are not wound as the first: an edge of two triangles is run
    through in both directions."""
    wound = triangles.tolist()
    beside: dict[tuple[int, int], list[int]] = {}
    for number, corners in enumerate(wound):
        for a, b in combinations(sorted(corners), 2):
            beside.setdefault((a, b), []).append(number)
    reached, waiting = {0}, [0]
    while waiting:
        for a, b in _sides(wound[waiting.pop()]):
            for number in beside[min(a, b), max(a, b)]:
                if number not in reached:
                    if (a, b) in _sides(wound[number]):
                        wound[number] = wound[number][::-1]
                    reached.add(number)
                    waiting.append(number)
    return np.array(wound, np.int32)


def _sides(corners: list[int]) -> list[tuple[int, int]]:
    """Of a triangle, as it is wound."""
    a, b, c = corners
    return [(a, b), (b, c), (c, a)]


def _strip(contour: tuple[int, ...]) -> NDArray[np.int32]:
    """A closed contour from corner over corner, vertex k facing vertex -k, as triangles between its two sides."""
    count = len(contour)
    found = []
    for k in range(count // 2):
        a, b, c, d = contour[k], contour[k + 1], contour[(-k - 1) % count], contour[-k % count]
        found += [one for one in ((a, b, c), (a, c, d)) if len(set(one)) == 3]
    return np.array(found, np.int32)
