"""Words that joints' names are put together from, as Mixamo has them: `LeftHandThumb1`."""

from __future__ import annotations

from typing import Literal

Side = Literal["Left", "Right"]
SIDE_NAMES: tuple[Side, Side] = ("Left", "Right")
"""The person's own."""
FINGER_NAMES = ("Thumb", "Index", "Middle", "Ring", "Pinky")
