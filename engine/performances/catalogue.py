"""Which performances there are, and the files that hold them."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Literal, get_args

from engine.package_data import package_folder

PERFORMANCE_FPS = 30
POSTER_SIDE_PIXELS = 256
"""Pixels of a poster."""

VIDEO_FOLDER = package_folder("engine.performances", "videos")
"""The rendered performances ship with the package; `python -m engine.performances render` made them."""


State = Literal["idle", "happy", "surprise", "anger", "fear", "sadness", "nod", "shake", "wink", "talk"]
PERFORMANCE_STATES: tuple[State, ...] = get_args(State)

Strength = Literal["normal", "strong"]


@dataclass(frozen=True)
class Performance:
    """A short driving video that belongs to the project.

    It shows a `state` in a `strength`, starts and ends in the same neutral pose, and `neutral_frame` is the frame
    that shows it best. `loops`: the last frame leads into the first. `poster_frame` is the one that shows what
    happens; `poster_frame / PERFORMANCE_FPS` lies within `seconds`.
    """

    name: str
    state: State
    strength: Strength
    title: str
    seconds: float
    poster_frame: int
    loops: bool = False
    neutral_frame: int = 0

    @property
    def emotion(self) -> str:
        """The emotion shown, in the usual word; a gesture shows none."""
        return {
            "happy": "happiness",
            "surprise": "surprise",
            "anger": "anger",
            "fear": "fear",
            "sadness": "sadness",
        }.get(self.state, "neutral")


PERFORMANCES = (
    Performance("idle", "idle", "normal", "Idle: breathing, blinking, looking at you", 5.0, 60, loops=True),
    Performance("idle-strong", "idle", "strong", "Idle: looking around, taking part", 4.0, 66, loops=True),
    Performance("happy", "happy", "normal", "Happy: a smile that reaches the eyes", 4.0, 54),
    Performance("happy-strong", "happy", "strong", "Happy: laughter, the head thrown back", 3.4, 38),
    Performance("surprise", "surprise", "normal", "Surprise: brows fly up, the jaw drops", 3.4, 33),
    Performance("surprise-strong", "surprise", "strong", "Surprise: astonished, wide open", 3.0, 27),
    Performance("anger", "anger", "normal", "Anger: a stare under lowered brows, lips pressed", 2.8, 36),
    Performance("anger-strong", "anger", "strong", "Anger: rage, teeth bared", 2.8, 40),
    Performance("fear", "fear", "normal", "Fear: wide eyes that look about, drawn lips", 2.8, 26),
    Performance("fear-strong", "fear", "strong", "Fear: terror, the head draws back", 2.8, 32),
    Performance("sadness", "sadness", "normal", "Sadness: inner brows up, the mouth turned down", 3.1, 48),
    Performance("sadness-strong", "sadness", "strong", "Sadness: near to tears, a trembling chin", 3.1, 50),
    Performance("nod", "nod", "normal", "Nod: yes", 1.8, 16),
    Performance("nod-strong", "nod", "strong", "Nod: yes, indeed", 2.2, 16),
    Performance("shake", "shake", "normal", "Shake: no", 2.0, 14),
    Performance("shake-strong", "shake", "strong", "Shake: certainly not", 2.5, 17),
    Performance("wink", "wink", "normal", "Wink: one eye, a corner of the mouth", 1.7, 19),
    Performance("wink-strong", "wink", "strong", "Wink: with half a grin and the head cocked", 1.8, 19),
    Performance("talk", "talk", "normal", "Talk: a calm sentence", 3.7, 67),
    Performance("talk-strong", "talk", "strong", "Talk: eager, every word underlined", 3.7, 60),
)


def scored() -> tuple[Performance, ...]:
    """All performances that there is a score for, whether they were filmed yet or not."""
    return PERFORMANCES


def catalogue() -> tuple[Performance, ...]:
    """All built-in performances: those that were filmed."""
    return tuple(one for one in PERFORMANCES if (VIDEO_FOLDER / f"{one.name}.mp4").is_file())


def names() -> tuple[str, ...]:
    """The names of all built-in performances."""
    return tuple(one.name for one in catalogue())


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
    path = (folder or VIDEO_FOLDER) / f"{performance(name).name}.mp4"
    if not path.is_file():
        raise FileNotFoundError(f"{path} does not exist: make it with python -m engine.performances render {name}")
    return path


def poster(name: str, folder: Path | None = None) -> Path:
    """A small picture (JPEG, 256 x 256) of a performance at its height; raises as `video` does."""
    path = (folder or VIDEO_FOLDER) / f"{performance(name).name}.jpg"
    if not path.is_file():
        raise FileNotFoundError(f"{path} does not exist: make it with python -m engine.performances posters {name}")
    return path
