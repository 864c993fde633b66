"""Where the test media and the measuring tools lie: outside the project."""

from __future__ import annotations

import importlib
import os
import sys
from collections.abc import Iterable, Sequence
from pathlib import Path
from types import ModuleType

import numpy as np
from numpy.typing import NDArray

from engine.export.videos.encoders import VideoTarget
from engine.export.videos.video import VideoWriter

ROOT = Path(__file__).parent.parent


def media(name: str) -> Path:
    """A file or folder of the test media (`GALATEA_TEST_DATA`)."""
    path = Path(os.environ.get("GALATEA_TEST_DATA", ROOT.parent / "shared" / "data")) / name
    if not path.exists():
        raise SystemExit(f"test media not found: {path} (set GALATEA_TEST_DATA to the folder that holds them)")
    return path


def tool(name: str) -> ModuleType:
    """One of the measuring tools (`GALATEA_TEST_TOOLS`), made independently of the project."""
    folder = Path(os.environ.get("GALATEA_TEST_TOOLS", ROOT.parent / "shared" / "tools"))
    if not (folder / f"{name}.py").exists():
        raise SystemExit(f"tool not found: {folder / name}.py (set GALATEA_TEST_TOOLS to the folder that holds it)")
    if str(folder) not in sys.path:
        sys.path.insert(0, str(folder))
    return importlib.import_module(name)


def driving_clips(names: Sequence[str]) -> list[Path]:
    """The driving clips whose name contains one of `names`, all if none is given."""
    found = sorted(media("driving").glob("*.mp4"))
    chosen = [path for path in found if not names or any(name in path.name for name in names)]
    if not chosen:
        raise SystemExit(f"no driving clip is named so: {', '.join(path.stem for path in found)}")
    return chosen


def write_clip(path: Path, frames: Iterable[NDArray[np.uint8]], fps: float = 25.0) -> Path:
    """A clip of these frames, hardly compressed."""
    writer: VideoWriter | None = None
    try:
        for frame in frames:
            height, width = (side - side % 2 for side in frame.shape[:2])
            if writer is None:
                writer = VideoWriter(VideoTarget(path, (width, height), fps, crf=4))
                writer.__enter__()
            writer.write(np.ascontiguousarray(frame[:height, :width]))
    finally:
        if writer is not None:
            writer.__exit__(*sys.exc_info())
    return path
