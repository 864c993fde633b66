"""Which features of two pictures are the same: alike, unlike all others, and in accord with one motion of the camera.

Sources: Lowe 2004, section 7.1 (the ratio of distances); D. Barath, J. Noskova, M. Ivashechkin, J. Matas, MAGSAC++, CVPR 2020,
within OpenCV (the fundamental matrix among wrong matches: the lens need not be known for it).
"""

from __future__ import annotations

from collections.abc import Sequence

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.compiled import njit
from engine.imaging.features import Features

MAX_DESCRIPTOR_DISTANCE_RATIO = 0.8
"""Of the distances to the nearest and to the second nearest descriptor (Lowe's value)."""
MAX_EPIPOLAR_ERROR_PIXELS = 4.0
"""Pixels from the epipolar line, of pictures 1000 pixels long: people who are to hold still sway by as much."""
MIN_MATCHES = 15
"""In accord with one motion; fewer come by chance."""
MIN_AGREEING_MATCH_SHARE = 0.25
"""Share of the matches that must be in accord."""
MANY_MATCHES = 400
"""How many matches tie two pictures. Where there are fewer, more are looked for along epipolar lines."""
MIN_DESCRIPTOR_COSINE = 0.8
"""Cosine between descriptors that are looked for along epipolar lines."""
OVERLAP_FEATURES = 300
"""The largest features of each picture, by which it is seen which pictures show the same."""


def match_features(a: Features, b: Features, max_ratio: float = MAX_DESCRIPTOR_DISTANCE_RATIO) -> NDArray[np.intp]:
    """(M, 2) indices of features that are each other's nearest, and nearer than `max_ratio` of the second nearest."""
    if len(a) < 2 or len(b) < 2:
        return np.zeros((0, 2), np.intp)
    likeness = a.descriptors @ b.descriptors.T
    return np.asarray(_mutual(likeness, max_ratio), np.intp)


def guided_matches(
    a: Features,
    b: Features,
    fundamental: NDArray[np.float64],
    max_error: float,
    max_ratio: float = MAX_DESCRIPTOR_DISTANCE_RATIO,
) -> NDArray[np.intp]:
    """As `match_features`, where only what lies within `max_error` pixels of a feature's epipolar line is compared with it:
    what looks like others elsewhere in the picture is found as well.

    Parameters
    ----------
    fundamental : (3, 3), from pixels of the first picture to lines of the second.
    """
    return _guided(a.descriptors @ b.descriptors.T, a, b, fundamental, max_error, max_ratio)


def _guided(
    likeness: NDArray[np.float32],
    a: Features,
    b: Features,
    fundamental: NDArray[np.float64],
    max_error: float,
    max_ratio: float,
) -> NDArray[np.intp]:
    """`guided_matches` by the descriptors' `likeness` (A, B), which is overwritten."""
    lines = np.concatenate([a.pixels, np.ones((len(a), 1))], axis=1) @ fundamental.T
    lines /= np.maximum(np.linalg.norm(lines[:, :2], axis=1, keepdims=True), 1e-12)
    x, y = np.ascontiguousarray(b.pixels.T)
    _keep_near(likeness, lines.astype(np.float32), x, y, np.float32(max_error))
    matches = np.asarray(_mutual(likeness, max_ratio), np.intp)
    return matches[likeness[matches[:, 0], matches[:, 1]] >= MIN_DESCRIPTOR_COSINE]


def verified_matches(
    a: Features, b: Features, length: float, max_ratio: float = MAX_DESCRIPTOR_DISTANCE_RATIO
) -> NDArray[np.intp]:
    """As `match_features`, those alone that one motion of a camera in a still scene explains; none where these are too few.

    Parameters
    ----------
    length : the pictures' longer side, pixels.
    """
    none = np.zeros((0, 2), np.intp)
    if len(a) < 2 or len(b) < 2:
        return none
    likeness = a.descriptors @ b.descriptors.T
    matches = np.asarray(_mutual(likeness, max_ratio), np.intp)
    if len(matches) < MIN_MATCHES:
        return none
    first, second = a.pixels[matches[:, 0]].astype(np.float64), b.pixels[matches[:, 1]].astype(np.float64)
    error = MAX_EPIPOLAR_ERROR_PIXELS * length / 1000
    try:
        fundamental, mask = cv2.findFundamentalMat(first, second, cv2.USAC_MAGSAC, error, 0.999, 2000)
    except cv2.error:  # it asserts that it found a matrix, and among wrong matches alone it may not
        return none
    if mask is None:
        return none
    agreed = mask.ravel() > 0
    if agreed.sum() < max(MIN_MATCHES, MIN_AGREEING_MATCH_SHARE * len(matches)):
        return none
    if agreed.sum() >= MANY_MATCHES:
        return matches[agreed]
    return _guided(likeness, a, b, np.asarray(fundamental, np.float64)[:3], error, max_ratio)


def overlaps(pictures: Sequence[Features], max_ratio: float = MAX_DESCRIPTOR_DISTANCE_RATIO) -> NDArray[np.intp]:
    """(N, N) how many of each two pictures' largest features match: few where they show different things."""
    largest = [one[np.argsort(-one.sizes, kind="stable")[:OVERLAP_FEATURES]] for one in pictures]
    found = np.zeros((len(pictures), len(pictures)), np.intp)
    for i in range(len(largest)):
        for j in range(i):
            found[i, j] = found[j, i] = len(match_features(largest[i], largest[j], max_ratio))
    return found


@njit(nogil=True, boundscheck=False, fastmath=True)
def _keep_near(likeness: np.ndarray, lines: np.ndarray, x: np.ndarray, y: np.ndarray, max_error: np.float32) -> None:
    """Give up, as unlike, what is farther from a line (a, b, c) than this."""
    for i in range(likeness.shape[0]):
        across, along, away = lines[i]
        for j in range(likeness.shape[1]):
            near = abs(across * x[j] + along * y[j] + away) <= max_error
            likeness[i, j] = likeness[i, j] if near else np.float32(-1)


@njit(nogil=True)
def _mutual(likeness: np.ndarray, max_ratio: float) -> np.ndarray:
    """Of the cosines (A, B) between unit vectors: the mutual nearest that pass the test of ratios from both sides."""
    rows, columns = likeness.shape
    across = np.zeros(columns, np.int64)
    best, second = np.empty(columns, np.float32), np.empty(columns, np.float32)
    best[:], second[:] = -2.0, -2.0
    found = np.zeros((rows, 2), np.int64)
    own, own_best, own_second = np.zeros(rows, np.int64), np.zeros(rows, np.float32), np.zeros(rows, np.float32)
    for i in range(rows):
        at, top, next_top = 0, np.float32(-2), np.float32(-2)
        for j in range(columns):
            value = likeness[i, j]
            if value > next_top:
                if value > top:
                    at, top, next_top = j, value, top
                else:
                    next_top = value
            if value > second[j]:
                if value > best[j]:
                    across[j], second[j], best[j] = i, best[j], value
                else:
                    second[j] = value
        own[i], own_best[i], own_second[i] = at, top, next_top
    count = 0
    bound = max_ratio * max_ratio
    for i in range(rows):
        j = own[i]
        apart = 1 - own_best[i]  # half the squared distance
        if across[j] == i and apart < bound * (1 - own_second[i]) and apart < bound * (1 - second[j]):
            found[count, 0], found[count, 1] = i, j
            count += 1
    return found[:count]
