"""The surface at which a field over a grid is zero, as a closed mesh.

Each cell is cut into six tetrahedra around its diagonal, which fit those of the next cell, and in each of them the surface is a
triangle or two. So every edge has two triangles, whatever the field is, and there are no ambiguous cells.

Source: A. Doi, A. Koide, An Efficient Method of Triangulating Equi-Valued Surfaces by Using Tetrahedral Cells, IEICE Transactions
E74, 1991; the cut is that of H. Freudenthal, 1942 (also H. W. Kuhn's).
"""

from __future__ import annotations

from itertools import permutations

import numpy as np
from numpy.typing import ArrayLike, NDArray

CELL_CORNERS = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0], [0, 0, 1], [1, 0, 1], [0, 1, 1], [1, 1, 1]])
"""Of a cell, by their numbers."""
MIN_EDGE_SHARE = 0.02
"""Share of an edge from its ends at which the surface may cross it, at least: no triangle becomes a needle."""


def iso_surface(
    values: NDArray[np.floating], origin: ArrayLike, spacing: float
) -> tuple[NDArray[np.float64], NDArray[np.int32]]:
    """(V, 3) vertices and (T, 3) triangles, counter-clockwise from outside, of the surface around where `values` (X, Y, Z) are
    above zero.

    `origin` (3,) is the place of the first value and `spacing` what lies between two, in one unit. Beyond the grid nothing is
    above zero, so that the surface is closed.
    """
    field = np.pad(np.asarray(values, np.float64), 1, constant_values=min(float(np.min(values, initial=0.0)), -1e-6))
    above, strides = field > 0, np.array([field.shape[1] * field.shape[2], field.shape[2], 1])
    number = sum(_of_cells(above, corner).astype(np.int8) for corner in CELL_CORNERS)
    cells = np.argwhere((number > 0) & (number < len(CELL_CORNERS))) @ strides
    tetrahedra = (cells[:, None, None] + (CELL_CORNERS @ strides)[_tetrahedra()]).reshape(-1, 4)
    edges = _triangles(above.ravel(), tetrahedra)
    crossed, triangles = np.unique(edges.reshape(-1, 2), axis=0, return_inverse=True)
    triangles = triangles.reshape(-1, 3)
    start, end = (np.stack(np.unravel_index(ends, field.shape), 1) for ends in crossed.T)
    inner, outer = field.ravel()[crossed[:, 0]], field.ravel()[crossed[:, 1]]
    share = np.clip(inner / np.maximum(inner - outer, 1e-300), MIN_EDGE_SHARE, 1 - MIN_EDGE_SHARE)
    places = start + share[:, None] * (end - start)
    a, b, c = (places[triangles[:, k]] for k in range(3))
    outwards = (end - start)[triangles].sum(1)
    turned = np.einsum("ij,ij->i", np.cross(b - a, c - a), outwards) < 0
    triangles[turned] = triangles[turned][:, ::-1]
    return np.asarray(origin) + spacing * (places - 1), triangles.astype(np.int32)


def _of_cells(values: NDArray, corner: NDArray[np.integer]) -> NDArray:
    """What each cell has at one of its corners."""
    x, y, z = corner
    a, b, c = values.shape
    return values[x : a - 1 + x, y : b - 1 + y, z : c - 1 + z]


def _tetrahedra() -> NDArray[np.intp]:
    """(6, 4) corners of a cell: the ways along its edges from the first corner to the last."""
    ways = [np.cumsum([0, *(1 << axis for axis in axes)]) for axes in permutations(range(3))]
    return np.array(ways, np.intp)


def _triangles(above: NDArray[np.bool_], tetrahedra: NDArray[np.integer]) -> NDArray[np.integer]:
    """(T, 3, 2) the triangles as three edges each, by the numbers of their ends, the one above zero first."""
    inside = above[tetrahedra]
    order = np.argsort(~inside, axis=1, kind="stable")  # those above zero first
    ends, count = np.take_along_axis(tetrahedra, order, 1), inside.sum(1)
    found = []
    for number, cut in ((1, ((0, 1), (0, 2), (0, 3))), (3, ((0, 3), (1, 3), (2, 3)))):
        found.append(ends[count == number][:, np.array(cut)])
    quads = ends[count == 2]
    for half in (((0, 2), (0, 3), (1, 3)), ((0, 2), (1, 3), (1, 2))):
        found.append(quads[:, np.array(half)])
    return np.concatenate(found)
