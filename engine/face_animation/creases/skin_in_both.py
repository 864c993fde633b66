"""Where a ratio of two frames is one of skin: what both show is skin, in one colour, and neither is blurred.

A ratio image is the darkening of skin by a crease as long as the same skin is seen twice. The rim of glasses, glare on them, hair that
falls into a face, brows and a beard's edge move against the skin, and print themselves as arcs and blots. They differ
from a crease in colour, or by how much darker they are than any crease; so does what is next to them.
"""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.face_animation.motion_transfer.spectacles import behind_frame
from engine.face_animation.skin_colour import chroma
from engine.face_animation.smoothstep import smoothstep
from engine.imaging.luminance import LUMINANCE_WEIGHTS
from engine.perception.face.face_wear import face_wear
from engine.perception.face.landmarks import FACE_OVAL, LEFT_BROW, LEFT_EYE, LIPS_OUTER, RIGHT_BROW, RIGHT_EYE
from engine.perception.face_track.face_crop import CROP_EYE_DISTANCE_PIXELS

CELL_PIXELS = 3
"""Pixels of the crop, along each axis, that are looked at as one."""
CELLS_EYE_DISTANCE_PIXELS = CROP_EYE_DISTANCE_PIXELS / CELL_PIXELS
"""An eye distance of what is looked at, pixels."""
SKIN_CHROMA_DIFFERENCES, NO_SKIN_CHROMA_DIFFERENCES = 0.025, 0.05
"""By how much a pixel's shares of red and blue differ from those of the skin, up to which it is skin, and from which on it is not."""
SKIN_LIGHT_RATIOS = (0.55, 0.75, 1.3, 1.5)
"""Of the light of the skin around it: a pixel of the neutral frame outside of these is not skin, between the middle two it is."""
CREASE_LIGHT_RATIOS = (0.48, 0.58)
"""Of a pixel's light in the neutral frame, where the skin around it has all of its own: below the first it is no
crease, above the second it may be one."""
LIGHT_WINDOW_EYE_DISTANCES = 0.3
"""Within which skin is compared."""
BESIDE_EYE_DISTANCES = 0.07
"""From what is not skin within which a ratio is not trusted either."""
BESIDE_BROW_EYE_DISTANCES = 0.12
"""Eye distances from a brow within which a ratio is not trusted: it rises by more than its tracked points."""
SPECTACLES_BRIDGE_STRENGTHS = (0.025, 0.05)
"""Of `FaceWear.bridge` of a driver, up to which it wears no spectacles, and from which on it does: clips of bare faces have 0.002 to 0.007, of thin rims from 0.023 on.
Brows that meet, taken for them, cost some creases."""
BLURRED_DETAIL_SHARE, SHARP_DETAIL_SHARE = 0.3, 0.6
"""Of the neutral frame's fine structure: a frame that has less is blurred by its motion."""


class SkinInBoth:
    """The skin of a driver's `neutral` crop (*CROP, 3), whose face is at `rest` (468, 2 or 3)."""

    def __init__(self, neutral: NDArray[np.uint8], rest: NDArray[np.floating]):
        small = _small(neutral)
        self._light, self._chroma = _light(small), chroma(small)
        self._face = _filled(rest, (FACE_OVAL,), small.shape[:2])
        features = _filled(rest, (RIGHT_EYE, LEFT_EYE, LIPS_OUTER), small.shape[:2])
        brows = np.zeros(small.shape[:2], np.float32)
        for brow in (RIGHT_BROW, LEFT_BROW):
            cv2.fillConvexPoly(
                brows, cv2.convexHull((rest[list(brow), :2] / CELL_PIXELS).round().astype(np.int32)), 1.0
            )
        features = np.maximum(
            cv2.dilate(features, _disk(BESIDE_EYE_DISTANCES)), cv2.dilate(brows, _disk(BESIDE_BROW_EYE_DISTANCES))
        )
        self._skin = np.asarray(self._face * (1 - features), np.float32)
        self._weight = np.maximum(_around(self._skin), 1e-3)
        self._sharpness = _sharpness(self._light, self._face)
        tone = np.median(self._chroma[self._skin > 0], axis=0) if (self._skin > 0).any() else np.float32(1 / 3)
        dark, grey, bright, glare = SKIN_LIGHT_RATIOS
        light = self._beside_skin(self._light)
        other = np.maximum(1 - _ramp(light, dark, grey), _ramp(light, bright, glare))
        other = np.maximum(
            other,
            _ramp(
                np.abs(self._chroma - tone).max(axis=-1), SKIN_CHROMA_DIFFERENCES * 2, NO_SKIN_CHROMA_DIFFERENCES * 2
            ),
        )
        features = np.maximum(features, _behind_spectacles(neutral, rest, small.shape[:2]))
        self._neutral = 1 - np.maximum(cv2.dilate(other * self._face, _disk(BESIDE_EYE_DISTANCES)), features)

    def share(self, crop: NDArray[np.uint8], origin: NDArray[np.float32]) -> NDArray[np.float32]:
        """(*CROP,) in [0, 1], how far a frame's ratio is one of skin; `origin` (*CROP, 2) is where each pixel of the neutral crop lies in the
        frame's `crop`."""
        small = _small(crop)
        middle = origin[CELL_PIXELS // 2 :: CELL_PIXELS, CELL_PIXELS // 2 :: CELL_PIXELS][
            : small.shape[0], : small.shape[1]
        ]
        places = (middle + np.float32(0.5)) / np.float32(CELL_PIXELS) - np.float32(0.5)
        aligned = cv2.remap(small, places[..., 0], places[..., 1], cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE)
        light = _light(np.asarray(aligned))
        ratio = (light + 12) / (self._light + 12)
        other = 1 - _ramp(self._beside_skin(ratio), *CREASE_LIGHT_RATIOS)
        other = np.maximum(
            other,
            _ramp(
                np.abs(chroma(np.asarray(aligned)) - self._chroma).max(axis=-1),
                SKIN_CHROMA_DIFFERENCES,
                NO_SKIN_CHROMA_DIFFERENCES,
            ),
        )
        other = np.asarray(cv2.dilate(other * self._face, _disk(BESIDE_EYE_DISTANCES)), np.float32)
        fine = _sharpness(light, self._face) / max(self._sharpness, 1e-3)
        sharp = float(np.clip((fine - BLURRED_DETAIL_SHARE) / (SHARP_DETAIL_SHARE - BLURRED_DETAIL_SHARE), 0, 1))
        keep = cv2.GaussianBlur(
            sharp * self._neutral * (1 - other), (0, 0), 0.5 * BESIDE_EYE_DISTANCES * CELLS_EYE_DISTANCE_PIXELS
        )
        return np.asarray(cv2.resize(keep, crop.shape[1::-1], interpolation=cv2.INTER_LINEAR), np.float32)

    def _beside_skin(self, value: NDArray[np.float32]) -> NDArray[np.float32]:
        """A `value` (h, w) against the mean of the skin around."""
        return np.asarray(value / np.maximum(_around(value * self._skin) / self._weight, 1e-2), np.float32)


def _behind_spectacles(
    neutral: NDArray[np.uint8], rest: NDArray[np.floating], shape: tuple[int, ...]
) -> NDArray[np.float32]:
    """(h, w) how far a driver's `neutral` crop, whose face is at `rest` (468, 2 or 3), shows spectacles: thin rims of metal have the skin's colours, and slide over
    it with every smile."""
    bridge = face_wear(neutral, rest).bridge
    band = np.zeros(shape, np.float32)
    if bridge > SPECTACLES_BRIDGE_STRENGTHS[0]:  # nor where it cannot be told, NaN
        behind = rest[behind_frame()[: len(rest)] > 0.5, :2] / CELL_PIXELS
        share = float(smoothstep(bridge, *SPECTACLES_BRIDGE_STRENGTHS))
        cv2.fillConvexPoly(band, cv2.convexHull(behind.round().astype(np.int32)), share)
    return band


def _around(value: NDArray[np.float32]) -> NDArray[np.float32]:
    """Averaged widely."""
    small = cv2.resize(value, None, fx=0.5, fy=0.5, interpolation=cv2.INTER_AREA)
    wide = cv2.GaussianBlur(small, (0, 0), LIGHT_WINDOW_EYE_DISTANCES * CELLS_EYE_DISTANCE_PIXELS / 2)
    return np.asarray(cv2.resize(wide, value.shape[::-1], interpolation=cv2.INTER_LINEAR), np.float32)


def _small(rgb: NDArray[np.uint8]) -> NDArray[np.uint8]:
    height, width = rgb.shape[:2]
    return np.asarray(
        cv2.resize(rgb, (width // CELL_PIXELS, height // CELL_PIXELS), interpolation=cv2.INTER_AREA), np.uint8
    )


def _light(rgb: NDArray[np.uint8]) -> NDArray[np.float32]:
    return np.asarray(rgb.astype(np.float32) @ LUMINANCE_WEIGHTS, np.float32)


def _filled(
    rest: NDArray[np.floating], contours: tuple[tuple[int, ...], ...], shape: tuple[int, ...]
) -> NDArray[np.float32]:
    mask = np.zeros(shape, np.float32)
    cv2.fillPoly(mask, [(rest[list(one), :2] / CELL_PIXELS).round().astype(np.int32) for one in contours], 1.0)
    return mask


def _disk(eye_distances: float) -> NDArray[np.uint8]:
    size = 2 * max(1, round(eye_distances * CELLS_EYE_DISTANCE_PIXELS)) + 1
    return np.asarray(cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (size, size)), np.uint8)


def _ramp(value: NDArray[np.float32], low: float, high: float) -> NDArray[np.float32]:
    return np.asarray(np.clip((value - low) / (high - low), 0, 1), np.float32)


def _sharpness(light: NDArray[np.float32], face: NDArray[np.float32]) -> float:
    """The mean size of what is finer than two pixels within a face."""
    return float((np.abs(cv2.Laplacian(light, cv2.CV_32F)) * face).sum() / max(float(face.sum()), 1.0))
