"""A limb of two bones that reaches for a place: a leg for the ground, an arm for a knee."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from engine.motion import rotation

Array = NDArray[np.float64]

MAX_REACH_SHARE = 0.9995
"""Of a limb's length: a limb that is quite straight has no plane."""

STRAIGHT_SINE = 0.12
"""The sine of the bend under which the limb's own plane is mixed with its hinge's."""


def two_bones(
    places: tuple[ArrayLike, ArrayLike, ArrayLike],
    rotations: tuple[ArrayLike, ArrayLike],
    target: ArrayLike,
    hinge: ArrayLike,
) -> tuple[Array, Array, Array]:
    """World rotations of the two bones that bring the limb's end to `target`, and where the end then is.

    The law of cosines gives the bend; the bones stay in the plane in which they were bent, carried along with the
    limb's direction, so that knees and elbows keep pointing where they did. A target out of reach is approached.

    Parameters
    ----------
    places : (..., 3) each: hip, knee and ankle, or shoulder, elbow and wrist.
    rotations : (..., 4) each: the world rotations of the upper and the lower bone.
    target : (..., 3) where the end is wanted.
    hinge : (3,) or (..., 3) the axis in the upper bone's coordinates about which the limb bends: for limbs that are
        straight, and so that none bends the wrong way.
    """
    a, b, c = (np.asarray(place, np.float64) for place in places)
    upper, lower = (np.asarray(one, np.float64) for one in rotations)
    first, second = b - a, c - b
    long_first, long_second = _length(first), _length(second)
    wanted = np.asarray(target, np.float64) - a
    distance = np.clip(
        _length(wanted), np.abs(long_first - long_second) + 1e-4, MAX_REACH_SHARE * (long_first + long_second)
    )
    direction = rotation.normalize(wanted)
    normal = _normal(first, second, rotation.rotate(upper, hinge))
    turned = rotation.rotate(rotation.between(c - a, direction), normal)
    turned = rotation.normalize(turned - _dot(turned, direction) * direction)
    along = (distance**2 + long_first**2 - long_second**2) / (2 * distance)
    aside = np.sqrt(np.maximum(long_first**2 - along**2, 0))
    knee = along * direction + aside * np.cross(direction, turned)
    end = distance * direction
    new_upper = rotation.multiply(_turn(first, normal, knee, turned), upper)
    new_lower = rotation.multiply(_turn(second, normal, end - knee, turned), lower)
    return new_upper, new_lower, a + end


def _normal(first: Array, second: Array, hinge: Array) -> Array:
    """The axis about which the limb is bent, perpendicular to the way from its start to its end."""
    cross = np.cross(first, second) / np.maximum(_length(first) * _length(second), 1e-12)
    bend = _dot(cross, rotation.normalize(hinge))
    share = np.clip(bend / STRAIGHT_SINE, 0, 1)
    share = share * share * (3 - 2 * share)
    across = rotation.normalize(first + second)
    straight = rotation.normalize(hinge - _dot(hinge, across) * across)
    return rotation.normalize(share * rotation.normalize(cross) + (1 - share) * straight)


def _turn(old: Array, old_normal: Array, new: Array, new_normal: Array) -> Array:
    """The rotation that brings a bone and the axis beside it to a new bone and axis."""
    return rotation.multiply(_frame(new, new_normal), rotation.inverse(_frame(old, old_normal)))


def _frame(bone: Array, normal: Array) -> Array:
    x = rotation.normalize(bone)
    z = rotation.normalize(normal - _dot(normal, x) * x)
    return rotation.from_matrix(np.stack([x, np.cross(z, x), z], -1))


def _length(vectors: Array) -> Array:
    return np.asarray(np.linalg.norm(vectors, axis=-1, keepdims=True))


def _dot(first: Array, second: Array) -> Array:
    return np.asarray(np.sum(first * second, -1, keepdims=True))
