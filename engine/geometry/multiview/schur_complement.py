"""The normal equations of a bundle with its points eliminated: the loops behind `engine.geometry.multiview.bundle_adjustment`.

With e = (camera's six, lens's three) and p a point's three parameters, an observation has the Jacobian (E, P) and a weight
by the robust loss. A point's share of the reduced system is sum E'E - (sum E'P) (sum P'P)^-1 (sum P'E): sums over its
observations alone.

Source: Triggs et al., Bundle Adjustment - A Modern Synthesis, 2000, section 6.1.
"""

from __future__ import annotations

import numpy as np

from engine.compiled import njit
from engine.geometry.multiview.bundle import MIN_POINT_DEPTH

CAMERA_COLUMNS, POINT_COLUMN_END = 9, 12
"""Columns of an observation's Jacobian: turn (3), shift (3), focal length, k1 and k2; then those of the point (3)."""


@njit(nogil=True, error_model="numpy")
def linearise(
    turn: np.ndarray,
    shift: np.ndarray,
    lens: np.ndarray,
    point: np.ndarray,
    offset: np.ndarray,
    jacobian: np.ndarray,
    residual: np.ndarray,
) -> bool:
    """Fill the residual (2,), what was seen less what would be, and the Jacobian (2, 12) of what would be; False behind the
    camera. Turns are small ones from the left: R becomes exp(w) R, t becomes exp(w) t + s."""
    x = turn[0, 0] * point[0] + turn[0, 1] * point[1] + turn[0, 2] * point[2] + shift[0]
    y = turn[1, 0] * point[0] + turn[1, 1] * point[1] + turn[1, 2] * point[2] + shift[1]
    z = turn[2, 0] * point[0] + turn[2, 1] * point[1] + turn[2, 2] * point[2] + shift[2]
    if z <= MIN_POINT_DEPTH:
        return False
    u, v = x / z, y / z
    focal, k1, k2 = lens
    square = u * u + v * v
    radial = 1 + square * (k1 + square * k2)
    slope = 2 * (k1 + 2 * square * k2)
    residual[0] = offset[0] - focal * radial * u
    residual[1] = offset[1] - focal * radial * v
    uu, uv, vv = focal * (radial + u * u * slope), focal * u * v * slope, focal * (radial + v * v * slope)
    for row in range(2):
        by_u, by_v = (uu, uv) if row == 0 else (uv, vv)
        by_x, by_y = by_u / z, by_v / z
        by_z = -(by_u * u + by_v * v) / z
        jacobian[row, 0] = by_z * y - by_y * z
        jacobian[row, 1] = by_x * z - by_z * x
        jacobian[row, 2] = by_y * x - by_x * y
        jacobian[row, 3], jacobian[row, 4], jacobian[row, 5] = by_x, by_y, by_z
        at = u if row == 0 else v
        jacobian[row, 6] = radial * at
        jacobian[row, 7] = focal * square * at
        jacobian[row, 8] = focal * square * square * at
        for k in range(3):
            jacobian[row, CAMERA_COLUMNS + k] = by_x * turn[0, k] + by_y * turn[1, k] + by_z * turn[2, k]
    return True


@njit(nogil=True, error_model="numpy")
def invert_symmetric(block: np.ndarray, inverse: np.ndarray) -> None:
    """Fill the inverse of a symmetric (3, 3), by its cofactors."""
    xx, xy, xz = block[0, 0], block[0, 1], block[0, 2]
    yy, yz, zz = block[1, 1], block[1, 2], block[2, 2]
    a, b, c = yy * zz - yz * yz, xz * yz - xy * zz, xy * yz - xz * yy
    determinant = xx * a + xy * b + xz * c
    inverse[0, 0], inverse[1, 1], inverse[2, 2] = a, xx * zz - xz * xz, xx * yy - xy * xy
    inverse[0, 1] = inverse[1, 0] = b
    inverse[0, 2] = inverse[2, 0] = c
    inverse[1, 2] = inverse[2, 1] = xy * xz - xx * yz
    for row in range(3):
        for column in range(3):
            inverse[row, column] /= determinant


@njit(nogil=True, error_model="numpy")
def eliminate_points(geometry: tuple, layout: tuple, loss_scale: float, damping: float, found: tuple) -> None:
    """Fill the reduced system, its right side, the diagonal that it has before elimination, and each point's inverse
    (3, 3) and gradient (3,). `layout`: observations sorted by point, where each point's begin, the first column of a free
    camera by six (-1 where it is fixed), and the first column of the lenses."""
    rotations, translations, lenses, lens_of, points = geometry
    cameras, indices, offsets, starts, slots, first_lens = layout
    system, right, own, inverses, gradients = found
    most = 0
    for p in range(len(starts) - 1):
        most = max(most, starts[p + 1] - starts[p])
    jacobian, residual = np.zeros((2, POINT_COLUMN_END)), np.zeros(2)
    cross = np.zeros((6 * most + 3 * len(lenses), 3))  # of a point: sum E'P, rows of its cameras, then of the lenses
    columns = np.zeros(6 * most + 3 * len(lenses), np.int64)
    spread, block = np.zeros_like(cross), np.zeros((3, 3))
    for p in range(len(starts) - 1):
        begin, end = starts[p], starts[p + 1]
        block[:] = 0
        gradient = gradients[p]
        gradient[:] = 0
        rows = 3 * len(lenses)
        cross[:rows] = 0
        for k in range(rows):
            columns[k] = first_lens + k
        for o in range(begin, end):
            c = cameras[o]
            lens = lens_of[c]
            at = points[indices[o]]
            if not linearise(rotations[c], translations[c], lenses[lens], at, offsets[o], jacobian, residual):
                continue
            weight = 1 / (1 + (residual[0] ** 2 + residual[1] ** 2) / loss_scale**2)
            slot = slots[c]
            for a in range(CAMERA_COLUMNS, POINT_COLUMN_END):
                gradient[a - CAMERA_COLUMNS] += weight * (jacobian[0, a] * residual[0] + jacobian[1, a] * residual[1])
                for b in range(CAMERA_COLUMNS, POINT_COLUMN_END):
                    block[a - CAMERA_COLUMNS, b - CAMERA_COLUMNS] += weight * (
                        jacobian[0, a] * jacobian[0, b] + jacobian[1, a] * jacobian[1, b]
                    )
            for a in range(CAMERA_COLUMNS):
                if a < 6 and slot < 0:
                    continue
                column = 6 * slot + a if a < 6 else first_lens + 3 * lens + a - 6
                row = rows + a if a < 6 else 3 * lens + a - 6
                if a < 6:
                    columns[row] = column
                    cross[row] = 0
                right[column] += weight * (jacobian[0, a] * residual[0] + jacobian[1, a] * residual[1])
                for k in range(3):
                    cross[row, k] += weight * (
                        jacobian[0, a] * jacobian[0, CAMERA_COLUMNS + k]
                        + jacobian[1, a] * jacobian[1, CAMERA_COLUMNS + k]
                    )
                for b in range(CAMERA_COLUMNS):
                    if b < 6 and slot < 0:
                        continue
                    other = 6 * slot + b if b < 6 else first_lens + 3 * lens + b - 6
                    value = weight * (jacobian[0, a] * jacobian[0, b] + jacobian[1, a] * jacobian[1, b])
                    system[column, other] += value
                    if a == b:
                        own[column] += value
            if slot >= 0:
                rows += 6
        for k in range(3):
            block[k, k] += damping * max(block[k, k], 1e-12) + 1e-300
        inverse = inverses[p]
        invert_symmetric(block, inverse)
        for a in range(rows):
            for k in range(3):
                spread[a, k] = cross[a, 0] * inverse[0, k] + cross[a, 1] * inverse[1, k] + cross[a, 2] * inverse[2, k]
            right[columns[a]] -= spread[a, 0] * gradient[0] + spread[a, 1] * gradient[1] + spread[a, 2] * gradient[2]
        for a in range(rows):
            for b in range(rows):
                system[columns[a], columns[b]] -= (
                    spread[a, 0] * cross[b, 0] + spread[a, 1] * cross[b, 1] + spread[a, 2] * cross[b, 2]
                )


@njit(nogil=True, error_model="numpy")
def back_substitute(geometry: tuple, layout: tuple, loss_scale: float, solved: tuple, shifts: np.ndarray) -> None:
    """Fill the points' shifts (P, 3), given the change of cameras and lenses and what `eliminate_points` kept of points."""
    rotations, translations, lenses, lens_of, points = geometry
    cameras, indices, offsets, starts, slots, first_lens = layout
    change, inverses, gradients = solved
    jacobian, residual, rest = np.zeros((2, POINT_COLUMN_END)), np.zeros(2), np.zeros(3)
    for p in range(len(starts) - 1):
        for k in range(3):
            rest[k] = gradients[p, k]
        for o in range(starts[p], starts[p + 1]):
            c = cameras[o]
            lens = lens_of[c]
            at = points[indices[o]]
            if not linearise(rotations[c], translations[c], lenses[lens], at, offsets[o], jacobian, residual):
                continue
            weight = 1 / (1 + (residual[0] ** 2 + residual[1] ** 2) / loss_scale**2)
            for row in range(2):
                along = 0.0
                for a in range(6):
                    if slots[c] >= 0:
                        along += jacobian[row, a] * change[6 * slots[c] + a]
                for a in range(6, CAMERA_COLUMNS):
                    along += jacobian[row, a] * change[first_lens + 3 * lens + a - 6]
                for k in range(3):
                    rest[k] -= weight * jacobian[row, CAMERA_COLUMNS + k] * along
        for k in range(3):
            shifts[p, k] = inverses[p, k, 0] * rest[0] + inverses[p, k, 1] * rest[1] + inverses[p, k, 2] * rest[2]
