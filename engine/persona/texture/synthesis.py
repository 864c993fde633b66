"""The texture of an expression: all photographs mixed band by band, those most that show the expression and show it in detail.

Source: section 5, equations 2 and 3. Equation 3 is garbled in the text that we have; it is read as
W = (exp(-d^2 / (2 sigma^2)) + gamma * beta^-l) * L^alpha, with l = 0 the coarsest level.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.imaging.luminance import LUMINANCE_WEIGHTS
from engine.persona.texture.appearance_subspace import REFERENCE_WIDTH_PIXELS
from engine.persona.texture.laplacian_pyramid import collapsed, laplacian_pyramid, levels_of

CONFIDENCE_POWER, UNIFORM_WEIGHT_DECAY_PER_LEVEL, COARSEST_UNIFORM_WEIGHT = 1.0, 20.0, 1.0
"""Section 6's alpha, beta and gamma."""
CONFIDENCE_SIGMA = 1.5
"""Pixels of a frame 194 wide over which the response of the Laplacian is told."""
CAP_PERCENTILE = 80
"""Of a pixel's responses in all photographs: a stronger one is a hair or an edge of light, not a finer crease."""
CONFIDENCE_REDESCENT_POWER = 2.0
"""The power with which the confidence falls again where a photograph has more than that, beside how much finer it is all over: a hair is left
out, and not only held back."""
DETAIL_FLOOR_LEVELS = 0.05
"""Grey levels: where no photograph has any detail, all count alike."""
MIN_PIXEL_BELIEF = 1e-3
MAX_BATCH = 32
"""Expressions that are mixed at once."""


@dataclass(frozen=True)
class _Level:
    """A band of all photographs.

    mixed : (N, P * 3) confidence times band.
    total : (N, P) confidence.
    all_mixed : (P * 3,) the sum of the former.
    all_total : (P,) the sum of the latter.
    uniform : the weight with which the sums count.
    shape : (h, w).
    """

    mixed: NDArray[np.float32]
    total: NDArray[np.float32]
    all_mixed: NDArray[np.float32]
    all_total: NDArray[np.float32]
    uniform: float
    shape: tuple[int, int]


@dataclass(frozen=True)
class TextureSynthesis:
    """N photographs of a frame (H, W), ready to be mixed."""

    levels: tuple[_Level, ...]

    def __call__(self, weights: NDArray[np.float32]) -> NDArray[np.uint8]:
        """(F, H, W, 3) uint8 the textures of F expressions, by how much each photograph counts, (F, N)."""
        height, width = self.levels[0].shape
        out = np.empty((len(weights), height, width, 3), np.uint8)
        for start in range(0, len(weights), MAX_BATCH):
            part = weights[start : start + MAX_BATCH]
            bands = [_mixed(level, part) for level in self.levels]
            for number in range(len(part)):
                out[start + number] = np.clip(np.rint(collapsed([band[number] for band in bands])), 0, 255)
        return out


def texture_synthesis(colours: NDArray[np.uint8], belief: NDArray[np.floating]) -> TextureSynthesis:
    """Of photographs `colours` (N, H, W, 3), laid on one another, and how far each pixel can be believed, `belief` (N, H, W)."""
    count = levels_of(colours.shape[1:])
    pyramids = [laplacian_pyramid(photo.astype(np.float32), count) for photo in colours]
    levels = []
    for level in range(count):
        bands = np.array([pyramid[level] for pyramid in pyramids])
        shape = (bands.shape[1], bands.shape[2])
        believed = np.array([_shrunk(one, shape) for one in belief]) + np.float32(MIN_PIXEL_BELIEF)
        if level < count - 1:
            believed *= _confidence(bands, colours.shape[2] / REFERENCE_WIDTH_PIXELS)
        levels.append(
            _level(bands, believed, COARSEST_UNIFORM_WEIGHT * UNIFORM_WEIGHT_DECAY_PER_LEVEL ** -(count - 1 - level))
        )
    return TextureSynthesis(tuple(levels))


def _level(bands: NDArray[np.float32], total: NDArray[np.float32], uniform: float) -> _Level:
    count, height, width, _ = bands.shape
    mixed = (bands * total[..., None]).reshape(count, -1)
    flat = total.reshape(count, -1)
    return _Level(mixed, flat, mixed.sum(axis=0), flat.sum(axis=0), uniform, (height, width))


def _mixed(level: _Level, weights: NDArray[np.float32]) -> NDArray[np.float32]:
    """(F, h, w, 3) the band's means, by equation 3's weights."""
    mixed = weights @ level.mixed + np.float32(level.uniform) * level.all_mixed
    total = weights @ level.total + np.float32(level.uniform) * level.all_total
    mean = mixed.reshape(len(weights), -1, 3) / total[..., None]
    return np.asarray(mean.reshape(len(weights), *level.shape, 3), np.float32)


def _confidence(bands: NDArray[np.float32], unit: float) -> NDArray[np.float32]:
    """(N, h, w) how much detail each photograph has at each pixel of a band (N, h, w, 3), L^alpha of equation 2."""
    grey = np.abs(bands @ LUMINANCE_WEIGHTS)
    told = np.array([cv2.GaussianBlur(one, (0, 0), CONFIDENCE_SIGMA * unit) for one in grey])
    capped = np.minimum(told, _cap(told)) + DETAIL_FLOOR_LEVELS
    sharpness = np.median(
        (told + DETAIL_FLOOR_LEVELS) / (told.mean(axis=0) + DETAIL_FLOOR_LEVELS), axis=(1, 2), keepdims=True
    )
    told /= sharpness
    most = _cap(told) + DETAIL_FLOOR_LEVELS
    capped *= np.minimum(1, most / np.maximum(told, DETAIL_FLOOR_LEVELS)) ** CONFIDENCE_REDESCENT_POWER
    return np.asarray(np.maximum(capped, DETAIL_FLOOR_LEVELS) ** CONFIDENCE_POWER, np.float32)


def _cap(told: NDArray[np.float32]) -> NDArray[np.float32]:
    """(h, w) `CAP_PERCENTILE` of (N, h, w), as `np.percentile` has it: of few numbers for each of many pixels sorting is four times as quick."""
    ordered, place = np.sort(told, axis=0), CAP_PERCENTILE / 100 * (len(told) - 1)
    below = int(place)
    above = min(below + 1, len(told) - 1)
    return np.asarray(ordered[below] + np.float32(place - below) * (ordered[above] - ordered[below]), np.float32)


def _shrunk(weights: NDArray[np.floating], shape: Sequence[int]) -> NDArray[np.float32]:
    small = cv2.resize(np.asarray(weights, np.float32), (shape[1], shape[0]), interpolation=cv2.INTER_AREA)
    return np.asarray(small, np.float32)
