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
    views : (O,) the cameras of the observations, track by track; flat : (O, 2) what they see, on the plane at distance 1,
        without distortion; starts : (T + 1,) where each track begins.
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
    for t in range(len(starts) - 1):
        begin, end = starts[t], starts[t + 1]
        count = end - begin
        eyes, rays = np.zeros((count, 3)), np.zeros((count, 3))
        for o in range(count):
            turn = rotations[views[begin + o]]
            eyes[o] = -turn.T @ translations[views[begin + o]]
            rays[o] = turn[0] * flat[begin + o, 0] + turn[1] * flat[begin + o, 1] + turn[2]
            rays[o] /= np.linalg.norm(rays[o])
        best, tried = 1, 0
        good, chosen = np.zeros(count, np.bool_), np.zeros(count, np.bool_)
        for gap in range(count - 1, 0, -1):  # those far apart in the track first
            for a in range(count - gap):
                if tried == MAX_PROPOSALS or best == count:
                    break
                if np.dot(rays[a], rays[a + gap]) > widest_cosine:
                    continue
                tried += 1
                good[:] = False
                good[a] = good[a + gap] = True
                proposal, sound = _nearest_to_rays(eyes, rays, good)
                if not sound:
                    continue
                seen = _agreeing(rotations, translations, views[begin:end], flat[begin:end], proposal, max_error, good)
                if seen > best:
                    best = seen
                    chosen[:] = good
        if best < 2:
            continue
        refined, sound = _nearest_to_rays(eyes, rays, chosen)
        if not sound:
            continue
        seen = _agreeing(rotations, translations, views[begin:end], flat[begin:end], refined, max_error, good)
        if seen < 2 or not _wide_enough(rays, good, widest_cosine):
            continue
        points[t] = refined
        agreed[begin:end] = good


@njit(nogil=True, error_model="numpy")
def _nearest_to_rays(eyes: np.ndarray, rays: np.ndarray, used: np.ndarray) -> tuple[np.ndarray, bool]:
    """The point with the least sum of squared distances from rays, and whether there is one."""
    system, right = np.zeros((3, 3)), np.zeros(3)
    for o in range(len(eyes)):
        if used[o]:
            across = np.eye(3) - np.outer(rays[o], rays[o])
            system += across
            right += across @ eyes[o]
    if abs(np.linalg.det(system)) < 1e-12:
        return right, False
    return np.linalg.solve(system, right), True


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
        at = rotations[views[o]] @ point + translations[views[o]]
        good[o] = at[2] > 0 and np.hypot(at[0] / at[2] - flat[o, 0], at[1] / at[2] - flat[o, 1]) <= max_error
        count += good[o]
    return count


@njit(nogil=True, error_model="numpy")
def _wide_enough(rays: np.ndarray, used: np.ndarray, widest_cosine: float) -> bool:
    for a in range(len(rays)):
        if used[a]:
            for b in range(a):
                if used[b] and np.dot(rays[a], rays[b]) <= widest_cosine:
                    return True
    return False
