"""Rotations as unit quaternions (x, y, z, w), any number at once.

Every function takes and gives float64 arrays whose last axis is the quaternion or vector; leading axes broadcast.
Formulas: Dam, Koch and Lillholm, "Quaternions, interpolation and animation" (1998).
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]

IDENTITY_QUATERNION: tuple[float, float, float, float] = (0.0, 0.0, 0.0, 1.0)
AXIS_VECTORS = {"x": (1.0, 0.0, 0.0), "y": (0.0, 1.0, 0.0), "z": (0.0, 0.0, 1.0)}


def identity(*shape: int) -> Array:
    """(*shape, 4): no rotation."""
    return np.broadcast_to(np.array(IDENTITY_QUATERNION), (*shape, 4)).copy()


def normalize(vectors: ArrayLike) -> Array:
    """Vectors or quaternions of length one; those of no length stay zero."""
    v = np.asarray(vectors, np.float64)
    length = np.linalg.norm(v, axis=-1, keepdims=True)
    return v / np.where(length > 1e-12, length, 1.0)


def multiply(first: ArrayLike, second: ArrayLike) -> Array:
    """The rotation `first` after the rotation `second`, as with matrices."""
    a, b = np.asarray(first, np.float64), np.asarray(second, np.float64)
    ax, ay, az, aw = np.moveaxis(a, -1, 0)
    bx, by, bz, bw = np.moveaxis(b, -1, 0)
    return np.stack(
        [
            aw * bx + ax * bw + ay * bz - az * by,
            aw * by - ax * bz + ay * bw + az * bx,
            aw * bz + ax * by - ay * bx + az * bw,
            aw * bw - ax * bx - ay * by - az * bz,
        ],
        -1,
    )


def chain(*rotations: ArrayLike) -> Array:
    """The product of rotations, the last applied first."""
    product = np.asarray(rotations[0], np.float64)
    for turn in rotations[1:]:
        product = multiply(product, turn)
    return product


def inverse(rotations: ArrayLike) -> Array:
    """The opposite rotations."""
    return np.asarray(rotations, np.float64) * np.array([-1.0, -1.0, -1.0, 1.0])


def rotate(rotations: ArrayLike, vectors: ArrayLike) -> Array:
    """Vectors (..., 3), turned."""
    q, v = np.asarray(rotations, np.float64), np.asarray(vectors, np.float64)
    x, y, z, w = np.moveaxis(q, -1, 0)
    vx, vy, vz = np.moveaxis(v, -1, 0)
    # Twice the cross product of axis and vector. (`np.cross` takes three times as long for as few as a skeleton has.)
    tx, ty, tz = 2 * (y * vz - z * vy), 2 * (z * vx - x * vz), 2 * (x * vy - y * vx)
    return np.stack(
        [vx + w * tx + (y * tz - z * ty), vy + w * ty + (z * tx - x * tz), vz + w * tz + (x * ty - y * tx)], -1
    )


def about(axis: str | ArrayLike, radians: ArrayLike) -> Array:
    """Rotations by `radians` (...) about an axis: "x", "y", "z" or vectors (..., 3)."""
    direction = normalize(AXIS_VECTORS[axis] if isinstance(axis, str) else axis)
    half = np.asarray(radians, np.float64)[..., None] / 2
    return np.concatenate(np.broadcast_arrays(direction * np.sin(half), np.cos(half)), -1)[..., [0, 1, 2, -1]]


def from_vector(vectors: ArrayLike) -> Array:
    """Rotations from rotation vectors (..., 3): axis times radians."""
    v = np.asarray(vectors, np.float64)
    angle = np.linalg.norm(v, axis=-1, keepdims=True)
    return np.concatenate([v * 0.5 * np.sinc(angle / (2 * np.pi)), np.cos(angle / 2)], -1)


def to_vector(rotations: ArrayLike) -> Array:
    """Rotation vectors (..., 3), of length at most pi."""
    q = np.asarray(rotations, np.float64)
    q = np.where(q[..., 3:] < 0, -q, q)
    sine = np.linalg.norm(q[..., :3], axis=-1, keepdims=True)
    angle = 2 * np.arctan2(sine, q[..., 3:])
    return q[..., :3] * np.where(sine > 1e-9, angle / np.where(sine > 1e-9, sine, 1), 2.0)


def angle(rotations: ArrayLike) -> Array:
    """How far each turns, radians in [0, pi]."""
    q = np.asarray(rotations, np.float64)
    return np.asarray(2 * np.arctan2(np.linalg.norm(q[..., :3], axis=-1), np.abs(q[..., 3])))


def from_matrix(matrices: ArrayLike) -> Array:
    """Rotations from rotation matrices (..., 3, 3), by Shepperd's method: the largest component first."""
    m = np.asarray(matrices, np.float64)
    xx, yy, zz = m[..., 0, 0], m[..., 1, 1], m[..., 2, 2]
    a, b, c = (m[..., 2, 1], m[..., 1, 2]), (m[..., 0, 2], m[..., 2, 0]), (m[..., 1, 0], m[..., 0, 1])
    xy, xz, yz = m[..., 0, 1] + m[..., 1, 0], m[..., 0, 2] + m[..., 2, 0], m[..., 1, 2] + m[..., 2, 1]
    candidates = np.stack(
        [
            np.stack([1 + xx - yy - zz, xy, xz, a[0] - a[1]], -1),
            np.stack([xy, 1 - xx + yy - zz, yz, b[0] - b[1]], -1),
            np.stack([xz, yz, 1 - xx - yy + zz, c[0] - c[1]], -1),
            np.stack([a[0] - a[1], b[0] - b[1], c[0] - c[1], 1 + xx + yy + zz], -1),
        ],
        -2,
    )
    largest = np.argmax(np.stack([xx - yy - zz, yy - xx - zz, zz - xx - yy, xx + yy + zz], -1), -1)
    return normalize(np.take_along_axis(candidates, largest[..., None, None], -2)[..., 0, :])


def to_matrix(rotations: ArrayLike) -> Array:
    """Rotation matrices (..., 3, 3)."""
    q = np.asarray(rotations, np.float64)
    return np.stack([rotate(q, axis) for axis in AXIS_VECTORS.values()], -1)


def between(start: ArrayLike, end: ArrayLike) -> Array:
    """The shortest rotations that bring directions `start` (..., 3) to `end`; half turns choose some axis across."""
    a, b = np.broadcast_arrays(normalize(start), normalize(end))
    dot = np.sum(a * b, -1, keepdims=True)
    turn = np.concatenate([np.cross(a, b), 1 + dot], -1)
    smallest = np.eye(3)[np.argmin(np.abs(a), -1)]
    half_turn = np.concatenate([normalize(np.cross(a, smallest)), np.zeros_like(dot)], -1)
    return normalize(np.where(dot < -1 + 1e-9, half_turn, turn))


def slerp(start: ArrayLike, end: ArrayLike, share: ArrayLike) -> Array:
    """From `start` to `end` the shorter way; `share` (...) is 0 at the start and 1 at the end."""
    a = np.asarray(start, np.float64)
    turn = multiply(inverse(a), end)
    return normalize(multiply(a, from_vector(to_vector(turn) * np.asarray(share, np.float64)[..., None])))


def mean(rotations: ArrayLike, axis: int = 0) -> Array:
    """The rotation nearest to all: Markley et al., "Averaging quaternions" (2007), equations 12 and 13."""
    q = np.moveaxis(np.asarray(rotations, np.float64), axis, -2)
    return np.asarray(np.linalg.eigh(np.swapaxes(q, -1, -2) @ q)[1][..., -1])


def same_signs(rotations: ArrayLike) -> Array:
    """Rotations over time (F, ..., 4), each with the sign nearer to the one before: fit for interpolation."""
    q = np.asarray(rotations, np.float64)
    flips = np.where(np.sum(q[1:] * q[:-1], -1, keepdims=True) < 0, -1.0, 1.0)
    return np.concatenate([q[:1], q[1:] * np.cumprod(flips, 0)])


def mirrored(rotations: ArrayLike) -> Array:
    """Rotations seen in a mirror across the plane x = 0: a left limb's become the right one's."""
    return np.asarray(rotations, np.float64) * np.array([1.0, -1.0, -1.0, 1.0])
