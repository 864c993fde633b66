"""The lips' contours, and parts of a picture that they bound."""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.perception.face.landmarks import eye_distance

UPPER_INNER_LIP = (78, 191, 80, 81, 82, 13, 312, 311, 310, 415, 308)
LOWER_INNER_LIP = (78, 95, 88, 178, 87, 14, 317, 402, 318, 324, 308)
"""Facing vertices of the inner lips from corner to corner."""
MIN_TEETH_OPENING = 0.08
"""Opening of a mouth, its gap over its width, from which its picture may show teeth."""

SEAM_SHARE, MAX_SEAM_EYE_DISTANCES = 0.05, 0.012
"""By how much the outline of an open mouth goes into each lip: share of its gap, and eye distances at most."""
SAMPLES_PER_EDGE = 5
"""Points of the outline for each of the contour's vertices."""


def inner_lip_outline(face: NDArray[np.floating]) -> NDArray[np.float32]:
    """(P, 2) float32 the outline between the lips of a face (478, 2), as round as lips are: a Catmull-Rom spline through the vertices of each, from
    corner to corner. Straight from vertex to vertex a mouth that opens wide is a polygon. Where it gapes it takes in what the picture
    has where its lips meet, which is drawn out along their edges."""
    upper, lower = (_spline(np.asarray(face[list(lip), :2], np.float64)) for lip in (UPPER_INNER_LIP, LOWER_INNER_LIP))
    gap = lower - upper
    wide = np.linalg.norm(gap, axis=1, keepdims=True)
    most = MAX_SEAM_EYE_DISTANCES * float(eye_distance(face))
    further = np.minimum(SEAM_SHARE, most / np.maximum(wide, 1e-6)) * gap
    upper, lower = upper - further, lower + further
    return np.concatenate([upper, lower[-2:0:-1]]).astype(np.float32)


def _spline(points: NDArray[np.float64]) -> NDArray[np.float64]:
    """(S, 2) a Catmull-Rom spline through points (P, 2), whose ends go on as the next ones do. No slope is longer than the shorter edge beside it, so
    that where lips bend sharply it does not swing out.

    Source: E. Catmull, R. Rom, A class of local interpolating splines, 1974.
    """
    count = len(points)
    steps = np.diff(points, axis=0)
    lengths = np.linalg.norm(steps, axis=1)
    slopes = np.concatenate([steps[:1], (steps[:-1] + steps[1:]) / 2, steps[-1:]])
    shorter = np.concatenate([lengths[:1], np.minimum(lengths[:-1], lengths[1:]), lengths[-1:]])
    slopes *= np.minimum(1, shorter / np.maximum(np.linalg.norm(slopes, axis=1), 1e-9))[:, None]
    places = np.linspace(0, count - 1, SAMPLES_PER_EDGE * (count - 1) + 1)
    first = np.minimum(places.astype(int), count - 2)
    t = (places - first)[:, None]
    return np.asarray(
        (2 * t**3 - 3 * t**2 + 1) * points[first]
        + (t**3 - 2 * t**2 + t) * slopes[first]
        + (3 * t**2 - 2 * t**3) * points[first + 1]
        + (t**3 - t**2) * slopes[first + 1]
    )


def box_around(points: NDArray[np.float32], shape: tuple[int, int]) -> tuple[int, int, int, int] | None:
    """x0, y0, x1, y1 around points (P, 2) within a picture of `shape`; None where hardly any of it is left."""
    low, high = np.floor(points.min(axis=0)).astype(int) - 2, np.ceil(points.max(axis=0)).astype(int) + 3
    x0, y0 = np.maximum(low, 0)
    x1, y1 = min(int(high[0]), shape[1]), min(int(high[1]), shape[0])
    return (int(x0), int(y0), x1, y1) if x1 - x0 > 4 and y1 - y0 > 4 else None


def soft_polygon(points: NDArray[np.float32], shape: tuple[int, int]) -> NDArray[np.float32]:
    """Coverage [0, 1] of a polygon, anti-aliased."""
    mask = np.zeros(shape, np.uint8)
    cv2.fillPoly(mask, [np.round(points * 16).astype(np.int32)], 255, cv2.LINE_AA, 4)
    return mask.astype(np.float32) / np.float32(255)
