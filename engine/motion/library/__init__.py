"""Clips of the project's own, made for skeletons of any proportions."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from engine.geometry.rigging.skeleton import Skeleton
from engine.motion.clip import Clip
from engine.motion.library.dance import dance
from engine.motion.library.gait import run, walk
from engine.motion.library.jump import jump
from engine.motion.library.sit import sit
from engine.motion.library.standing import bow, idle, wave

CLIPS: Mapping[str, Callable[[Skeleton, float], Clip]] = {
    "idle": idle,
    "walk": walk,
    "run": run,
    "jump": jump,
    "sit": sit,
    "wave": wave,
    "dance": dance,
    "bow": bow,
}
"""`CLIPS[name](skeleton, fps)` is that clip for that skeleton. All face +z; walk and run travel along it."""


def built_in(name: str, skeleton: Skeleton, fps: float = 30.0) -> Clip:
    """A built-in clip for a skeleton, at `fps` frames a second.

    Raises
    ------
    KeyError : there is no such clip.
    """
    return CLIPS[name](skeleton, fps)
