"""Corrections painted by hand: strokes of a round brush, and pictures that stand for a mask or a label map."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.body.parts import BODY_PARTS
from engine.character.options import LabelStroke, MaskStroke
from engine.errors import InputError
from engine.media.image import read_image
from engine.media.limits import Limits

LABEL_COLOURS = np.array(
    [[250, 180, 60], [220, 80, 80], [80, 220, 80], [60, 160, 220], [200, 80, 200], [60, 220, 220], [0, 0, 0]], np.uint8
)
"""Of `labels.png`: head, torso, left arm, right arm, left leg, right leg, nobody."""
STROKE_COLOUR_TOLERANCE_LEVELS = 40
"""Distance, in levels of red, green and blue, up to which a colour is taken for one of these: JPEG changes them a little."""
STROKE_SUBPIXEL_BITS = 4
"""Bits behind the point of a stroke's coordinates."""


def read_mask(path: Path, sizes: Sequence[tuple[int, int]], limits: Limits) -> NDArray[np.float32]:
    """A mask (H, W) in [0, 1] from a picture that must have one of `sizes` (width, height).

    Raises
    ------
    InputError : `mask_size`, and what reading a picture may raise.
    """
    picture = read_image(path, limits)
    _require_size("mask", picture.rgb, sizes)
    grey = picture.rgb.astype(np.float32).mean(-1) / 255
    # of a picture that is cut out, what is cut out counts
    return grey if picture.alpha is None else picture.alpha


def read_labels(path: Path, sizes: Sequence[tuple[int, int]], limits: Limits) -> NDArray[np.int8]:
    """A label map (H, W) from a picture in the colours of `LABEL_COLOURS`: indices of `BODY_PARTS`; -1 nobody, and where the colour is
    none of these, as between two of them where edges are soft.

    Raises
    ------
    InputError : `labels_size`, and what reading a picture may raise.
    """
    picture = read_image(path, limits)
    _require_size("labels", picture.rgb, sizes)
    labels = np.full(picture.rgb.shape[:2], -1, np.int8)
    for index, colour in enumerate(LABEL_COLOURS[: len(BODY_PARTS)].astype(np.int32)):
        labels[np.square(picture.rgb - colour).sum(-1) <= STROKE_COLOUR_TOLERANCE_LEVELS**2] = index
    return labels


def _require_size(what: str, rgb: NDArray[np.uint8], sizes: Sequence[tuple[int, int]]) -> None:
    height, width = rgb.shape[:2]
    if (width, height) not in sizes:
        wanted = " or ".join(f"{w} x {h}" for w, h in dict.fromkeys(sizes))
        raise InputError(
            f"{what}_size",
            f"The {what} has {width} x {height} pixels: make it as large as the picture, {wanted}.",
            (what,),
        )


def painted(
    strokes: Sequence[MaskStroke | LabelStroke], shape: tuple[int, int], scale: NDArray[np.float64]
) -> Iterator[NDArray[np.float32]]:
    """One after another, where each stroke covers a picture of `shape` (H, W), in [0, 1], soft at its edge. `scale`
    (2,) is how many of its pixels one has in which strokes are counted, along x and y."""
    for stroke in strokes:
        drawn = np.zeros(shape, np.uint8)
        radius = stroke.radius * float(scale.mean())
        path = (np.array(stroke.path, np.float64) + 0.5) * scale - 0.5
        if len(path) == 1:
            path = np.repeat(path, 2, axis=0)
        thickness = max(1, round(2 * radius))
        at = np.rint(path * 2**STROKE_SUBPIXEL_BITS).astype(np.int32)
        cv2.polylines(drawn, [at], False, (255,), thickness, cv2.LINE_AA, STROKE_SUBPIXEL_BITS)
        yield drawn.astype(np.float32) / np.float32(255)


def repaint_mask(
    alpha: NDArray[np.float32], strokes: Sequence[MaskStroke], scale: NDArray[np.float64]
) -> NDArray[np.float32]:
    """A mask (H, W) with strokes over it, in their order; `scale` (2,) as in `painted`."""
    out = alpha.copy()
    for stroke, cover in zip(strokes, painted(strokes, (alpha.shape[0], alpha.shape[1]), scale), strict=True):
        out = out * (1 - cover) + (cover if stroke.person else 0)
    return out.astype(np.float32)


def relabel(
    labels: NDArray[np.int8],
    strokes: Sequence[LabelStroke],
    scale: NDArray[np.float64],
    to_grid: NDArray[np.float64],
    shape: tuple[int, int],
) -> NDArray[np.int8]:
    """Labels on a grid (h, w) with strokes over those of the person, in their order. `scale` (2,) and `shape` (H, W) are of
    the picture, `to_grid` (2, 3) from its pixels to the grid's."""  # fmt: skip
    out = labels.copy()
    size = (labels.shape[1], labels.shape[0])
    for stroke, cover in zip(strokes, painted(strokes, shape, scale), strict=True):
        on_grid = np.asarray(cv2.warpAffine(cover, to_grid, size, flags=cv2.INTER_LINEAR)) > 0.5
        out[on_grid & (labels >= 0)] = BODY_PARTS.index(stroke.part)
    return out
