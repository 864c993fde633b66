"""What covers a face's skin: the bridge of glasses across the nose, and dark hair above the upper lip.

Both are told from one picture and its face mesh, in a copy that is turned and sized by the eyes. A bridge is a thin bright line (metal
that shines, skin between dark edges) from one side of the nose's root to the other; folds of skin are dark, and their flanks broad. Hair
above the lip is darker than the cheek beside it on both sides of the face, which a shadow from one side is not.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import nan

import cv2
import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import gaussian_filter1d, map_coordinates

from engine.imaging.luminance import LUMINANCE_WEIGHTS
from engine.imaging.resample import resized
from engine.media.colour_conversion.tone_mapping import srgb_light
from engine.perception.face.landmarks import (
    LEFT_EYE_CORNER_VERTICES,
    LIPS_OUTER,
    NOSE_TIP_VERTEX,
    RIGHT_EYE_CORNER_VERTICES,
)

COPY_EYE_CORNERS_PIXELS = 160
"""Pixels between the outer corners of the eyes in the copy."""
MIN_BRIDGE_EYE_PIXELS = 80
"""Pixels between the outer corners of the eyes in the picture from which a bridge can be seen."""
MIN_HAIR_EYE_PIXELS = 40
"""Pixels between the outer corners of the eyes in the picture from which hair above the lip can be seen."""
MAX_NOSE_OFFSET = 0.5
"""By how much of half their distance the tip of the nose may stand off their middle: of a face seen from the side nothing is told."""
OUTER_CORNERS, INNER_CORNERS = zip(RIGHT_EYE_CORNER_VERTICES, LEFT_EYE_CORNER_VERTICES, strict=True)
"""Vertices of the face mesh; the person's right eye's first."""
NOSE_ROOT = (8, 168, 6, 197, 195)
"""From between the brows down the nose: a bridge crosses this line."""
BRIDGE_REACH = 0.25
"""Of the distance between the inner corners, how far a bridge reaches to either side."""
LINE_SIGMA = 1.5
"""Pixels of the copy, half the width of a line."""
LINE_COLUMNS = 21
"""Places across the nose where a bridge's line is looked for, each within a pixel of the place before."""
LOG_OFFSET_LEVELS = 8.0
"""Grey levels that are added before the logarithm: noise of black is none of a line."""
ABOVE_LIP = ((2, 98, 92, 0, 167, 165), (2, 327, 322, 0, 393, 391))
"""Corners of the skin between nose and lip, of the right and the left half."""
CHEEK_HALVES_VERTICES = ((50, 101, 205, 36, 142, 187), (280, 330, 425, 266, 371, 411))
"""Corners of the skin of the right and the left cheek."""
LIP_MARGIN_PIXELS = 7
"""Pixels of the copy about the lips that are none of the skin."""
MIN_REGION_PIXELS = 15
"""Pixels of a region that say what colour it is."""


@dataclass(frozen=True)
class FaceWear:
    """`bridge`: how strong the line across the nose's root is: its second derivative along the nose at `LINE_SIGMA`, times that squared,
    of the logarithm of grey levels, in the mean along the line. `lip_darkness`: the natural logarithm of how many times less light
    comes from above the lip than from the cheek, of the half of the face where it is less. NaN: not to be told."""

    bridge: float = nan
    lip_darkness: float = nan


def face_wear(rgb: NDArray[np.uint8], mesh: NDArray[np.floating]) -> FaceWear:
    """What a face's mesh (478, >= 2), pixels, covers in a picture (H, W, 3) uint8. NaN where it is turned aside or too small."""
    places = np.asarray(mesh[:, :2], np.float64)
    right, left = places[list(OUTER_CORNERS)]
    apart = float(np.linalg.norm(left - right))
    if (
        apart < MIN_HAIR_EYE_PIXELS
        or abs((places[NOSE_TIP_VERTEX] - (left + right) / 2) @ (left - right)) > MAX_NOSE_OFFSET * apart**2 / 2
    ):
        return FaceWear()
    copy, at = _copy(rgb, places)
    return FaceWear(_bridge(copy, at) if apart >= MIN_BRIDGE_EYE_PIXELS else nan, _lip_darkness(copy, at))


def _copy(rgb: NDArray[np.uint8], places: NDArray[np.float64]) -> tuple[NDArray[np.uint8], NDArray[np.float64]]:
    """The face, upright, with `COPY_EYE_CORNERS_PIXELS` (2 by 2 of them), and the mesh's (478, 2) places there."""
    right, left = places[list(OUTER_CORNERS)]
    scale = COPY_EYE_CORNERS_PIXELS / float(np.linalg.norm(left - right))
    if scale < 1:  # warping alone would skip pixels
        size = max(2, round(rgb.shape[1] * scale)), max(2, round(rgb.shape[0] * scale))
        places = (places + 0.5) * (np.array(size) / rgb.shape[1::-1]) - 0.5
        rgb = resized(rgb, size)
    return _warped(rgb, places)


def _warped(rgb: NDArray[np.uint8], places: NDArray[np.float64]) -> tuple[NDArray[np.uint8], NDArray[np.float64]]:
    right, left = places[list(OUTER_CORNERS)]
    along = (left - right) / np.linalg.norm(left - right) ** 2 * COPY_EYE_CORNERS_PIXELS
    turn = np.array([[along[0], along[1]], [-along[1], along[0]]])
    shift = np.array([COPY_EYE_CORNERS_PIXELS, 0.75 * COPY_EYE_CORNERS_PIXELS]) - turn @ ((left + right) / 2)
    side = 2 * COPY_EYE_CORNERS_PIXELS
    copy = cv2.warpAffine(
        np.ascontiguousarray(rgb), np.column_stack([turn, shift]), (side, side), flags=cv2.INTER_LINEAR
    )
    return np.asarray(copy, np.uint8), places @ turn.T + shift


def _bridge(copy: NDArray[np.uint8], at: NDArray[np.float64]) -> float:
    grey = np.log(copy @ LUMINANCE_WEIGHTS + LOG_OFFSET_LEVELS)
    root = at[list(NOSE_ROOT)]
    along = np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(root, axis=0), axis=1))])
    steps = np.linspace(0, along[-1], max(2, int(along[-1])))
    middle = np.column_stack([np.interp(steps, along, root[:, k]) for k in (0, 1)])
    right, left = at[list(INNER_CORNERS)]
    across = np.linspace(-BRIDGE_REACH, BRIDGE_REACH, LINE_COLUMNS)[:, None] * (left - right)
    places = middle[:, None] + across
    lines = map_coordinates(grey, [places[..., 1], places[..., 0]], order=1, mode="nearest")
    curved = LINE_SIGMA**2 * gaussian_filter1d(lines - lines.mean(), LINE_SIGMA, axis=0, order=2)
    rim = int(2 * LINE_SIGMA)
    return strongest_path(np.maximum(-curved[rim:-rim], 0)) if len(curved) > 2 * rim else nan


def strongest_path(response: NDArray[np.floating]) -> float:
    """The greatest mean of `response` (R, C) along a path from the first column to the last, by at most a row up or down each."""
    total = response[:, 0].astype(np.float64)
    for column in response.T[1:]:
        beside = np.pad(total, 1, constant_values=-np.inf)
        total = np.maximum(np.maximum(beside[:-2], beside[2:]), total) + column
    return float(total.max()) / response.shape[1]


def _lip_darkness(copy: NDArray[np.uint8], at: NDArray[np.float64]) -> float:
    light = np.log(srgb_light(copy.astype(np.float32) / 255) + 1e-3).mean(2)
    lips = cv2.dilate(_filled(at[list(LIPS_OUTER)]), np.ones((LIP_MARGIN_PIXELS, LIP_MARGIN_PIXELS), np.uint8)) > 0
    darker = []
    for above, cheek in zip(ABOVE_LIP, CHEEK_HALVES_VERTICES, strict=True):
        skin, beside = (_filled(at[list(corners)]) > 0 for corners in (above, cheek))
        skin &= ~lips
        if min(int(skin.sum()), int(beside.sum())) < MIN_REGION_PIXELS:
            return nan
        darker.append(float(np.median(light[beside]) - np.median(light[skin])))
    return min(darker)


def _filled(corners: NDArray[np.float64]) -> NDArray[np.uint8]:
    """1 within the convex hull of points (N, 2) of the copy."""
    out = np.zeros((2 * COPY_EYE_CORNERS_PIXELS, 2 * COPY_EYE_CORNERS_PIXELS), np.uint8)
    hull = cv2.convexHull(corners.astype(np.float32)).round().astype(np.int32)
    return np.asarray(cv2.fillConvexPoly(out, hull, 1), np.uint8)
