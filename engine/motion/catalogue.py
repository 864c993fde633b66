"""The built-in clips, to be listed: `engine.motion.library` makes them."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class BuiltInMotion:
    """A built-in clip: how long it lasts on any skeleton, and whether its last frame leads into the first."""

    name: str
    title: str
    seconds: float
    loops: bool


CATALOGUE = (
    BuiltInMotion("idle", "Idle: breathing, a look aside", 6.0, True),
    BuiltInMotion("walk", "Walk, at an easy pace", 1.1, True),
    BuiltInMotion("run", "Run", 0.7, True),
    BuiltInMotion("jump", "Jump, on the spot", 2.2, False),
    BuiltInMotion("sit", "Sit down", 3.0, False),
    BuiltInMotion("wave", "Wave with the right hand", 3.2, False),
    BuiltInMotion("dance", "Dance: side steps, then with arms up", 4.0, True),
    BuiltInMotion("bow", "Bow", 3.0, False),
)
