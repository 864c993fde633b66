"""One step of Gauss and Newton for the lattice of an image's shift: small squares of what is left, and a smooth lattice."""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray
from scipy.sparse.linalg import splu

from engine.avatar.texture.image_shift import ImageShift, lattice_cell
from engine.compiled import njit

STIFFNESS_LEVELS = 4.0
"""Grey levels a pixel: where a picture changes less than that, a node goes with those beside it."""
SHIFT_PRIOR_LEVELS = 0.4
"""Grey levels a pixel, by which a shift is drawn back to none: what nothing tells of does not move."""


def lattice_step(
    shift: ImageShift,
    layers: NDArray[np.uint8],
    places: NDArray[np.float32],
    colours: NDArray[np.float32],
    weights: NDArray[np.float32],
    outlier: float,
) -> NDArray[np.float64]:
    """(rows, columns, 2) what is to be added to the nodes so that a picture shows at places what it should.

    Parameters
    ----------
    layers : (H, W, 4) its colours and, last, a mask, of which only too little counts.
    places : (N, 2) in it, not shifted.
    colours : (N, 4) that are to be there.
    weights : (N,) of the places.
    outlier : grey levels off from which on a place counts less (Cauchy).
    """
    rows, columns = shift.nodes.shape[:2]
    spots = shift.shifted(places)
    blocks, right = _normal_equations(layers, places, spots, colours, weights, (shift.spacing, rows, columns, outlier))
    matrix = _assembled(blocks, rows, columns)
    covered = max(int((blocks[:, 4, 2] > 0).sum()), 1)
    scale = float(weights.sum()) / covered if len(weights) else 1.0
    smooth = scale * (
        STIFFNESS_LEVELS**2 * _differences(rows, columns) + SHIFT_PRIOR_LEVELS**2 * sp.eye_array(rows * columns)
    )
    both = sp.kron(smooth, sp.eye_array(2)).tocsc()
    now = shift.nodes.astype(np.float64).ravel()
    return np.asarray(splu((matrix + both).tocsc()).solve(-right.ravel() - both @ now)).reshape(rows, columns, 2)


def _differences(rows: int, columns: int) -> sp.csr_array:
    """(n, n) of the squares of the differences of nodes side by side."""
    number = np.arange(rows * columns).reshape(rows, columns)
    pairs = np.concatenate(
        [
            np.stack([number[:, :-1].ravel(), number[:, 1:].ravel()], 1),
            np.stack([number[:-1].ravel(), number[1:].ravel()], 1),
        ]
    )
    each = np.arange(len(pairs))
    signs = np.concatenate([np.ones(len(pairs)), -np.ones(len(pairs))])
    edges = sp.csr_array((signs, (np.concatenate([each, each]), pairs.T.ravel())), (len(pairs), number.size))
    return sp.csr_array(edges.T @ edges)


def _assembled(blocks: NDArray[np.float64], rows: int, columns: int) -> sp.csc_array:
    """(2n, 2n) of blocks (n, 9, 3): each node with itself and its eight neighbours; a symmetric block is xx, xy, yy."""
    number = np.arange(rows * columns)
    row, column = number // columns, number % columns
    at, to, values = [], [], []
    for k in range(9):
        to_row, to_column = row + k // 3 - 1, column + k % 3 - 1
        inside = (to_row >= 0) & (to_row < rows) & (to_column >= 0) & (to_column < columns)
        one, other = 2 * number[inside], 2 * (to_row * columns + to_column)[inside]
        for i, j, part in ((0, 0, 0), (0, 1, 1), (1, 0, 1), (1, 1, 2)):
            at.append(one + i)
            to.append(other + j)
            values.append(blocks[inside, k, part])
    size = 2 * rows * columns
    return sp.csc_array((np.concatenate(values), (np.concatenate(at), np.concatenate(to))), (size, size))


@njit(nogil=True, boundscheck=False, error_model="numpy")
def _normal_equations(
    layers: np.ndarray,
    places: np.ndarray,
    spots: np.ndarray,
    colours: np.ndarray,
    weights: np.ndarray,
    lattice: tuple[float, int, int, float],
) -> tuple[np.ndarray, np.ndarray]:
    spacing, rows, columns, outlier = lattice
    height, width = layers.shape[:2]
    blocks = np.zeros((rows * columns, 9, 3))
    right = np.zeros((rows * columns, 2))
    node, share = np.empty(4, np.int64), np.empty(4)
    for n in range(len(places)):
        x, y = spots[n, 0], spots[n, 1]
        if not (x >= 0 and y >= 0 and x <= width - 1 and y <= height - 1):
            continue
        left, top = min(int(x), width - 2), min(int(y), height - 2)
        u, v = x - left, y - top
        xx, xy, yy, rx, ry, away = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
        for c in range(4):
            a, b = float(layers[top, left, c]), float(layers[top, left + 1, c])
            d, e = float(layers[top + 1, left, c]), float(layers[top + 1, left + 1, c])
            gx = (b - a) * (1 - v) + (e - d) * v
            gy = (d - a) * (1 - u) + (e - b) * u
            r = (a * (1 - u) + b * u) * (1 - v) + (d * (1 - u) + e * u) * v - colours[n, c]
            if c == 3:
                r = min(r, 0.0)
            else:
                away += r * r
            if c < 3 or r < 0:
                xx += gx * gx
                xy += gx * gy
                yy += gy * gy
                rx += gx * r
                ry += gy * r
        weight = weights[n] / (1 + away / (outlier * outlier))
        row, column, fx, fy = lattice_cell(places[n, 0], places[n, 1], spacing, rows, columns)
        for k in range(4):
            node[k] = (row + k // 2) * columns + column + k % 2
            share[k] = (fy if k // 2 else 1 - fy) * (fx if k % 2 else 1 - fx)
        for a4 in range(4):
            right[node[a4], 0] += weight * share[a4] * rx
            right[node[a4], 1] += weight * share[a4] * ry
            for b4 in range(4):
                beside = (b4 // 2 - a4 // 2 + 1) * 3 + b4 % 2 - a4 % 2 + 1
                both = weight * share[a4] * share[b4]
                blocks[node[a4], beside, 0] += both * xx
                blocks[node[a4], beside, 1] += both * xy
                blocks[node[a4], beside, 2] += both * yy
    return blocks, right
