"""The textures of what is behind the skin in one picture, so that viewers hold the model's face units twice, and not once for each part."""

from __future__ import annotations

from collections.abc import Sequence

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.persona.results.inner_parts import InnerPart

MIN_TEXTURE_HEIGHT_PIXELS = 64
"""Pixels that a texture has on it: lower ones are enlarged, since smaller pictures of it run into one another."""
UV_INSET_PIXELS = 2.0
"""Pixels at each edge of a texture that are not used, since smaller pictures of it run into one another."""


def inside_atlas(parts: Sequence[InnerPart]) -> tuple[NDArray[np.uint8], list[NDArray[np.float32]]]:
    """(H, W, 4) the textures of all parts below one another, alpha too, and each part's (V, 2) places on it."""
    textures = [_large(part.texture) for part in parts]
    width, height = max(one.shape[1] for one in textures), sum(one.shape[0] for one in textures)
    rows, places, top = [], [], 0
    for part, texture in zip(parts, textures, strict=True):
        tall, wide = texture.shape[:2]
        rows.append(np.pad(texture, ((0, 0), (0, width - wide), (0, 0)), mode="edge"))
        at = (
            UV_INSET_PIXELS
            + np.asarray(part.uv, np.float64) * (np.array([wide, tall]) - 2 * UV_INSET_PIXELS)
            + (0, top)
        )
        places.append((at / (width, height)).astype(np.float32))
        top += tall
    return np.concatenate(rows), places


def _large(texture: NDArray[np.uint8]) -> NDArray[np.uint8]:
    """(h, w, 4) with alpha."""
    whole = texture if texture.shape[2] == 4 else np.dstack([texture, np.full(texture.shape[:2], 255, np.uint8)])
    scale = MIN_TEXTURE_HEIGHT_PIXELS / whole.shape[0]
    if scale <= 1:
        return whole
    size = round(whole.shape[1] * scale), MIN_TEXTURE_HEIGHT_PIXELS
    return np.asarray(cv2.resize(whole, size, interpolation=cv2.INTER_LINEAR), np.uint8)
