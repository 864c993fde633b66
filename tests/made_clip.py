"""Clips in and out, for the tests."""

from __future__ import annotations

import zipfile
from pathlib import Path

import av
import cv2
import numpy as np
from numpy.typing import NDArray

from engine.export.videos.encoders import VideoTarget
from engine.export.videos.video import VideoWriter
from engine.perception.face.faces import find_faces

OPENS = (1.9, 2.7)
"""Seconds of `man_mouth_open_d18.mp4` in which a closed mouth opens wide: 24 frames."""


def write_frames(path: Path, frames: list[NDArray[np.uint8]], fps: float = 25, crf: int = 8) -> Path:
    """A clip of these frames, hardly compressed."""
    height, width = frames[0].shape[:2]
    with VideoWriter(VideoTarget(path, (width, height), fps, crf=crf)) as writer:
        for frame in frames:
            writer.write(frame)
    return path


def read_frames(path: Path) -> list[NDArray[np.uint8]]:
    """All frames of a clip."""
    with av.open(str(path)) as container:
        return [f.to_ndarray(format="rgb24") for f in container.decode(video=0)]


def unpacked(path: Path) -> list[NDArray[np.uint8]]:
    """The numbered pictures of a zip, RGB or RGBA."""
    with zipfile.ZipFile(path) as file:
        data = [np.frombuffer(file.read(name), np.uint8) for name in sorted(file.namelist())]
    flip = {3: cv2.COLOR_BGR2RGB, 4: cv2.COLOR_BGRA2RGBA}
    images = [cv2.imdecode(d, cv2.IMREAD_UNCHANGED) for d in data]
    return [np.asarray(cv2.cvtColor(i, flip[i.shape[2]]), np.uint8) for i in images]


def face(frame: NDArray[np.uint8]) -> NDArray[np.float32]:
    """The mesh of the face that a frame shows."""
    found = find_faces(frame)
    assert found, "the result shows no face"
    return found[0]
