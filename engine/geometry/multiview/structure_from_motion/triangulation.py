"""Points of space out of tracks, some of whose observations are wrong.

Each two views of a track that see it under enough of an angle propose a point, midway where their rays pass each other; what
most views agree with is taken and refined over all of these. (R. Hartley, A. Zisserman, Multiple View Geometry, 2004,
section 12.2; Schoenberger and Frahm 2016, section 4.2.)
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from engine.compiled import njit

MAX_PROPOSALS = 40
"""Pairs of views of one track that are tried."""


@dataclass(frozen=True)
class Triangulation:
    """`points` (T, 3), NaN where none is agreed on; `agreed` (O,) bool: the observations that do."""

    points: NDArray[np.float64]
    agreed: NDArray[np.bool_]


def triangulate(
    poses: tuple[NDArray[np.float64], NDArray[np.float64]],
    views: NDArray[np.intp],
    flat: NDArray[np.float64],
    starts: NDArray[np.intp],
    max_error: float,
    least_angle: float,
) -> Triangulation:
    """One point for each track.

    Parameters
    ----------
    poses : rotations (C, 3, 3) and translations (C, 3) of the cameras.
    views : (O,) the cameras of the observations, track by track.
    flat : (O, 2) what they see, on the plane at distance 1, without distortion.
    starts : (T + 1,) where each track begins.
    max_error : how far an observation may be off on that plane.
    least_angle : radians that two of the rays which agree must have between them.
    """
    points, agreed = np.full((len(starts) - 1, 3), np.nan), np.zeros(len(views), np.bool_)
    _triangulate(*poses, views, np.ascontiguousarray(flat), starts, (max_error, np.cos(least_angle)), points, agreed)
    return Triangulation(points, agreed)


@njit(nogil=True, error_model="numpy")
def _triangulate(
    rotations: np.ndarray,
    translations: np.ndarray,
    views: np.ndarray,
    flat: np.ndarray,
    starts: np.ndarray,
    bounds: tuple[float, float],
    points: np.ndarray,
    agreed: np.ndarray,
) -> None:
    max_error, widest_cosine = bounds
    point = np.zeros(3)
    for t in range(len(starts) - 1):
        begin, end = starts[t], starts[t + 1]
        count = end - begin
        eyes, rays = np.zeros((count, 3)), np.zeros((count, 3))
        for o in range(count):
            turn, shift = rotations[views[begin + o]], translations[views[begin + o]]
            square = 0.0
            for k in range(3):
                eyes[o, k] = -(turn[0, k] * shift[0] + turn[1, k] * shift[1] + turn[2, k] * shift[2])
                rays[o, k] = turn[0, k] * flat[begin + o, 0] + turn[1, k] * flat[begin + o, 1] + turn[2, k]
                square += rays[o, k] * rays[o, k]
            for k in range(3):
                rays[o, k] /= np.sqrt(square)
        best, tried = 1, 0
        good, chosen = np.zeros(count, np.bool_), np.zeros(count, np.bool_)
        for gap in range(count - 1, 0, -1):  # those far apart in the track first
            for a in range(count - gap):
                if tried == MAX_PROPOSALS or best == count:
                    break
                if _dot(rays, a, a + gap) > widest_cosine:
                    continue
                tried += 1
                good[:] = False
                good[a] = good[a + gap] = True
                if not _nearest_to_rays(eyes, rays, good, point):
                    continue
                seen = _agreeing(rotations, translations, views[begin:end], flat[begin:end], point, max_error, good)
                if seen > best:
                    best = seen
                    for o in range(count):
                        chosen[o] = good[o]
        if best < 2:
            continue
        if not _nearest_to_rays(eyes, rays, chosen, point):
            continue
        seen = _agreeing(rotations, translations, views[begin:end], flat[begin:end], point, max_error, good)
        if seen < 2 or not _wide_enough(rays, good, widest_cosine):
            continue
        for k in range(3):
            points[t, k] = point[k]
        for o in range(count):
            agreed[begin + o] = good[o]


@njit(nogil=True, error_model="numpy")
def _dot(rays: np.ndarray, a: int, b: int) -> float:
    return rays[a, 0] * rays[b, 0] + rays[a, 1] * rays[b, 1] + rays[a, 2] * rays[b, 2]


@njit(nogil=True, error_model="numpy")
def _nearest_to_rays(eyes: np.ndarray, rays: np.ndarray, used: np.ndarray, point: np.ndarray) -> bool:
    """Write the point (3,) with the least sum of squared distances from rays; whether there is one. By Cramer's rule."""
    xx = xy = xz = yy = yz = zz = right_x = right_y = right_z = 0.0
    for o in range(len(eyes)):
        if used[o]:
            x, y, z = rays[o, 0], rays[o, 1], rays[o, 2]
            along = x * eyes[o, 0] + y * eyes[o, 1] + z * eyes[o, 2]
            xx, yy, zz = xx + 1 - x * x, yy + 1 - y * y, zz + 1 - z * z
            xy, xz, yz = xy - x * y, xz - x * z, yz - y * z
            right_x += eyes[o, 0] - along * x
            right_y += eyes[o, 1] - along * y
            right_z += eyes[o, 2] - along * z
    a, b, c = yy * zz - yz * yz, xz * yz - xy * zz, xy * yz - xz * yy
    determinant = xx * a + xy * b + xz * c
    if abs(determinant) < 1e-12:
        return False
    d, e, f = xx * zz - xz * xz, xy * xz - xx * yz, xx * yy - xy * xy
    point[0] = (a * right_x + b * right_y + c * right_z) / determinant
    point[1] = (b * right_x + d * right_y + e * right_z) / determinant
    point[2] = (c * right_x + e * right_y + f * right_z) / determinant
    return True


@njit(nogil=True, error_model="numpy")
def _agreeing(
    rotations: np.ndarray,
    translations: np.ndarray,
    views: np.ndarray,
    flat: np.ndarray,
    point: np.ndarray,
    max_error: float,
    good: np.ndarray,
) -> int:
    """Mark the views that see a point near enough to where they should; how many."""
    count = 0
    for o in range(len(views)):
        turn, shift = rotations[views[o]], translations[views[o]]
        x = turn[0, 0] * point[0] + turn[0, 1] * point[1] + turn[0, 2] * point[2] + shift[0]
        y = turn[1, 0] * point[0] + turn[1, 1] * point[1] + turn[1, 2] * point[2] + shift[1]
        z = turn[2, 0] * point[0] + turn[2, 1] * point[1] + turn[2, 2] * point[2] + shift[2]
        good[o] = z > 0 and np.hypot(x / z - flat[o, 0], y / z - flat[o, 1]) <= max_error
        count += good[o]
    return count


@njit(nogil=True, error_model="numpy")
def _wide_enough(rays: np.ndarray, used: np.ndarray, widest_cosine: float) -> bool:
    for a in range(len(rays)):
        if used[a]:
            for b in range(a):
                if used[b] and _dot(rays, a, b) <= widest_cosine:
                    return True
    return False
