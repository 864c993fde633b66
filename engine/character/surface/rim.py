"""The border along which the two sheets of a part are joined: where it runs, where in the picture it lies, and the strip between
them. At a hem they end apart, and are joined further up: cloth is open from beneath.
"""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

MAX_BORDER_SHIFT_PIXELS = 1.2
"""Pixels by which the border may move to the mask's edge."""
EDGE_SEARCH_PLACES, MIN_MASK_SLOPE = 25, 0.1
"""In how many places the edge is looked for, and how steep the mask must be there (a pixel)."""
BORDER_SMOOTHING_ROUNDS = 3
"""How often the border is smoothed: a silhouette of pixels is jagged."""


def joining_strip(rim: NDArray[np.intp], again: NDArray[np.intp], within: NDArray[np.intp]) -> NDArray[np.intp]:
    """The triangles (T, 3) that join the sheets along the border `rim` (E, 2). `again` (N,): the other sheet's vertices beneath
    those of the front; `within` (N,): what lies inside a hem above them, -1 elsewhere."""
    at_hem = (within[rim] >= 0).all(1)
    a, b = rim[~at_hem].T
    found = [np.stack([b, a, again[a]], 1), np.stack([b, again[a], again[b]], 1)]
    first, last = a[within[a] >= 0], b[within[b] >= 0]  # where a hem ends
    found += [np.stack([first, within[first], again[first]], 1), np.stack([last, again[last], within[last]], 1)]
    a, b = rim[at_hem].T
    for out, into in ((np.arange(len(again)), within), (within, again)):
        found += [np.stack([out[b], out[a], into[a]], 1), np.stack([out[b], into[a], into[b]], 1)]
    return np.concatenate(found)


def smoothed_border(points: NDArray[np.float64], rim: NDArray[np.intp]) -> NDArray[np.float64]:
    """The points of the border drawn to the mean of their neighbours on it, alternately forth and back (G. Taubin, A
    signal processing approach to fair surface design, SIGGRAPH 1995), so that nothing shrinks."""
    count = len(points)
    ends = np.concatenate([rim, rim[:, ::-1]])
    degree = np.bincount(rim.ravel(), minlength=count)
    moving = degree > 0
    moved = points.copy()
    for _ in range(BORDER_SMOOTHING_ROUNDS):
        for share in (0.5, -0.53):
            sums = [np.bincount(ends[:, 0], moved[ends[:, 1], axis], count)[moving] for axis in range(3)]
            moved[moving] += share * (np.stack(sums, 1) / degree[moving, None] - moved[moving])
    return moved


def to_the_edge(points: NDArray[np.float64], soft: NDArray[np.float32]) -> NDArray[np.float64]:
    """Points (N, 2) moved along the mask's slope to the nearest place where it is 0.5; those without one within
    `MAX_BORDER_SHIFT_PIXELS` stay."""
    slope = [
        np.asarray(cv2.Sobel(soft, cv2.CV_32F, *step, ksize=3, scale=1 / 8), np.float32) for step in ((1, 0), (0, 1))
    ]
    across = np.stack([_sampled(one, points[None])[0] for one in slope], 1)
    steep = np.linalg.norm(across, axis=1)
    across /= np.maximum(steep, 1e-6)[:, None]
    steps = np.linspace(-MAX_BORDER_SHIFT_PIXELS, MAX_BORDER_SHIFT_PIXELS, EDGE_SEARCH_PLACES)
    above = _sampled(soft, points[None] + steps[:, None, None] * across[None]) - 0.5
    crosses = above[:-1] * above[1:] <= 0
    share = above[:-1] / np.where(above[:-1] == above[1:], 1, above[:-1] - above[1:])
    place = np.where(crosses, steps[:-1, None] + share * (steps[1] - steps[0]), np.inf)
    nearest = np.take_along_axis(place, np.abs(place).argmin(0)[None], 0)[0]
    found = np.isfinite(nearest) & (steep > MIN_MASK_SLOPE)
    return np.asarray(points + np.where(found, nearest, 0)[:, None] * across)


def _sampled(image: NDArray[np.float32], places: NDArray[np.floating]) -> NDArray[np.float32]:
    """An image (H, W) between its pixels at places (M, N, 2)."""
    x, y = (np.ascontiguousarray(places[..., axis], np.float32) for axis in range(2))
    return np.asarray(cv2.remap(image, x, y, cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE), np.float32)
