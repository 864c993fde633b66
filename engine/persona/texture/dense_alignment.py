"""Photographs laid on their common face pixel by pixel: by the flow from each one's projection, which has its light and the common
shape, to itself.

Source: section 5, "dense warping step". Weighted here by how far pixels can be believed, so that spectacles and moustaches are not
pulled onto those of others.
"""

from __future__ import annotations

from collections.abc import Callable

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.persona.texture.appearance_subspace import REFERENCE_WIDTH_PIXELS, Appearance, appearance

ALIGNMENT_ITERATIONS = 2
SMOOTHING_SIGMA = 4.0
"""Pixels of a frame 194 wide."""
MAX_SHIFT = 0.03
"""Of the frame's width: the mesh is not farther off, and what asks for more is something else."""


def align_densely(
    seen: Appearance,
    shown: NDArray[np.float32],
    area: NDArray[np.bool_],
    tick: Callable[[float], None] = lambda fraction: None,
) -> tuple[NDArray[np.float32], Appearance]:
    """Where in each photograph (H, W) of N the common face's pixels are, (N, H, W, 2) float32 offsets in pixels; and the appearance of
    what is found there. `shown` and `area` are those of `appearance`."""
    offsets = np.zeros((*seen.exposed.shape, 2), np.float32)
    flow = cv2.DISOpticalFlow.create(cv2.DISOPTICAL_FLOW_PRESET_MEDIUM)
    flow.setFinestScale(0)
    unit = seen.exposed.shape[2] / REFERENCE_WIDTH_PIXELS
    current = seen
    for iteration in range(ALIGNMENT_ITERATIONS):
        moved = np.empty_like(seen.exposed)
        for number, (photo, projected, weight) in enumerate(
            zip(current.exposed, current.projected, current.weights, strict=True)
        ):
            raw = flow.calc(_bytes(projected), _bytes(photo), np.zeros((*photo.shape, 2), np.float32))
            step = _bounded(_smoothed(np.asarray(raw, np.float32), weight, SMOOTHING_SIGMA * unit))
            offsets[number] = _bounded(step + shifted(offsets[number], step))
            moved[number] = shifted(seen.exposed[number], offsets[number], cv2.INTER_CUBIC)
            tick((iteration + (number + 1) / len(moved)) / ALIGNMENT_ITERATIONS)
        current = appearance(moved, shown, area, current.weights)
    return offsets, current


def shifted(
    picture: NDArray[np.floating], offsets: NDArray[np.float32], interpolation: int = cv2.INTER_LINEAR
) -> NDArray[np.float32]:
    """(H, W, ...) what a picture has `offsets` (H, W, 2) away from each pixel; beyond its edge, its outermost pixels."""
    rows, columns = np.indices(offsets.shape[:2], np.float32)
    found = cv2.remap(
        np.asarray(picture, np.float32),
        columns + offsets[..., 0],
        rows + offsets[..., 1],
        interpolation,
        borderMode=cv2.BORDER_REPLICATE,
    )
    return np.asarray(found, np.float32)


def _smoothed(flow: NDArray[np.float32], weight: NDArray[np.float32], sigma: float) -> NDArray[np.float32]:
    """The flow's mean about each pixel, of pixels that are believed."""
    counted = weight + np.float32(1e-3)
    total = np.asarray(cv2.GaussianBlur(flow * counted[..., None], (0, 0), sigma))
    return np.asarray(total / np.asarray(cv2.GaussianBlur(counted, (0, 0), sigma))[..., None], np.float32)


def _bounded(flow: NDArray[np.float32]) -> NDArray[np.float32]:
    longest = MAX_SHIFT * flow.shape[1]
    length = np.linalg.norm(flow, axis=-1, keepdims=True)
    return np.asarray(flow * np.minimum(1, longest / np.maximum(length, 1e-6)), np.float32)


def _bytes(grey: NDArray[np.float32]) -> NDArray[np.uint8]:
    return np.clip(np.rint(grey), 0, 255).astype(np.uint8)
