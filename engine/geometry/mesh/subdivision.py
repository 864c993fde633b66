"""Triangles split into smaller ones of the same surface."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray

from engine.geometry.mesh.adjacency import unique_edges

FOUR_POINT_WEIGHTS = (-1 / 16, 9 / 16, 9 / 16, -1 / 16)
"""Of the curve between the second and the third of four vertices that follow one another (N. Dyn, D. Levin, J. A. Gregory, A 4-point
interpolatory subdivision scheme for curve design, CAGD 1987)."""


def midpoint_subdivision(
    triangles: NDArray[np.integer], count: int, rounds: int = 1, curve: Sequence[int] = ()
) -> tuple[sp.csr_array, NDArray[np.int32]]:
    """Each of the triangles (T, 3) over `count` vertices split in four at the middles of its edges, `rounds` times. Edges between those
    that follow one another in `curve`, all around, are split on a smooth curve through them instead: such a rim has no corners.

    Returns
    -------
    (M, count) the matrix that gives all vertices of those before, by which any attribute is interpolated, the old ones first; and
    (4^rounds * T, 3) the new triangles, of the same orientation.
    """
    faces = np.asarray(triangles, np.int64)
    matrix = sp.csr_array(sp.eye_array(count))
    ring = np.asarray(curve, np.int64)
    for _ in range(rounds):
        known = matrix.shape[0]
        unique, place = unique_edges(np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]]))
        a, b, c = known + place.reshape(3, -1)
        old_a, old_b, old_c = faces.T
        corners = ((old_a, a, c), (a, old_b, b), (c, b, old_c), (a, b, c))
        faces = np.concatenate([np.stack(one, axis=1) for one in corners])
        rows = np.repeat(np.arange(len(unique)), 2)
        middles = sp.lil_array(
            sp.csr_array((np.full(2 * len(unique), 0.5), (rows, unique.ravel())), (len(unique), known))
        )
        around = np.stack([np.roll(ring, 1), ring, np.roll(ring, -1), np.roll(ring, -2)], axis=1)
        split = np.searchsorted(unique @ (known, 1), np.sort(around[:, 1:3], axis=1) @ (known, 1))
        middles[split[:, None], around] = np.array(FOUR_POINT_WEIGHTS)
        ring = np.stack([ring, known + split], axis=1).ravel()
        matrix = sp.csr_array(sp.vstack([sp.eye_array(known), middles.tocsr()]) @ matrix)
    return matrix, faces.astype(np.int32)
