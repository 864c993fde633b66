"""The frames of a film from which a person is reconstructed (the paper's section 3.1): equal motion between them, the sharpest
of their neighbours, no larger than what can be worked with."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.errors import InputError
from engine.imaging.resample import resized, size_within
from engine.media.frame_selection import SelectedFrame, equal_movement, measure_movement, read_selected
from engine.media.limits import Limits
from engine.media.video import Warn

BODY_FRAMES, HEAD_FRAMES = 75, 50
"""Frames of each film (the paper's values)."""
LONGEST_SIDE = 1920
"""Pixels of a chosen frame: 125 of them hold 780 MB."""
MIN_BRIGHTNESS = 40
"""Of 255: what the brightest tenth of a film's frames reaches at least."""
MAX_BLUR = 0.6
"""Of a film's frames, in the median: a sharp picture has 0.3 to 0.4, one of which nothing can be made out close to 1."""
BLUR_SIDE = 640
"""Pixels of the longer side at which blur is measured."""
REBLUR_PIXELS = 9
"""By which a picture is blurred once more, to see how much there was to lose (the value of the paper below)."""


def choose_frames(
    path: Path,
    count: int,
    limits: Limits | None = None,
    tick: Callable[[float], None] = lambda fraction: None,
    warn: Warn | None = None,
    longest_side: int = LONGEST_SIDE,
) -> list[SelectedFrame]:
    """`count` frames of a film, upright, in their order; fewer where it has no more.

    The film is decoded twice and never held. Raises `InputError`: what `probe_video` raises, `too_dark`, `too_blurred`.
    """
    movement = measure_movement(path, limits, tick=lambda fraction: tick(0.6 * fraction))
    chosen = [
        replace(one, rgb=resized(one.rgb, size_within(one.rgb.shape, longest_side)).copy())
        for one in read_selected(
            path, equal_movement(movement, count), limits, lambda fraction: tick(0.6 + 0.4 * fraction), warn
        )
    ]
    greys = [np.asarray(cv2.cvtColor(one.rgb, cv2.COLOR_RGB2GRAY), np.uint8) for one in chosen]
    if np.median([np.percentile(grey, 90) for grey in greys]) < MIN_BRIGHTNESS:
        raise InputError("too_dark", "The clip is too dark to see the person's surface: film in brighter light.")
    if np.median([blur(grey) for grey in greys]) > MAX_BLUR:
        raise InputError(
            "too_blurred", "Even the sharpest frames of the clip are blurred: walk slower, and let the camera focus."
        )
    return chosen


def blur(grey: NDArray[np.uint8]) -> float:
    """How blurred a grey picture (H, W) is, in [0, 1]: the share of its changes from pixel to pixel that it keeps when it is
    blurred once more. A plain picture, in which nothing changes, counts as blurred.

    Source: F. Crete, T. Dolmiere, P. Ladret, M. Nicolas, The blur effect, SPIE 6492, 2007.
    """
    small = resized(grey, size_within(grey.shape, BLUR_SIDE)).astype(np.float32)
    kept = []
    for axis, kernel in ((0, (1, REBLUR_PIXELS)), (1, (REBLUR_PIXELS, 1))):
        changes = np.abs(np.diff(small, axis=axis))
        remaining = np.abs(np.diff(cv2.blur(small, kernel), axis=axis))
        total = float(changes.sum())
        kept.append(1.0 if total == 0 else 1 - float(np.maximum(changes - remaining, 0).sum()) / total)
    return max(kept)
