"""A part of a video: which one, how much of it, and how it is read."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

from engine.media.limits import Limits


@dataclass(frozen=True)
class Excerpt:
    """The frames of a video that are used.

    path : the video's file.
    fps : frames a second to take; None takes each.
    trim : (start, end) seconds of the video; None takes all of it.
    limits : how large it may be.
    """

    path: Path
    fps: float | None = None
    trim: tuple[float, float] | None = None
    limits: Limits = field(default_factory=Limits)
