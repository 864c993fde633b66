"""Which performances there are, and the files that hold them."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

FPS = 30

VIDEOS = Path(__file__).parent / "videos"
"""The rendered performances ship with the package; `python -m engine.performances render` made them."""


@dataclass(frozen=True)
class Performance:
    """A short driving video that belongs to the project.

    It starts and ends in the same neutral pose; `neutral_frame` is the frame that shows it best. `loops`: the last
    frame leads into the first.
    """

    name: str
    title: str
    emotion: str
    seconds: float
    loops: bool
    neutral_frame: int = 0


PERFORMANCES = (
    Performance("idle", "Idle: breathing, blinking, looking at you", "neutral", 5.0, loops=True),
    Performance("happy", "Happy: a smile that reaches the eyes", "happiness", 4.0, loops=False),
    Performance("surprise", "Surprise: brows fly up, the jaw drops", "surprise", 3.4, loops=False),
)


def catalogue() -> tuple[Performance, ...]:
    """All built-in performances."""
    return PERFORMANCES


def names() -> tuple[str, ...]:
    """The names of all built-in performances."""
    return tuple(performance.name for performance in PERFORMANCES)


def performance(name: str) -> Performance:
    """The performance of that name.

    Raises
    ------
    KeyError : there is none.
    """
    for found in PERFORMANCES:
        if found.name == name:
            return found
    raise KeyError(f"there is no performance {name}: choose one of {', '.join(names())}")


def video(name: str, folder: Path | None = None) -> Path:
    """The MP4 of a performance (512 x 512, 30 fps, H.264, no sound).

    Parameters
    ----------
    folder : where to look instead of in the package, for performances rendered anew.

    Raises
    ------
    KeyError : there is no such performance.
    FileNotFoundError : `folder` does not hold it.
    """
    path = (folder or VIDEOS) / f"{performance(name).name}.mp4"
    if not path.is_file():
        raise FileNotFoundError(f"{path} does not exist: make it with python -m engine.performances render {name}")
    return path
