"""The frames of a clip that everything is made of: section 3.1, kept as pictures on the disk."""

from __future__ import annotations

from collections.abc import Callable, Collection
from dataclasses import dataclass, replace
from pathlib import Path

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.errors import InputError
from engine.imaging.blur import blur_effect
from engine.imaging.resample import resized, size_within
from engine.media.film_strip import FilmStrip, FilmStripWriter
from engine.media.frame_selection import equal_movement, measure_movement, read_selected
from engine.media.limits import Limits
from engine.media.video import Warn

FRAME_JPEG_QUALITY = 95
"""Of the JPEGs in which frames are kept: a third of a megabyte for one of 1080x1920."""
MAX_MEGAPIXELS_PER_SECOND = 600.0
"""4K at 60 frames a second has 498: phones film so, and only small flows and a few frames are made of it."""
MIN_CLIP_FRAMES = 12
"""Of a clip of which anything can be made."""
JUDGED_SIDE_PIXELS = 640
"""Pixels of the longer side at which frames are judged."""
MIN_BRIGHTNESS_GREY_LEVELS = 40.0
"""Grey level that the brightest tenth of a frame's pixels reaches at least."""
MAX_MEDIAN_FRAME_BLUR = 0.6
"""Of a film's frames, in the median: a sharp picture has 0.3 to 0.4, one of which nothing can be made out close to 1."""


@dataclass(frozen=True)
class ChosenFrames:
    """N frames of a clip.

    strip : pictures, uint8 (H, W, 3) sRGB, upright, of the clip's own `size` (height, width).
    numbers : (N,) int64, which of the strip's pictures they are.
    indices : (N,) int64, which of the clip's frames they are.
    seconds : (N,) float64 since the clip's first frame.
    movement : mean length of the flow from frame to frame of the clip, in shares of the longer side.
    """

    strip: FilmStrip
    size: tuple[int, int]
    numbers: NDArray[np.int64]
    indices: NDArray[np.int64]
    seconds: NDArray[np.float64]
    movement: float

    def __len__(self) -> int:
        return len(self.indices)

    def picture(self, frame: int, longest: int | None = None) -> NDArray[np.uint8]:
        """One of them, (H, W, 3) uint8, or as small as its `longest` side has to be."""
        whole = self.strip.picture(int(self.numbers[frame]))
        if longest is None or max(whole.shape[:2]) <= longest:
            return whole
        return resized(whole, size_within(whole.shape, longest))

    def without(self, left_out: Collection[int], name: str) -> ChosenFrames:
        """These but for the frames of the clip that are `left_out`, by their `indices`; `name` is the clip's input.

        Raises `InputError`: `clip_too_short` where too few are left.
        """
        kept = np.flatnonzero(~np.isin(self.indices, list(left_out)))
        if len(kept) < MIN_CLIP_FRAMES:
            raise InputError(
                "clip_too_short",
                f"Of the clip of the {name} only {len(kept)} frames are left; {MIN_CLIP_FRAMES} are needed.",
                (f"{name}_frames_left_out",),
            )
        return replace(self, numbers=self.numbers[kept], indices=self.indices[kept], seconds=self.seconds[kept])


def _spoken(name: str) -> str:
    """What a clip is called, by the input that it is."""
    return {"more": "further parts"}.get(name, name)


def choose_frames(
    path: Path,
    count: int,
    name: str,
    limits: Limits,
    tick: Callable[[float], None] = lambda fraction: None,
    warn: Warn | None = None,
) -> ChosenFrames:
    """`count` sharp frames of the clip that is the input `name`, with equal movement between them; all of a shorter one.

    Raises
    ------
    InputError : `clip_too_short`, `too_dark`, `too_blurred`, and what reading a video may raise.
    """
    wider = replace(
        limits, video_megapixels_per_second=max(limits.video_megapixels_per_second, MAX_MEGAPIXELS_PER_SECOND)
    )
    movement = measure_movement(path, wider, tick=lambda fraction: tick(0.6 * fraction))
    if len(movement) + 1 < MIN_CLIP_FRAMES:
        raise InputError(
            "clip_too_short",
            f"The clip of the {_spoken(name)} has too few frames: film a whole circle, slowly.",
            (name,),
        )
    indices, seconds, judged = [], [], []
    size = (0, 0)
    with FilmStripWriter(FRAME_JPEG_QUALITY) as strip:
        selected = equal_movement(movement, count)
        for frame in read_selected(path, selected, wider, lambda fraction: tick(0.6 + 0.4 * fraction), warn):
            strip.write(frame.rgb)
            size = frame.rgb.shape[0], frame.rgb.shape[1]
            indices.append(frame.index)
            seconds.append(frame.time)
            judged.append(_light_and_blur(frame.rgb))
        light, blur = np.median(np.array(judged), axis=0)
        _refuse_dark_or_blurred(float(light), float(blur), name)
        return ChosenFrames(
            strip.strip(),
            size,
            np.arange(len(indices)),
            np.array(indices, np.int64),
            np.array(seconds, np.float64),
            float(movement.mean()),
        )


def _light_and_blur(rgb: NDArray[np.uint8]) -> tuple[float, float]:
    """The grey level that nine tenths of a frame's pixels do not pass, and how blurred it is."""
    small = np.asarray(
        cv2.cvtColor(resized(rgb, size_within(rgb.shape, JUDGED_SIDE_PIXELS)), cv2.COLOR_RGB2GRAY), np.uint8
    )
    return float(np.percentile(small, 90)), blur_effect(small)


def _refuse_dark_or_blurred(light: float, blur: float, name: str) -> None:
    if light < MIN_BRIGHTNESS_GREY_LEVELS:
        raise InputError(
            "too_dark", f"The clip of the {_spoken(name)} is too dark: film in daylight, or with more lamps.", (name,)
        )
    if blur > MAX_MEDIAN_FRAME_BLUR:
        raise InputError(
            "too_blurred",
            f"Even the sharpest frames of the clip of the {_spoken(name)} are blurred: walk slower, and let the camera focus.",
            (name,),
        )
