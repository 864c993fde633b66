"""The puppet's film: how it is framed, and drawn frame by frame."""

from __future__ import annotations

import os
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor

import numpy as np
from numpy.typing import NDArray

from engine.imaging.resample import resized
from engine.persona.motion.performance import Performance
from engine.persona.persona import Persona
from engine.persona.puppet import Puppet

FILM_EXTENT_RATIO = 1.25
"""Of the space that the face takes in all frames, that the picture has."""
MAX_DRIVER_WIDTH_RATIO = 2.0
"""Times the puppet's width that a driver beside it may take."""
PUPPET_TEXTURES_AT_ONCE = 16


def puppet_frames(
    persona: Persona, performance: Performance, background: NDArray[np.uint8]
) -> Iterator[NDArray[np.uint8]]:
    """(h, w, 3) frames: the puppet alone before a `background` (h, w, 3), moving as the driver's head does, and as large as lets all of
    it be seen in every frame."""
    puppet = Puppet(persona)
    scale, shift = _framing(performance, (background.shape[1], background.shape[0]))

    def draw(number: int, texture: NDArray[np.uint8]) -> NDArray[np.uint8]:
        placing = performance.linear[number] * scale, performance.shift[number] * scale + shift
        return puppet.draw(performance.faces[number], texture, placing, background)

    count = len(performance.faces)
    with ThreadPoolExecutor(os.cpu_count() or 1, thread_name_prefix="film") as pool:
        for start in range(0, count, PUPPET_TEXTURES_AT_ONCE):
            textures = persona.synthesis(performance.weights[start : start + PUPPET_TEXTURES_AT_ONCE])
            yield from pool.map(draw, range(start, count), textures)


def size_beside(driver: tuple[int, int], size: tuple[int, int]) -> tuple[int, int]:
    """The even (width, height) of a film of `size` (width, height) with a driver of that size beside it, as high as it, and
    `MAX_DRIVER_WIDTH_RATIO` times as wide at most."""
    width, height = size
    return width + 2 * round(min(driver[0] / driver[1] * height, MAX_DRIVER_WIDTH_RATIO * width) / 2), height


def beside(left: NDArray[np.uint8], right: NDArray[np.uint8], background: tuple[int, int, int]) -> NDArray[np.uint8]:
    """(h, w, 3) two pictures side by side, as large as `size_beside` says: the left one fitted into its part, the background about
    it."""
    height, own = right.shape[:2]
    width = size_beside((left.shape[1], left.shape[0]), (own, height))[0] - own
    out = np.empty((height, width + own, 3), np.uint8)
    out[:], out[:, width:] = background, right
    factor = min(width / left.shape[1], height / left.shape[0])
    small = resized(left, (max(round(left.shape[1] * factor), 1), max(round(left.shape[0] * factor), 1)))
    y, x = (height - small.shape[0]) // 2, (width - small.shape[1]) // 2
    out[y : y + small.shape[0], x : x + small.shape[1]] = small
    return out


def _framing(performance: Performance, size: tuple[int, int]) -> tuple[float, NDArray[np.float64]]:
    """The scale and the shift (3,) that bring the driver's pixels into the picture."""
    places = np.einsum("fij,fvj->fvi", performance.linear, performance.faces) + performance.shift[:, None]
    low, high = places[..., :2].min(axis=(0, 1)), places[..., :2].max(axis=(0, 1))
    extent = np.array(size, np.float64)
    scale = float((extent / (FILM_EXTENT_RATIO * (high - low))).min())
    shift = np.zeros(3)
    shift[:2] = (extent - 1) / 2 - scale * (low + high) / 2
    return scale, shift
