"""The rotations that come nearest to what points did, for very many sets of points at once.

Source: B. K. P. Horn, Closed-form solution of absolute orientation using unit quaternions, J. Opt. Soc. Am. A 4, 1987: the
rotation is the eigenvector of the greatest eigenvalue of a symmetric matrix of four rows, which Jacobi's rotations
diagonalise (C. G. J. Jacobi, 1846). A proper rotation comes out whatever the points did, mirrored ones included.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from engine.compiled import njit

NO_ROTATION_WEIGHT = 1e-12
"""Towards no rotation at all, as a share of what the points say: decides what points on one line leave open."""
MAX_SWEEPS = 30
"""Most rounds over the matrix's entries: five do for four rows."""


def nearest_rotations(spread: NDArray[np.floating]) -> NDArray[np.float64]:
    """The rotations R (N, 3, 3) for which the sum of |after - R before|^2 is least, where `spread` (N, 3, 3) are the sums of
    before * after'. What the points leave open, as a turn about the line on which they lie, is not turned."""
    found = np.empty((len(spread), 3, 3))
    _rotations(np.ascontiguousarray(spread, np.float64), found)
    return found


@njit(nogil=True, boundscheck=False)
def _rotations(spread, found):  # type: ignore[no-untyped-def]
    matrix, vectors = np.empty((4, 4)), np.empty((4, 4))
    for n in range(len(spread)):
        s = spread[n]
        square = 0.0
        for i in range(3):
            for j in range(3):
                square += s[i, j] * s[i, j]
        size = np.sqrt(square)
        scale = 1.0 / size if size > 0 else 1.0
        xx = s[0, 0] * scale + NO_ROTATION_WEIGHT
        yy = s[1, 1] * scale + NO_ROTATION_WEIGHT
        zz = s[2, 2] * scale + NO_ROTATION_WEIGHT
        xy, xz, yx = s[0, 1] * scale, s[0, 2] * scale, s[1, 0] * scale
        yz, zx, zy = s[1, 2] * scale, s[2, 0] * scale, s[2, 1] * scale
        matrix[0, 0], matrix[0, 1], matrix[0, 2], matrix[0, 3] = xx + yy + zz, yz - zy, zx - xz, xy - yx
        matrix[1, 1], matrix[1, 2], matrix[1, 3] = xx - yy - zz, xy + yx, zx + xz
        matrix[2, 2], matrix[2, 3], matrix[3, 3] = yy - xx - zz, yz + zy, zz - xx - yy
        for i in range(4):
            for j in range(i):
                matrix[i, j] = matrix[j, i]
        _diagonalise(matrix, vectors)
        best = 0
        for k in range(1, 4):
            if matrix[k, k] > matrix[best, best]:
                best = k
        w, x, y, z = vectors[0, best], vectors[1, best], vectors[2, best], vectors[3, best]
        r = found[n]
        r[0, 0], r[0, 1], r[0, 2] = 1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)
        r[1, 0], r[1, 1], r[1, 2] = 2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)
        r[2, 0], r[2, 1], r[2, 2] = 2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)


@njit(nogil=True, boundscheck=False)
def _diagonalise(matrix, vectors):  # type: ignore[no-untyped-def]
    """Eigenvalues on the diagonal of a symmetric matrix (4, 4), its eigenvectors as columns."""
    for i in range(4):
        for j in range(4):
            vectors[i, j] = 1.0 if i == j else 0.0
    for _ in range(MAX_SWEEPS):
        off = 0.0
        for p in range(3):
            for q in range(p + 1, 4):
                off += abs(matrix[p, q])
        if off < 1e-15:
            return
        for p in range(3):
            for q in range(p + 1, 4):
                if abs(matrix[p, q]) < 1e-300:
                    continue
                slope = (matrix[q, q] - matrix[p, p]) / (2 * matrix[p, q])
                tangent = 1 / (abs(slope) + np.sqrt(slope * slope + 1))
                if slope < 0:
                    tangent = -tangent
                cosine = 1 / np.sqrt(tangent * tangent + 1)
                sine = tangent * cosine
                for k in range(4):
                    a, b = matrix[k, p], matrix[k, q]
                    matrix[k, p], matrix[k, q] = cosine * a - sine * b, sine * a + cosine * b
                for k in range(4):
                    a, b = matrix[p, k], matrix[q, k]
                    matrix[p, k], matrix[q, k] = cosine * a - sine * b, sine * a + cosine * b
                for k in range(4):
                    a, b = vectors[k, p], vectors[k, q]
                    vectors[k, p], vectors[k, q] = cosine * a - sine * b, sine * a + cosine * b
