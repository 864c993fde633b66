"""Places to stand in: photographs that come with scikit-image, and streets laid out of its photographed surfaces."""

from __future__ import annotations

from pathlib import Path

import cv2
import numpy as np
import skimage
from numpy.typing import NDArray

from engine.media.image import read_image

HORIZON_SHARE = 0.72
"""Where wall and ground meet, as a share of the picture's height."""
BRICK_RGB, PLASTER_RGB, STONE_RGB, LAWN_RGB = (172, 124, 106), (206, 202, 192), (176, 168, 156), (122, 140, 88)
"""The surfaces were photographed without colour: how light shows in them."""


def places(size: tuple[int, int]) -> dict[str, NDArray[np.uint8]]:
    """Pictures (height, width, 3) without anybody, by name. They are files of the installed package: none is fetched."""
    return {
        "garage": _cropped("motorcycle_left.png", size, 0.8),
        "street": _street("brick.png", BRICK_RGB, "gravel.png", STONE_RGB, size),
        "garage door": _cropped("motorcycle_left.png", size, 0.0),
        "yard": _street("brick.png", PLASTER_RGB, "grass.png", LAWN_RGB, size),
    }


def _photo(name: str) -> NDArray[np.uint8]:
    return read_image(Path(skimage.__file__).parent / "data" / name).rgb


def _cropped(name: str, size: tuple[int, int], left: float) -> NDArray[np.uint8]:
    """A part of a photograph of the wanted shape, as high as it is; `left`: what of its spare width is left of it."""
    photo = _photo(name)
    width = round(photo.shape[0] * size[1] / size[0])
    start = round(left * (photo.shape[1] - width))
    return np.asarray(cv2.resize(photo[:, start : start + width], size[::-1], interpolation=cv2.INTER_CUBIC), np.uint8)


def _street(
    wall: str,
    wall_colour: tuple[int, int, int],
    ground: str,
    ground_colour: tuple[int, int, int],
    size: tuple[int, int],
) -> NDArray[np.uint8]:
    """A wall, its rows level, and before it the ground in perspective."""
    height, width = size
    upright = np.rot90(_tinted(_photo(wall), wall_colour))
    side = max(height, width)
    picture = np.ascontiguousarray(cv2.resize(upright, (side, side), interpolation=cv2.INTER_CUBIC)[:height, :width])
    flat = np.tile(_tinted(_photo(ground), ground_colour), (2, 2, 1))
    top = round(HORIZON_SHARE * height)
    far = np.array([[0, 0], [1, 0], [1, 1], [0, 1]], np.float32) * np.array([flat.shape[1], flat.shape[0]], np.float32)
    near = np.array([[0, top], [width, top], [1.5 * width, height], [-0.5 * width, height]], np.float32)
    seen = cv2.warpPerspective(flat, cv2.getPerspectiveTransform(far, near), (width, height), flags=cv2.INTER_AREA)
    picture[top:] = seen[top:]
    return np.asarray(picture, np.uint8)


def _tinted(photo: NDArray[np.uint8], colour: tuple[int, int, int]) -> NDArray[np.uint8]:
    grey = photo.mean(-1, keepdims=True)
    return np.clip(grey / grey.mean() * np.array(colour) * 0.9, 0, 255).astype(np.uint8)
