"""Depth from normals: the surface whose slopes come nearest to those given, held at its border.

Source: C.-Y. Weng et al., Photo Wake-Up, CVPR 2019, equation 4, after R. Basri, D. Jacobs, I. Kemelmacher, Photometric
stereo with general, unknown lighting, IJCV 2007.
"""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray
from scipy.sparse.linalg import splu

MAX_SLOPE = 6.0
"""Slopes (depth over width) beyond this are taken as this: where a surface turns away, its normal says little."""


def integrate_normals(
    normals: NDArray[np.floating], mask: NDArray[np.bool_], held: NDArray[np.bool_], depth: NDArray[np.floating]
) -> NDArray[np.float32]:
    """Depth (H, W) float32 towards the viewer, in pixels, inside `mask` (H, W); NaN elsewhere.

    `normals` (H, W, 3): x right, y down, z to the viewer, of any length. Where `held` (H, W), a part of the mask, the
    depth is that of `depth` (H, W). Each connected part of the mask must hold at least one such pixel.

    Minimises the sum over neighbouring pixels of (difference of depth - mean slope)², one sparse linear system.
    """
    slopes = np.clip(-normals[..., :2] / np.maximum(normals[..., 2:], 1e-3), -MAX_SLOPE, MAX_SLOPE)
    index = np.full(mask.shape, -1, np.int64)
    free = mask & ~held
    index[free] = np.arange(free.sum())
    count = int(free.sum())
    diagonal, right = np.zeros(count), np.zeros(count)
    rows, columns = [], []
    for axis in (1, 0):
        first, second = _neighbours(mask.shape, axis)
        pair = mask[first] & mask[second]
        rise = ((slopes[first] + slopes[second]) / 2)[..., 1 - axis]
        a, b = index[first][pair], index[second][pair]
        for one, other, step, known in (
            (a, b, -rise[pair], depth[second][pair]),
            (b, a, rise[pair], depth[first][pair]),
        ):
            mine = one >= 0
            np.add.at(diagonal, one[mine], 1.0)
            np.add.at(right, one[mine], step[mine])
            fixed = mine & (other < 0)
            np.add.at(right, one[fixed], known[fixed])
            linked = mine & (other >= 0)
            rows.append(one[linked])
            columns.append(other[linked])
    row, column = np.concatenate(rows), np.concatenate(columns)
    matrix = sp.csc_matrix((np.full(len(row), -1.0), (row, column)), (count, count)) + sp.diags(diagonal, format="csc")
    result = np.full(mask.shape, np.nan, np.float32)
    result[held & mask] = depth[held & mask]
    if count:
        solver = splu(matrix, permc_spec="MMD_AT_PLUS_A", options={"SymmetricMode": True}, diag_pivot_thresh=0.0)
        result[free] = solver.solve(right)
    return result


def _neighbours(shape: tuple[int, ...], axis: int) -> tuple[tuple[slice, ...], tuple[slice, ...]]:
    """All pairs of pixels that lie side by side along an axis, as two views."""
    ahead, behind = [slice(None)] * 2, [slice(None)] * 2
    ahead[axis], behind[axis] = slice(None, -1), slice(1, None)
    return tuple(ahead), tuple(behind)
