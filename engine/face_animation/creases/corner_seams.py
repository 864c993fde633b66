"""The line between closed lips that goes on into the corners of a mouth, eased where these are rounded.

In a picture of closed lips it is dark and runs beyond them. A mouth that says O draws its corners together: the line becomes a knot beside the opening, where lips
go round it. A closing of the picture has no dark as narrow as that.
"""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.face_animation.creases.carried_change import add_carried
from engine.face_animation.creases.own_folds import NARROW_MOUTH_SHARES, OwnFolds, mouth_width, wears_no_moustache
from engine.face_animation.smoothstep import smoothstep
from engine.perception.face.landmarks import MOUTH_CORNER_VERTICES, eye_distance, mouth_opening

SEAM_HALF_WIDTH_EYE_DISTANCES = 0.045
"""Half the width of the widest line."""
CORNER_REACH_EYE_DISTANCES = (0.06, 0.16)
"""Eye distances from a mouth's corner up to which its line is eased, and from which on it stays."""
SOFTNESS_EYE_DISTANCES = 0.015
"""Sigma of what takes its place."""
ROUND_OPENINGS, GAPING_OPENINGS = (0.15, 0.45), (0.45, 0.7)
"""Openings of a mouth, its gap over its width, from which on it is eased and is eased wholly. First those of a mouth
that is narrower than the picture's, then of one that is as wide."""


class CornerSeams:
    """What the corners of the mouth of a picture (H, W, 3) with its face at `mesh` (478, 2 or 3) are lighter by without a line in them, beyond what they are
    without its `folds`."""

    def __init__(self, rgb: NDArray[np.uint8], mesh: NDArray[np.floating], folds: OwnFolds):
        self._width, unit = mouth_width(mesh), float(eye_distance(mesh[:, :2]))
        self._reach = CORNER_REACH_EYE_DISTANCES[1]
        self._corners = [
            one
            for vertex in MOUTH_CORNER_VERTICES
            if (one := _lighter(rgb, mesh[vertex, :2].astype(np.float64), unit, folds)) is not None
        ]
        self._most = wears_no_moustache(rgb, mesh)

    def share(self, face: NDArray[np.floating]) -> float:
        """How far the mouth of a face (478, 2 or 3) is rounded, [0, 1]."""
        opening = float(mouth_opening(face))
        narrow = smoothstep(1 - mouth_width(face) / self._width, *NARROW_MOUTH_SHARES)
        rounded = max(narrow * smoothstep(opening, *ROUND_OPENINGS), smoothstep(opening, *GAPING_OPENINGS))
        return self._most * float(rounded)

    def ease(
        self, frame: NDArray[np.uint8], origin: NDArray[np.float32], scale: float, face: NDArray[np.floating]
    ) -> None:
        """Lighten them in a `frame` (H, W, 3), in place; parameters as of `OwnFolds.ease`."""
        share = self.share(face)
        if share < 1e-3:
            return
        reach = 2 * self._reach * float(eye_distance(face[:, :2]))
        for vertex in MOUTH_CORNER_VERTICES:
            low = np.clip(np.floor(face[vertex, :2] - reach).astype(int), 0, frame.shape[1::-1])
            high = np.clip(np.ceil(face[vertex, :2] + reach).astype(int) + 1, 0, frame.shape[1::-1])
            there = (slice(low[1], high[1]), slice(low[0], high[0]))
            for change, (left, top) in self._corners:
                place = np.float32(1 / scale), np.float32(left), np.float32(top), np.float32(1)
                add_carried(frame[there], change, np.float32(share), origin[there], *place)


def _lighter(
    rgb: NDArray[np.uint8], corner: NDArray[np.float64], unit: float, folds: OwnFolds
) -> tuple[NDArray[np.float32], tuple[int, int]] | None:
    """(h, w, 3) grey levels by which a picture is lighter around a `corner` (2,) of its mouth, for an eye distance of `unit` pixels, and the pixel (x, y) at
    which that begins; None beside the picture."""
    reach = CORNER_REACH_EYE_DISTANCES[1] * unit
    radius = max(1, round(SEAM_HALF_WIDTH_EYE_DISTANCES * unit))
    low = np.clip(np.floor(corner - reach).astype(int) - 2 * radius, 0, rgb.shape[1::-1])
    high = np.clip(np.ceil(corner + reach).astype(int) + 2 * radius + 1, 0, rgb.shape[1::-1])
    if (high - low).min() < 4:
        return None
    part = rgb[low[1] : high[1], low[0] : high[0]].astype(np.float32)
    disk = cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (2 * radius + 1, 2 * radius + 1))
    closed = cv2.morphologyEx(part, cv2.MORPH_CLOSE, disk)
    closed = np.asarray(cv2.GaussianBlur(closed, (0, 0), max(SOFTNESS_EYE_DISTANCES * unit, 0.5)), np.float32)
    y, x = np.indices(part.shape[:2], np.float32)
    away = np.hypot(x + low[0] - corner[0], y + low[1] - corner[1]) / unit
    near = 1 - smoothstep(away, *CORNER_REACH_EYE_DISTANCES)
    lighter = np.maximum(closed - part - np.maximum(folds.within(low, high), 0), 0)
    return np.asarray(near[..., None] * lighter, np.float32), (int(low[0]), int(low[1]))
