"""Clips in and out, for the tests."""

from __future__ import annotations

from pathlib import Path

import av
import numpy as np
from numpy.typing import NDArray

from engine.export.video import VideoWriter


def write_frames(path: Path, frames: list[NDArray[np.uint8]], fps: float = 25) -> Path:
    """A clip of these frames, hardly compressed."""
    height, width = frames[0].shape[:2]
    with VideoWriter(path, (width, height), fps, crf=8) as writer:
        for frame in frames:
            writer.write(frame)
    return path


def read_frames(path: Path) -> list[NDArray[np.uint8]]:
    """All frames of a clip."""
    with av.open(str(path)) as container:
        return [f.to_ndarray(format="rgb24") for f in container.decode(video=0)]
