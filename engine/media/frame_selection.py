"""Frames for reconstruction out of a video: equal motion between them, and each the sharpest of its neighbours.

Source: S. Wenninger, J. Achenbach, A. Bartl, M. E. Latoschik, M. Botsch, Realistic Virtual Humans from Smartphone Videos,
VRST 2020, section 3.1. The video is decoded twice: small, to see how it moves, and at full size, where of each
neighbourhood only the sharpest frame so far is held. Never is there more of it in memory.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path

import cv2
import numpy as np
from av.video.frame import VideoFrame
from av.video.reformatter import VideoReformatter
from numpy.typing import NDArray
from scipy.ndimage import gaussian_filter1d

from engine.media.clip import Clip, open_clip
from engine.media.colour_conversion.colour import SrgbConverter
from engine.media.decoding.decode import Damage
from engine.media.limits import Limits
from engine.media.video import Warn, report_damage

MOVEMENT_SIGMA = 2.0
"""Frames: the Gaussian by which the movement is smoothed (the paper's value)."""
NEIGHBOURHOOD_FRAMES = 5
"""Frames among which the sharpest is taken, the selected one in their middle (the paper's k)."""
FLOW_SIDE_PIXELS = 320
"""Pixels of the longer side at which optical flow is computed: 10 ms a frame."""
FLOW_STEP_FRAMES = 2
"""Frames from one flow to the next: half of the flows say as much, since they are smoothed over more than that."""
FARNEBACK_PARAMETERS = {
    "pyr_scale": 0.5,
    "levels": 3,
    "winsize": 15,
    "iterations": 3,
    "poly_n": 5,
    "poly_sigma": 1.2,
    "flags": 0,
}
"""G. Farneback, Two-frame motion estimation based on polynomial expansion, 2003: as OpenCV's manual has it."""

Tick = Callable[[float], None]


@dataclass(frozen=True)
class SelectedFrame:
    """A frame that was selected.

    index : counts the video's frames from 0.
    rgb : uint8 (H, W, 3) sRGB, upright.
    time : seconds since the first frame.
    sharpness : its variance of the Laplacian.
    """

    index: int
    rgb: NDArray[np.uint8]
    time: float
    sharpness: float


def measure_movement(
    path: Path, limits: Limits | None = None, step: int = FLOW_STEP_FRAMES, tick: Tick = lambda fraction: None
) -> NDArray[np.float64]:
    """How far the picture moves from each frame to the next: (F - 1,) the mean length of the optical flow, in shares of
    the picture's longer side, of a video of F frames.

    Flow is computed over `step` frames at once and spread evenly over them. Raises what `probe_video` raises.
    """
    clip = open_clip(path, limits or Limits())
    shrink = _Grey(clip.scaled_size(FLOW_SIDE_PIXELS))
    lengths: list[float] = []
    before: NDArray[np.uint8] | None = None
    waiting, latest = 0, None
    for index, (time, frame) in enumerate(clip.frames(None, 0.0, Damage())):
        tick(min(time / max(clip.timetable.seconds, 1e-9), 1.0))
        latest = frame
        waiting += index > 0
        if before is None:
            before = shrink(frame)
        elif waiting == step:
            now = shrink(frame)
            lengths += [_mean_flow(before, now) / step] * step
            before, waiting = now, 0
    if waiting and before is not None and latest is not None:
        lengths += [_mean_flow(before, shrink(latest)) / waiting] * waiting
    return np.array(lengths) / max(shrink.size)


def equal_movement(movement: NDArray[np.floating], count: int) -> NDArray[np.int64]:
    """The frames, ascending, between which there is equal movement: `count` of them, or all where there are no more.

    Parameters
    ----------
    movement : (F - 1,) from each frame to the next. The first frame is selected, then each at which the smoothed movement
        since then reaches the next multiple of its sum over `count`. (The paper begins to add anew at each; what goes
        beyond the threshold would be lost every time, and fewer frames come of it.)
    """
    frames = len(movement) + 1
    count = min(count, frames)
    smoothed = gaussian_filter1d(np.asarray(movement, float), MOVEMENT_SIGMA) if len(movement) else np.zeros(0)
    travelled = np.concatenate([[0.0], np.cumsum(smoothed)])
    if travelled[-1] <= 0:  # nothing moves: equally far apart in time
        travelled = np.arange(frames, dtype=float)
    targets = travelled[-1] * np.arange(count) / count
    order = np.arange(count)
    first = np.searchsorted(travelled, targets * (1 - 1e-9))
    apart = np.maximum.accumulate(first - order) + order  # a leap over several thresholds still gives one frame each
    return np.minimum(apart, frames - count + order).astype(np.int64)


def neighbourhoods(selected: Sequence[int] | NDArray[np.int64], frames: int) -> list[range]:
    """The frames among which each of the `selected` looks for the sharpest: `NEIGHBOURHOOD_FRAMES` around it, of a video of so
    many `frames`. None is in two of them."""
    reach = NEIGHBOURHOOD_FRAMES // 2
    middles = [(int(a) + int(b) + 1) // 2 for a, b in pairwise(selected)]
    starts, ends = [0, *middles], [*middles, frames]
    return [
        range(max(int(frame) - reach, start), min(int(frame) + reach + 1, end))
        for frame, start, end in zip(selected, starts, ends, strict=True)
    ]


def sharpness(grey: NDArray[np.uint8]) -> float:
    """The variance of the Laplacian of a grey picture (H, W)."""
    return float(cv2.meanStdDev(cv2.Laplacian(grey, cv2.CV_32F))[1][0, 0] ** 2)


def read_selected(
    path: Path,
    selected: Sequence[int] | NDArray[np.int64],
    limits: Limits | None = None,
    tick: Tick = lambda fraction: None,
    warn: Warn | None = None,
) -> Iterator[SelectedFrame]:
    """For each of the `selected` frames the sharpest of its neighbourhood, at the video's own size, one by one.

    Raises what `probe_video` raises; `warn` is called as by `read_video`.
    """
    clip = open_clip(path, limits or Limits())
    damage = Damage()
    converter, grey = SrgbConverter(clip.size), _Grey(clip.size)
    around = neighbourhoods(selected, int(selected[-1]) + NEIGHBOURHOOD_FRAMES)
    best: tuple[float, int, float, VideoFrame] | None = None
    current = 0
    for index, (time, frame) in enumerate(clip.frames(None, 0.0, damage)):
        tick(min(time / max(clip.timetable.seconds, 1e-9), 1.0))
        if current < len(around) and index in around[current]:
            value = sharpness(grey(frame))
            if best is None or value > best[0]:
                best = value, index, time, frame
        if current < len(around) and index == around[current].stop - 1 and best is not None:
            yield _shown(clip, converter, best)
            current, best = current + 1, None
    if best is not None:
        yield _shown(clip, converter, best)
    if warn is not None:
        report_damage(clip, damage, np.inf, warn)


def select_frames(path: Path, count: int, limits: Limits | None = None) -> Iterator[SelectedFrame]:
    """The whole of section 3.1: `count` sharp frames with equal motion between them (the paper: 75 of a body, 50 of a head)."""
    yield from read_selected(path, equal_movement(measure_movement(path, limits), count), limits)


def _shown(clip: Clip, converter: SrgbConverter, best: tuple[float, int, float, VideoFrame]) -> SelectedFrame:
    value, index, time, frame = best
    return SelectedFrame(index, clip.orientation.apply(converter.convert(frame)), time, value)


class _Grey:
    """The lightness of a clip's frames, uint8 (height, width), at a `size` (width, height)."""

    def __init__(self, size: tuple[int, int]):
        self.size = size
        self._scaler = VideoReformatter()

    def __call__(self, frame: VideoFrame) -> NDArray[np.uint8]:
        return np.asarray(self._scaler.reformat(frame, *self.size, format="gray").to_ndarray(), np.uint8)


def _mean_flow(before: NDArray[np.uint8], now: NDArray[np.uint8]) -> float:
    """The mean length of the flow between two grey pictures, pixels."""
    flow = cv2.calcOpticalFlowFarneback(before, now, None, **FARNEBACK_PARAMETERS)  # type: ignore[call-overload]
    return float(np.linalg.norm(flow, axis=2).mean())
