"""How much memory a whole process takes, and that the driver's length says nothing about it."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Iterator, Sequence
from itertools import islice
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
from numpy.typing import NDArray

from benchmarks.portrait_figures.speed import SMALL_CLIP, TIMED_PICTURE_SIZE, portrait
from benchmarks.presentation.tables import table
from benchmarks.shared_media import ROOT, media
from engine.export.videos.encoders import VideoTarget
from engine.export.videos.video import VideoWriter
from engine.media.video import probe_video, read_video

CLIP_SECONDS = (5, 180)
"""Lengths of the two clips that are compared."""
MAX_GROWTH_MB = 100.0
"""Megabytes by which the peak of the longer clip may lie above the shorter one's."""
SHELL_PROGRAM = """
import re
from pathlib import Path
from shell.main import main
main(standalone_mode=False)
print(re.search(r"VmHWM:\\s+(\\d+)", Path("/proc/self/status").read_text())[1])
"""
"""`galatea`, and then the most memory that the process ever held, in units of 1024 bytes. Not what the parent is told of its
children (`getrusage`), which counts the parent's own memory where that is more."""


def memory(seconds: Sequence[float] = CLIP_SECONDS) -> None:
    """Print the peak of `galatea portrait` for clips of these lengths."""
    rows, peaks = [], []
    with TemporaryDirectory() as name:
        folder = Path(name)
        image = portrait(folder)
        for length in seconds:
            clip, frames = looped(media(SMALL_CLIP), length, folder / f"{length:g}.mp4")
            peaks.append(_peak(image, clip, folder))
            rows.append([f"{length:g} s", f"{frames}", f"{peaks[-1]:.0f}", f"{peaks[-1] - peaks[0]:+.0f}"])
    title = f"Memory: a whole process, both new, {TIMED_PICTURE_SIZE[0]}x{TIMED_PICTURE_SIZE[1]}; the most that is resident, MB"
    print(table(title, ["driver", "frames", "peak", "more than the first"], rows))
    print(f"\nGoal: at most {MAX_GROWTH_MB:.0f} more.")


def looped(source: Path, seconds: float, path: Path) -> tuple[Path, int]:
    """Write a clip of this length in which another one plays there and back again; how many frames it has."""
    info = probe_video(source)
    count = round(seconds * info.fps)
    with VideoWriter(VideoTarget(path, (info.width, info.height), info.fps)) as writer:
        for rgb in islice(_there_and_back([frame.rgb for frame in read_video(source)]), count):
            writer.write(rgb)
    return path, count


def _there_and_back(frames: list[NDArray[np.uint8]]) -> Iterator[NDArray[np.uint8]]:
    while True:
        yield from frames
        yield from frames[-2:0:-1]


def _peak(image: Path, clip: Path, folder: Path) -> float:
    """Megabytes."""
    command = [
        sys.executable,
        "-c",
        SHELL_PROGRAM,
        "portrait",
        str(image),
        "--driver",
        str(clip),
        "-o",
        str(folder / "out"),
    ]
    environment = {**os.environ, "GALATEA_DATA_DIR": str(folder / clip.stem)}
    done = subprocess.run(command, cwd=ROOT, env=environment, capture_output=True, text=True, check=False)
    if done.returncode:
        raise SystemExit(f"{' '.join(command)}\n{done.stderr[-2000:]}")
    return int(done.stdout.split()[-1]) * 1024 / 1e6
