"""Two portraits of nobody, for those who have no picture at hand: the actor of the built-in performances, as he is
rendered, and painted in oil."""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.imaging.masks.mask_pieces import pieces_touching
from engine.media.video import read_video
from engine.perception.masks.person import person_mask
from engine.performances import video

Array = NDArray[np.float32]

SIDE_PIXELS = 600
"""Pixels of a side of either portrait."""
PAINTING_SCALE = 2
"""The painting is painted so many times as large: strokes are finer than pixels then."""
PAINT_SEED = 1
LIGHT_GREY_LEVELS, DARK_GREY_LEVELS = (70.0, 56.0, 38.0), (62.0, 46.0, 34.0)
"""Of the ground, grey levels: where light falls on it, what it adds, and the darkest."""
WARM_GAIN = (1.10, 0.98, 0.80)
CLOTH_RGB = (128.0, 34.0, 30.0)
CLOTH_START_SHARE = 0.84
"""As a share of the picture's height: above it nothing is a shirt."""


def rendered_actor() -> NDArray[np.uint8]:
    """The actor at rest, (SIDE, SIDE, 3)."""
    first = next(iter(read_video(video("happy")))).rgb
    return np.asarray(cv2.resize(first, (SIDE_PIXELS, SIDE_PIXELS), interpolation=cv2.INTER_LANCZOS4), np.uint8)


def painted_actor() -> NDArray[np.uint8]:
    """The actor in oil: a warm light from the left, a dark ground, a red shirt, strokes, and the weave of the
    canvas."""
    rng = np.random.default_rng(PAINT_SEED)
    side = PAINTING_SCALE * SIDE_PIXELS
    filmed = np.asarray(cv2.resize(rendered_actor(), (side, side), interpolation=cv2.INTER_CUBIC), np.uint8)
    x, y = (one.astype(np.float32) / side for one in np.meshgrid(np.arange(side), np.arange(side)))
    mask = cv2.GaussianBlur(cv2.erode(person_mask(filmed), np.ones((5, 5))), (0, 0), 2.5)[..., None]
    shade = (0.72 + 0.38 * np.clip(1.15 - x, 0, 1))[..., None]
    lit = filmed * shade * np.array(WARM_GAIN, np.float32)
    cloth = _shirt(filmed, y) * mask
    lit = lit * (1 - cloth) + np.array(CLOTH_RGB, np.float32) * (lit.mean(axis=2, keepdims=True) / 70) * cloth
    composed = _ground(x, y, rng) * (1 - mask) + lit * mask
    face = np.exp(-((((x - 0.5) / 0.2) ** 2 + ((y - 0.48) / 0.27) ** 2) ** 2))[..., None]
    strokes = [_strokes(composed, size) for size in (6, 3)]
    paint = cv2.resize(
        strokes[0] * (1 - face) + strokes[1] * face, (SIDE_PIXELS, SIDE_PIXELS), interpolation=cv2.INTER_AREA
    )
    wave = np.sin(np.arange(SIDE_PIXELS) * np.pi / 2)
    weave = 2.2 * (wave[None] * wave[:, None])[..., None] + rng.normal(0, 1.5, (SIDE_PIXELS, SIDE_PIXELS, 1))
    return np.clip(paint + weave, 0, 255).astype(np.uint8)


def _shirt(filmed: NDArray[np.uint8], y: Array) -> Array:
    """(H, W, 1) how much of each pixel is the shirt: what is dark and grey and reaches the lower border."""
    hsv = cv2.cvtColor(filmed, cv2.COLOR_RGB2HSV)
    dark = ((y > CLOTH_START_SHARE) & (hsv[..., 2] < 110) & (hsv[..., 1] < 120)).astype(np.uint8)
    dark = cv2.morphologyEx(dark, cv2.MORPH_CLOSE, np.ones((15, 15), np.uint8))
    lower_border = np.zeros(dark.shape, np.bool_)
    lower_border[-1] = True
    shirt = pieces_touching(dark > 0, lower_border, connectivity=8)
    return np.asarray(cv2.GaussianBlur(shirt.astype(np.float32), (0, 0), 3)[..., None], np.float32)


def _ground(x: Array, y: Array, rng: np.random.Generator) -> Array:
    """(H, W, 3) a brown wall, lighter behind one shoulder, in broad strokes."""
    light = np.exp(-(((x - 0.75) / 0.5) ** 2 + ((y - 0.35) / 0.6) ** 2))[..., None]
    uneven = np.zeros(x.shape, np.float32)
    for cells, size in ((5, 9.0), (14, 6.0), (40, 4.0)):
        drawn = rng.normal(0, size, (cells, cells)).astype(np.float32)
        uneven += cv2.resize(drawn, x.shape[::-1], interpolation=cv2.INTER_CUBIC)
    tone = np.array(DARK_GREY_LEVELS, np.float32) + light * np.array(LIGHT_GREY_LEVELS, np.float32)
    return np.asarray(tone + uneven[..., None] * np.array((1, 0.85, 0.7), np.float32), np.float32)


def _strokes(rgb: Array, size: int) -> Array:
    """The picture in strokes of that many pixels: each has the colour that is most frequent around it."""
    bgr = cv2.cvtColor(np.clip(rgb, 0, 255).astype(np.uint8), cv2.COLOR_RGB2BGR)
    return np.asarray(cv2.cvtColor(cv2.xphoto.oilPainting(bgr, size, 1), cv2.COLOR_BGR2RGB), np.float32)
