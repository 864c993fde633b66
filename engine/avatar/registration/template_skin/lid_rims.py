"""The rim of the lids about an eye, the loop of the template's edges at which its skin turns to the eyeball, and what is behind it."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Collection

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_array
from scipy.sparse.csgraph import connected_components

from engine.body.template import Template
from engine.geometry.mesh.adjacency import edge_table
from engine.geometry.mesh.surface import triangulate

UPPER_LID_MIN_HEIGHT_RADII = 0.25
"""Radii of the eyeball above its middle beyond which what is near to it is of the upper lid."""
LID_RIM_RADII = 1.02, 1.08
"""Radii of the eyeball about its middle between which a lid's rim lies."""
REACH_RADII = 2.5
"""Radii of the eyeball about its middle within which edges of skin are looked at."""
LID_COLUMN_VERTICES = 12
"""Vertices of a column of an upper lid, from its rim to above the brow."""


def lid_rim(template: Template, part: str) -> NDArray[np.intp]:
    """(R,) the template's vertices about an eyeball `part`, one after the other: from the middle of the upper lid along edges
    that cross no quad, which is one closed loop.

    Raises ValueError where the template has no such loop.
    """
    eyeball = template.vertices[template.vertices_of(part)].astype(np.float64)
    middle = (eyeball.max(0) + eyeball.min(0)) / 2
    radius = float(np.linalg.norm(eyeball - middle, axis=1).mean())
    edges = _Edges.about(template, part)
    skin = np.unique(template.quads[template.faces("body")])
    away = (template.vertices[skin] - middle) / radius
    reach = np.linalg.norm(away, axis=1)
    above = (
        (away[:, 1] > UPPER_LID_MIN_HEIGHT_RADII)
        & (away[:, 2] > 0)
        & (reach > LID_RIM_RADII[0])
        & (reach < LID_RIM_RADII[1])
    )
    if not above.any():
        raise ValueError(f"no lid lies about {part}")
    first = int(skin[above][np.argmax(away[above, 2])])
    loops = [found for beside in edges.beside[first] if (found := edges.loop(first, beside)) is not None]
    if not loops:
        raise ValueError(f"no loop of edges lies about {part}")
    return np.array(min(loops, key=lambda loop: float(np.ptp(template.vertices[loop], axis=0)[2])), np.intp)


def upper_lid_columns(template: Template, part: str) -> NDArray[np.intp]:
    """(C, `LID_COLUMN_VERTICES`) the template's vertices up from each of the rim of the upper lid about an eyeball `part`, but for its
    corners: along edges that cross no quad.

    Raises ValueError where the template has no such columns.
    """
    rim = lid_rim(template, part)
    body = triangulate(template.quads[template.faces("body")])
    socket = np.unique(body[behind_rims(body, [rim])])
    edges = _Edges.about(template, part)
    across, height = template.vertices[rim, 0], template.vertices[rim, 1]
    ends = np.argsort(across)[[0, -1]]
    upper = height > np.interp(across, across[ends], height[ends])
    found = []
    for first in rim[upper].tolist():
        outwards = edges.beside[first].difference(rim.tolist(), socket.tolist())
        column = edges.straight(first, min(outwards), LID_COLUMN_VERTICES) if len(outwards) == 1 else None
        if column is None:
            raise ValueError(f"no columns of edges go up from {part}")
        found.append(column)
    return np.array(found, np.intp)


def behind_rims(triangles: NDArray[np.integer], rims: Collection[NDArray[np.integer]]) -> NDArray[np.bool_]:
    """(T,) which of the triangles (T, 3) of a skin are sockets: what `rims`, closed loops of its edges, cut off all else."""
    loops = [np.stack([rim, np.roll(rim, -1)], 1) for rim in rims]
    cut = {frozenset(edge) for edge in np.concatenate(loops).tolist()}
    table = edge_table(np.ascontiguousarray(triangles, np.int32), np.arange(int(triangles.max()) + 1, dtype=np.int32))
    whole = np.array([frozenset(edge) not in cut for edge in table[:, :2].tolist()])
    pairs = table[whole & (table[:, 3] >= 0), 2:]
    links = csr_array((np.ones(len(pairs)), (pairs[:, 0], pairs[:, 1])), (len(triangles), len(triangles)))
    piece = connected_components(links, directed=False)[1]
    return np.asarray(piece != np.bincount(piece).argmax())


class _Edges:
    """The edges of quads (Q, 4) all of whose vertices are `near` (V,)."""

    def __init__(self, quads: NDArray[np.integer], near: NDArray[np.bool_]):
        self.beside: dict[int, set[int]] = defaultdict(set)
        self._quads: dict[frozenset[int], set[int]] = defaultdict(set)
        for number, quad in enumerate(quads[near[quads].all(1)].tolist()):
            for one, other in zip(quad, [*quad[1:], quad[0]], strict=True):
                self.beside[one].add(other)
                self.beside[other].add(one)
                self._quads[frozenset((one, other))].add(number)

    @classmethod
    def about(cls, template: Template, part: str) -> _Edges:
        """Those of the skin about an eyeball."""
        eyeball = template.vertices[template.vertices_of(part)].astype(np.float64)
        middle = (eyeball.max(0) + eyeball.min(0)) / 2
        reach = REACH_RADII * float(np.linalg.norm(eyeball - middle, axis=1).mean())
        near = np.linalg.norm(template.vertices - middle, axis=1) < reach
        return cls(template.quads[template.faces("body")], near)

    def straight(self, first: int, second: int, count: int) -> list[int] | None:
        """`count` vertices of the line that begins with an edge; None where it ends before."""
        found = [first, second]
        while len(found) < count:
            ahead = self._straight_on(found[-2], found[-1])
            if ahead is None:
                return None
            found.append(ahead)
        return found

    def loop(self, first: int, second: int) -> list[int] | None:
        """The vertices of the loop that begins with an edge; None where it does not close."""
        found = [first, second]
        while len(found) <= len(self.beside):
            ahead = self._straight_on(found[-2], found[-1])
            if ahead is None:
                return None
            if ahead == first:
                return found
            found.append(ahead)
        return None

    def _straight_on(self, before: int, at: int) -> int | None:
        """The vertex across a crossing of four edges."""
        if len(self.beside[at]) != 4:
            return None
        beside = self._quads[frozenset((before, at))]
        others = [v for v in self.beside[at] if v != before and not self._quads[frozenset((at, v))] & beside]
        return others[0] if len(others) == 1 else None
