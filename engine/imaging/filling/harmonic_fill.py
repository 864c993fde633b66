"""Holes in maps filled smoothly: what is missing is harmonic, the mean of its neighbours.

One sparse factorisation serves all maps that have the same holes.
"""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_matrix, csr_matrix, diags
from scipy.sparse.linalg import SuperLU, splu

NEIGHBOURS_4 = ((0, 1), (0, -1), (1, 0), (-1, 0))
"""Rows and columns from a pixel to those that share a side with it."""


@dataclass(frozen=True)
class HarmonicFill:
    """Holes of maps (H, W), and what is needed to fill them.

    hole, edge : the flat indices of the N pixels that are filled and of the M known ones beside them.
    from_edge : (N, M).
    solver : of the discrete Laplace equation.
    """

    hole: NDArray[np.intp]
    edge: NDArray[np.intp]
    from_edge: csr_matrix
    solver: SuperLU | None

    def __call__(self, values: NDArray[np.float32]) -> NDArray[np.float32]:
        """`values` (H, W, C) with the holes filled; each value lies between those around its hole."""
        out = values.copy()
        if self.solver is None:
            return out
        flat = out.reshape(-1, values.shape[-1])
        known = flat[self.edge]
        told = np.flatnonzero(known.any(0))
        flat[np.ix_(self.hole, told)] = self.solver.solve(self.from_edge @ known[:, told].astype(np.float64))
        return out


def harmonic_fill(known: NDArray[np.bool_], wanted: NDArray[np.bool_]) -> HarmonicFill:
    """Prepare to fill the pixels of `wanted` (H, W) that are not `known` (H, W).

    The equation is solved on those and on what lies between them and the nearest known pixels, with free borders beyond.
    Every wanted pixel can be reached if one is known.
    """
    away = np.asarray(cv2.distanceTransform((~known).astype(np.uint8), cv2.DIST_L2, 5))
    missing = wanted & ~known
    nothing = np.zeros(0, np.intp)
    if not missing.any() or not known.any():
        return HarmonicFill(nothing, nothing, csr_matrix((0, 0)), None)
    reach = int(np.ceil(away[missing].max())) + 1
    disk = cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (2 * reach + 1, 2 * reach + 1))
    domain = (cv2.dilate(missing.astype(np.uint8), disk) > 0) & ~known & (away <= reach)
    domain = _held(domain, known)
    height, width = known.shape
    number = np.full(known.shape, -1, np.intp)
    number[domain] = np.arange(int(domain.sum()))
    rim = ~domain & known & (cv2.dilate(domain.astype(np.uint8), np.ones((3, 3), np.uint8)) > 0)
    column = np.full(known.shape, -1, np.intp)
    column[rim] = np.arange(int(rim.sum()))
    ys, xs = np.nonzero(domain)
    inner, outer = [], []
    for dy, dx in NEIGHBOURS_4:
        y, x = ys + dy, xs + dx
        inside = (y >= 0) & (y < height) & (x >= 0) & (x < width)
        y, x, here = y[inside], x[inside], np.flatnonzero(inside)
        inner.append(np.stack([here, number[y, x]], 1)[number[y, x] >= 0])
        outer.append(np.stack([here, column[y, x]], 1)[column[y, x] >= 0])
    links, ends = np.concatenate(inner), np.concatenate(outer)
    count = len(ys)
    degree = np.bincount(links[:, 0], minlength=count) + np.bincount(ends[:, 0], minlength=count)
    between = coo_matrix((np.ones(len(links)), (links[:, 0], links[:, 1])), (count, count))
    from_edge = csr_matrix((np.ones(len(ends)), (ends[:, 0], ends[:, 1])), (count, int(rim.sum())))
    solver = splu((diags(degree.astype(np.float64)) - between).tocsc(), permc_spec="MMD_AT_PLUS_A")
    return HarmonicFill(np.flatnonzero(domain), np.flatnonzero(rim), from_edge, solver)


def _held(domain: NDArray[np.bool_], known: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """The pieces of the domain that touch what is known: nothing says what the others are."""
    _, pieces = cv2.connectedComponents(domain.astype(np.uint8), connectivity=4)
    beside = cv2.dilate(known.astype(np.uint8), cv2.getStructuringElement(cv2.MORPH_CROSS, (3, 3))) > 0
    return domain & np.isin(pieces, np.unique(pieces[domain & beside]))
