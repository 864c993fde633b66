"""Joints placed by hand: which there are, and what cannot be somebody's skeleton."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Mapping

import numpy as np
from numpy.typing import NDArray

from engine.errors import InputError
from engine.perception.body import BODY_LANDMARKS

PLACED = tuple(name for name in BODY_LANDMARKS if not name.endswith(("Inner", "Outer")))
"""The joints that can be placed by hand."""
WHOLE_SKELETON = tuple(
    f"{side}{joint}" for side in ("Left", "Right") for joint in ("Shoulder", "Elbow", "Wrist", "Hip", "Knee", "Ankle")
)
"""What must be placed where nobody is found."""
OUTSIDE = 0.25
"""How far outside the picture a joint may be, as a share of its sides."""
STRAIGHT = 0.03
"""How much less than along them joints must spread across, to be taken for a line: somebody seen from the side has twice as
much."""
NO_TRUNK = 0.05
"""Size of a trunk that is none, as a share of the skeleton's."""
LONG = 2.5
"""Lengths of the trunk from which a limb, of which a person's have 0.9, is doubted; drawn ones may be long."""
BONES = tuple(
    (f"{side}{a}", f"{side}{b}")
    for side in ("Left", "Right")
    for a, b in (("Shoulder", "Elbow"), ("Elbow", "Wrist"), ("Hip", "Knee"), ("Knee", "Ankle"))
)


PLAIN = {"Index": "index finger", "Pinky": "little finger", "FootIndex": "toes", "Mouth": "mouth corner"}
"""What plain words call otherwise than the landmarks' names do."""


def in_words(names: Iterable[str]) -> str:
    """Landmarks as a sentence names them, a pair of them once: "both shoulders, the left wrist"."""
    told: dict[str, list[str]] = {}
    for name in names:
        side = next((side for side in ("Left", "Right") if side in name), "")
        part = name.replace(side, "", 1)
        part = PLAIN.get(part) or re.sub(r"(?<!^)(?=[A-Z])", " ", part).lower()
        told.setdefault(part, []).append(side.lower())
    return ", ".join(_one_or_both(part, sides) for part, sides in told.items())


def _one_or_both(part: str, sides: list[str]) -> str:
    if set(sides) == {"left", "right"}:
        return f"both {part}" if part.endswith("s") else f"both {part}s"
    return f"the {sides[0]} {part}" if sides[0] else f"the {part}"


def check_places(joints: Mapping[str, tuple[float, float]], shape: tuple[int, int]) -> None:
    """Look at the names and places of joints, pixels of a picture of `shape` (H, W).

    Raises
    ------
    InputError : `unknown_joint`, `joint_outside`.
    """
    height, width = shape
    for name, (x, y) in joints.items():
        if name not in PLACED:
            raise InputError(
                "unknown_joint", f"There is no joint “{name[:40]}”: choose of {', '.join(PLACED)}.", ("joints",)
            )
        if not (-OUTSIDE * width <= x <= (1 + OUTSIDE) * width and -OUTSIDE * height <= y <= (1 + OUTSIDE) * height):
            raise InputError(
                "joint_outside",
                f"For {in_words([name])} a place far outside the picture is given: choose one within {width} x {height}.",
                ("joints",),
            )


def check_skeleton(points: NDArray[np.floating], warn: Callable[[str, str], None]) -> None:
    """Look at landmarks (33, 2), some of which were placed by hand.

    Raises
    ------
    InputError : `joints_invalid`. Warns of `joints_out_of_proportion`.
    """
    at = {name: points[BODY_LANDMARKS.index(name)].astype(np.float64) for name in WHOLE_SKELETON}
    places = np.stack(list(at.values()))
    along, across = np.linalg.svd(places - places.mean(0), compute_uv=False)
    if across <= STRAIGHT * along:
        raise InputError(
            "joints_invalid", "The joints lie on one line, or in one place: place each where it is seen.", ("joints",)
        )
    shoulders, hips = ((at[f"Left{joint}"] + at[f"Right{joint}"]) / 2 for joint in ("Shoulder", "Hip"))
    widths = [_between(at[f"Left{joint}"], at[f"Right{joint}"]) for joint in ("Shoulder", "Hip")]
    trunk = max(_between(shoulders, hips), *widths)
    if trunk < NO_TRUNK * float(np.ptp(places, axis=0).max()):
        raise InputError(
            "joints_invalid",
            "Shoulders and hips lie in one place: place them where they are seen.",
            ("joints",),
        )
    bones = {(a, b): _between(at[a], at[b]) / trunk for a, b in BONES}
    (a, b), longest = max(bones.items(), key=lambda bone: bone[1])
    if longest > LONG:
        warn(
            "joints_out_of_proportion",
            f"From {in_words([a])} to {in_words([b])} it is {longest:.1f} times as far as from the shoulders to the hips: see whether all joints are "
            "in their places.",
        )


def _between(one: NDArray[np.float64], other: NDArray[np.float64]) -> float:
    return float(np.linalg.norm(one - other))
