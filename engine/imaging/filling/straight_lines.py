"""Straight lines near a part of a picture, by their segments.

Segments: von Gioi et al., "LSD: a fast line segment detector", PAMI 2010. What crosses a line cuts it into several.
"""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.imaging.masks.mask_distance import distance_to

WORKING_SIDE = 640
"""Longest side, in pixels, of the picture in which segments are looked for."""
MAX_GAP_TO_HOLE_PIXELS = 16.0
"""Pixels from the hole within which a line has to end."""
MIN_SEGMENT_LENGTH_PIXELS = 8.0
"""Pixels of the shortest segment that is looked at."""
MIN_COLLINEAR_COSINE = float(np.cos(np.deg2rad(3)))
"""Cosine of the largest angle between two segments of one line."""
MAX_OFFSET_PIXELS = 1.0
"""Pixels by which a segment's ends may be off the line where it begins."""
MAX_OFFSET_PER_PIXEL = 0.004
"""Pixels by which a segment's ends may be off a line for each pixel of distance, beside `MAX_OFFSET_PIXELS`."""
MAX_LINE_COUNT = 120
"""Lines that are looked at, at most."""


@dataclass(frozen=True)
class Line:
    """A straight line by a `point` (x, y) on it and its unit `direction`."""

    point: NDArray[np.float64]
    direction: NDArray[np.float64]

    @property
    def normal(self) -> NDArray[np.float64]:
        return np.array([-self.direction[1], self.direction[0]])


def lines_towards(picture: NDArray[np.float32], hole: NDArray[np.bool_], least: float) -> list[Line]:
    """Lines of a picture (H, W, 3) that end near a hole (H, W), of which at least so many pixels are seen: the longest first, each by
    its point nearest to the hole."""
    ends = _segments(picture, hole)
    away = distance_to(hole)
    at = np.clip(ends.round().astype(int), 0, np.array(away.shape[::-1]) - 1)
    apart = away[at[..., 1], at[..., 0]]
    length = np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1)
    kept = (length >= MIN_SEGMENT_LENGTH_PIXELS) & (apart.max(axis=1) > 3)
    ends, length, apart = ends[kept], length[kept], apart[kept]
    order = np.argsort(-length)
    ends, length, apart = ends[order], length[order], apart[order]
    used = np.zeros(len(ends), bool)
    lines: list[tuple[float, Line]] = []
    for seed in np.flatnonzero(apart.min(axis=1) < MAX_GAP_TO_HOLE_PIXELS):
        if used[seed] or len(lines) == MAX_LINE_COUNT:
            continue
        line, members = _through(ends[seed][None]), np.array([seed])
        for _ in range(2):
            members = np.flatnonzero(_along(ends, line))
            if not len(members):
                break
            line = _through(ends[members])
        used[members] = used[seed] = True
        if length[members].sum() >= least:
            nearest = ends[members].reshape(-1, 2)[np.argmin(apart[members])]
            at_hole = line.point + (nearest - line.point) @ line.direction * line.direction
            lines.append((float(length[members].sum()), Line(at_hole, line.direction)))
    return [line for _, line in sorted(lines, key=lambda entry: -entry[0])]


def _segments(picture: NDArray[np.float32], hole: NDArray[np.bool_]) -> NDArray[np.float64]:
    """Ends (N, 2, 2), x before y, of the straight segments outside the hole, found in a picture of `WORKING_SIDE` pixels."""
    grey = cv2.cvtColor(picture, cv2.COLOR_RGB2GRAY)
    grey[hole] = grey[~hole].mean()
    zoom = min(1.0, WORKING_SIDE / max(hole.shape))
    size = (round(hole.shape[1] * zoom), round(hole.shape[0] * zoom))
    small = cv2.resize(np.clip(grey, 0, 255).astype(np.uint8), size, interpolation=cv2.INTER_AREA)
    found = cv2.createLineSegmentDetector(cv2.LSD_REFINE_STD).detect(small)[0]
    if found is None:
        return np.zeros((0, 2, 2))
    scale = np.array(hole.shape[::-1]) / size
    return (np.asarray(found, float).reshape(-1, 2, 2) + 0.5) * scale - 0.5


def _through(ends: NDArray[np.float64]) -> Line:
    """The line nearest to the segments' `ends` (N, 2, 2)."""
    points = ends.reshape(-1, 2)
    middle = points.mean(axis=0)
    return Line(middle, np.linalg.svd(points - middle, full_matrices=False)[2][0])


def _along(ends: NDArray[np.float64], line: Line) -> NDArray[np.bool_]:
    """Which segments (N, 2, 2) lie on the line."""
    towards = ends[:, 1] - ends[:, 0]
    turned = np.abs(towards @ line.direction) / np.maximum(np.linalg.norm(towards, axis=1), 1e-6)
    along, aside = (ends - line.point) @ line.direction, np.abs((ends - line.point) @ line.normal)
    return np.asarray(
        (turned > MIN_COLLINEAR_COSINE) & (aside < MAX_OFFSET_PIXELS + MAX_OFFSET_PER_PIXEL * np.abs(along)).all(axis=1)
    )
