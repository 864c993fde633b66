"""Ways of standing, and of not standing, that the method can do little with: said before anything is made."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from engine.errors import InputError
from engine.perception.pose.body import BODY_LANDMARKS

MAX_TRUNK_LEAN_DEGREES = 55.0
"""Degrees by which the trunk may lean in the picture."""
MIN_SEATED_THIGH_DEGREES = 45.0
"""Degrees between both thighs and the vertical, from which somebody sits. Perception says too little rather than too
much: it finds 60 to 80 where thighs are level."""
OVERHEAD_SHOULDER_WIDTHS = 0.5
"""Distance of joined hands above the nose, and at most between them, in widths of the shoulders."""


def check_posture(
    points: NDArray[np.float32], world: NDArray[np.float32] | None, legs: bool, warn: Callable[[str, str], None]
) -> None:
    """Look at landmarks, (33, 2) in pixels and (33, 3) in space, if known; `legs`: whether those of the legs are seen, not
    guessed.

    Raises
    ------
    InputError : `person_lying`. Warns of `person_seated`, `person_from_behind`, `hands_overhead`.
    """

    def at(name: str) -> NDArray[np.float32]:
        return points[BODY_LANDMARKS.index(name)]

    shoulders, hips = ((at(f"Left{joint}") + at(f"Right{joint}")) / 2 for joint in ("Shoulder", "Hip"))
    lean = np.degrees(np.arctan2(abs(hips[0] - shoulders[0]), hips[1] - shoulders[1]))
    if lean > MAX_TRUNK_LEAN_DEGREES:
        raise InputError(
            "person_lying",
            f"The person lies, or stands on the head (the trunk leans by {lean:.0f} degrees): turn the picture so that the "
            "head is up.",
            ("joints",),
        )
    if world is None:
        return
    if at("LeftShoulder")[0] < at("RightShoulder")[0]:
        warn("person_from_behind", "The person seems to be seen from behind: front and back are taken from the back.")
    if legs and min(_from_vertical(world, side) for side in ("Left", "Right")) > MIN_SEATED_THIGH_DEGREES:
        warn("person_seated", "The person seems to sit: legs that point at the viewer are reconstructed badly.")
    width = float(np.linalg.norm(at("LeftShoulder") - at("RightShoulder")))
    wrists = at("LeftWrist"), at("RightWrist")
    if (
        max(wrist[1] for wrist in wrists) < at("Nose")[1] - OVERHEAD_SHOULDER_WIDTHS * width
        and np.linalg.norm(wrists[0] - wrists[1]) < OVERHEAD_SHOULDER_WIDTHS * width
    ):
        warn("hands_overhead", "The hands are joined above the head: they may stay together when the arms come down.")


def _from_vertical(world: NDArray[np.float32], side: str) -> float:
    """Degrees between a thigh and the vertical."""
    thigh = world[BODY_LANDMARKS.index(f"{side}Knee")] - world[BODY_LANDMARKS.index(f"{side}Hip")]
    return float(np.degrees(np.arccos(np.clip(-thigh[1] / max(float(np.linalg.norm(thigh)), 1e-6), -1, 1))))
