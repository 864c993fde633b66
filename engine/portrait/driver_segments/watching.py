"""A video looked through from beginning to end: what is measured of its face in each frame, and nothing else kept."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from engine.errors import InputError
from engine.media.limits import Limits
from engine.media.video import probe_video, read_video
from engine.perception.expression.measures import MEASURES, measure
from engine.perception.face.one_face import OneFace

WATCHED_FPS = 12.0
"""Frames a second that are looked at: a wink has three of them, a syllable two."""

MAX_WATCHED_SIDE_PIXELS = 640
"""Pixels of the frames that are looked at."""

BLOCK_FRAMES = 120
"""Meshes that are kept until they are measured, ten seconds: memory stays flat in the length of the video."""


@dataclass(frozen=True)
class FaceMeasurements:
    """A video's face, frame by frame at `WATCHED_FPS`.

    seconds : how long the video is.
    values : (N, 12) float32, `MEASURES`.
    found : (N,) whether there is a face.
    boxes : (N, 4) float32 left, top, right and bottom of the face in pixels of frames with `MAX_WATCHED_SIDE_PIXELS`.
    """

    seconds: float
    values: NDArray[np.float32]
    found: NDArray[np.bool_]
    boxes: NDArray[np.float32]


def measure_video_face(
    path: Path, limits: Limits, tick: Callable[[float], None] = lambda fraction: None
) -> FaceMeasurements:
    """Look through a whole video.

    Raises
    ------
    InputError : `no_face_in_driver` where less than a second shows a face, and what reading the video may raise.
    """
    info = probe_video(path, limits)
    expected = max(1.0, info.seconds * WATCHED_FPS)
    found: list[bool] = []
    values: list[NDArray[np.float32]] = []
    boxes: list[NDArray[np.float32]] = []
    block: list[NDArray[np.float32]] = []

    def measure_block() -> None:
        if block:
            meshes = np.array(block)
            values.append(measure(meshes))
            boxes.append(np.concatenate([meshes[:, :, :2].min(axis=1), meshes[:, :, :2].max(axis=1)], axis=1))
            block.clear()

    with OneFace() as follow:
        for frame in read_video(path, fps=WATCHED_FPS, limits=limits, longest_side=MAX_WATCHED_SIDE_PIXELS):
            tick(min(len(found) / expected, 1.0))
            mesh = follow(frame.rgb)
            found.append(mesh is not None)
            if mesh is not None:
                block.append(mesh)
            if len(block) == BLOCK_FRAMES:
                measure_block()
    measure_block()
    if sum(found) < WATCHED_FPS:
        raise InputError(
            "no_face_in_driver",
            "No face was found in the driving video: use one that shows a face from the front.",
            ("driver",),
        )
    seen = np.array(found)
    return FaceMeasurements(info.seconds, _spread(values, seen, len(MEASURES)), seen, _spread(boxes, seen, 4))


def _spread(blocks: list[NDArray[np.float32]], found: NDArray[np.bool_], width: int) -> NDArray[np.float32]:
    """Rows of the frames with a face among those without, which get zeros."""
    spread = np.zeros((len(found), width), np.float32)
    spread[found] = np.concatenate(blocks)
    return spread
