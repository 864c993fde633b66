"""Triangles split into smaller ones of the same surface."""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray


def midpoint_subdivision(
    triangles: NDArray[np.integer], count: int, rounds: int = 1
) -> tuple[sp.csr_array, NDArray[np.int32]]:
    """Each of the triangles (T, 3) over `count` vertices split in four at the middles of its edges, `rounds` times.

    Returns
    -------
    (M, count) the matrix that gives all vertices of those before, by which any attribute is interpolated, the old ones first; and
    (4^rounds * T, 3) the new triangles, of the same orientation.
    """
    faces = np.asarray(triangles, np.int64)
    matrix = sp.csr_array(sp.eye_array(count))
    for _ in range(rounds):
        known = matrix.shape[0]
        edges = np.sort(np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]]), axis=1)
        unique, place = np.unique(edges, axis=0, return_inverse=True)
        a, b, c = known + place.reshape(3, -1)
        old_a, old_b, old_c = faces.T
        corners = ((old_a, a, c), (a, old_b, b), (c, b, old_c), (a, b, c))
        faces = np.concatenate([np.stack(one, axis=1) for one in corners])
        rows = np.repeat(np.arange(len(unique)), 2)
        middles = sp.csr_array((np.full(2 * len(unique), 0.5), (rows, unique.ravel())), (len(unique), known))
        matrix = sp.csr_array(sp.vstack([sp.eye_array(known), middles]) @ matrix)
    return matrix, faces.astype(np.int32)
