"""The Laplace operator of a triangle mesh: by how much a vertex differs from its neighbours, each by its cotangents.

Source: U. Pinkall, K. Polthier, Computing discrete minimal surfaces and their conjugates, Experimental Mathematics 2, 1993.
"""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray

from engine.geometry.mesh.adjacency import unique_edges

MIN_EDGE_WEIGHT, MAX_EDGE_WEIGHT = 1e-3, 10.0
"""Of an edge. Obtuse pairs of triangles have negative cotangents, slivers boundless ones: within these bounds harmonic
functions keep between the values that they are given, and no system is nearly singular."""


def cotangent_edges(
    vertices: NDArray[np.floating], triangles: NDArray[np.integer]
) -> tuple[NDArray[np.intp], NDArray[np.float64]]:
    """The edges of a mesh, (E, 2), each once with the smaller number first, and their weights (E,): half the sum of the
    cotangents of the angles opposite, from `MIN_EDGE_WEIGHT` to `MAX_EDGE_WEIGHT`.

    `vertices` (V, 3) in any unit, `triangles` (T, 3). A triangle without area gives its edges finite weights, too.
    Raises ValueError where a vertex's place is not finite.
    """
    if not np.isfinite(vertices).all():
        raise ValueError("the surface has places that are not finite")
    corners = np.asarray(triangles, np.intp)
    points = np.asarray(vertices, np.float64)[corners]
    ends, cotangents = [], []
    for k in range(3):
        one, other = points[:, (k + 1) % 3] - points[:, k], points[:, (k + 2) % 3] - points[:, k]
        across = np.linalg.norm(np.cross(one, other), axis=1)
        along = (one * other).sum(1)
        steepest = MAX_EDGE_WEIGHT * np.maximum(across, np.finfo(np.float64).tiny)
        cotangents.append(np.clip(along, -2 * steepest, 2 * steepest) / np.maximum(across, np.finfo(np.float64).tiny))
        ends.append(corners[:, [(k + 1) % 3, (k + 2) % 3]])
    pairs = np.concatenate(ends)
    apart = pairs[:, 0] != pairs[:, 1]
    edges, which = unique_edges(pairs[apart])
    weights = np.bincount(which, np.concatenate(cotangents)[apart] / 2, len(edges))
    return edges, np.clip(weights, MIN_EDGE_WEIGHT, MAX_EDGE_WEIGHT)


def edge_differences(edges: NDArray[np.integer], count: int) -> sp.csr_array:
    """(E, V) sparse: the second end of each edge minus the first, for `count` vertices."""
    rows = np.arange(len(edges))
    return sp.csr_array((np.tile([-1.0, 1.0], len(edges)), (rows.repeat(2), edges.ravel())), shape=(len(edges), count))


def cotangent_laplacian(vertices: NDArray[np.floating], triangles: NDArray[np.integer]) -> sp.csr_array:
    """(V, V) sparse, symmetric, positive semi-definite: row `i` times values is the sum over the neighbours `j` of
    weight * (value i - value j), with the weights of `cotangent_edges`. Zero for vertices of no triangle."""
    edges, weights = cotangent_edges(vertices, triangles)
    differences = edge_differences(edges, len(vertices))
    return sp.csr_array(differences.T @ sp.diags_array(weights) @ differences)
