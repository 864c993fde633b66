"""Two small clips of a person who does not exist: what an avatar can be made of where there is nobody to film.

They show the human template in made clothes, in a made room, with the truth beside them: `python -m
benchmarks.scan_studio.sample_clips` has made them, and knows it. Each is one circle: around the body, and around the head.
"""

from __future__ import annotations

from pathlib import Path
from typing import Literal

from engine.package_data import package_data

SAMPLE_FRAMES = {"body": 20, "head": 18}
"""Of each clip."""


def sample_clip(name: Literal["body", "head"]) -> Path:
    """The clip of the body, or of the head."""
    return package_data("engine.avatar.sample", f"{name}.mp4")
