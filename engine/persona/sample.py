"""A collection of photographs that comes with the program: the actor of the built-in performances, who is nobody."""

from __future__ import annotations

from pathlib import Path

from engine.media.image import write_image
from engine.media.video import read_video
from engine.performances import video

SAMPLE_PERFORMANCES = (
    *("happy", "surprise", "anger", "sadness", "fear"),
    *("happy-strong", "surprise-strong", "anger-strong", "sadness-strong"),
)
SAMPLE_INSTANT_SHARES = (0.25, 0.45, 0.65)
"""Shares of each performance at which a photograph is taken: at their beginnings and ends he is at rest, which is one
photograph many times."""


def write_sample_photos(folder: Path) -> tuple[Path, ...]:
    """Three photographs of each performance, and one at rest, as JPEG files in the existing `folder`."""
    made: list[Path] = []
    for name in SAMPLE_PERFORMANCES:
        frames = [frame.rgb.copy() for frame in read_video(video(name))]
        for instant in (*((0.0,) if name == SAMPLE_PERFORMANCES[0] else ()), *SAMPLE_INSTANT_SHARES):
            made.append(folder / f"{len(made):02}-{name}.jpg")
            write_image(made[-1], frames[round(instant * (len(frames) - 1))])
    return tuple(made)
