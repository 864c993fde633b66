"""Joints placed by hand: which there are, and what cannot be somebody's skeleton."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Mapping

import numpy as np
from numpy.typing import NDArray

from engine.errors import InputError
from engine.perception.pose.body import BODY_LANDMARKS

PLACEABLE_JOINTS = tuple(name for name in BODY_LANDMARKS if not name.endswith(("Inner", "Outer")))
"""The joints that can be placed by hand."""
REQUIRED_PLACED_JOINTS = tuple(
    f"{side}{joint}" for side in ("Left", "Right") for joint in ("Shoulder", "Elbow", "Wrist", "Hip", "Knee", "Ankle")
)
"""What must be placed where nobody is found."""
MAX_OUTSIDE_SHARE = 0.25
"""How far outside the picture a joint may be, as a share of its sides."""
MIN_SPREAD_RATIO = 0.03
"""How much less than along them joints must spread across, to be taken for a line: somebody seen from the side has twice as
much."""
MIN_TRUNK_SKELETON_SHARE = 0.05
"""Size of a trunk that is none, as a share of the skeleton's."""
MAX_LIMB_TRUNK_LENGTHS = 2.5
"""Lengths of the trunk from which a limb, of which a person's have 0.9, is doubted; drawn ones may be long."""
BONE_JOINTS = tuple(
    (f"{side}{a}", f"{side}{b}")
    for side in ("Left", "Right")
    for a, b in (("Shoulder", "Elbow"), ("Elbow", "Wrist"), ("Hip", "Knee"), ("Knee", "Ankle"))
)


PLAIN_JOINT_NAMES = {"Index": "index finger", "Pinky": "little finger", "FootIndex": "toes", "Mouth": "mouth corner"}
"""What plain words call otherwise than the landmarks' names do."""


def in_words(names: Iterable[str]) -> str:
    """Landmarks as a sentence names them, a pair of them once: "both shoulders, the left wrist"."""
    told: dict[str, list[str]] = {}
    for name in names:
        side = next((side for side in ("Left", "Right") if side in name), "")
        part = name.replace(side, "", 1)
        part = PLAIN_JOINT_NAMES.get(part) or re.sub(r"(?<!^)(?=[A-Z])", " ", part).lower()
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
        if name not in PLACEABLE_JOINTS:
            raise InputError(
                "unknown_joint",
                f"There is no joint “{name[:40]}”: choose of {', '.join(PLACEABLE_JOINTS)}.",
                ("joints",),
            )
        if not (
            -MAX_OUTSIDE_SHARE * width <= x <= (1 + MAX_OUTSIDE_SHARE) * width
            and -MAX_OUTSIDE_SHARE * height <= y <= (1 + MAX_OUTSIDE_SHARE) * height
        ):
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
    at = {name: points[BODY_LANDMARKS.index(name)].astype(np.float64) for name in REQUIRED_PLACED_JOINTS}
    places = np.stack(list(at.values()))
    along, across = np.linalg.svd(places - places.mean(0), compute_uv=False)
    if across <= MIN_SPREAD_RATIO * along:
        raise InputError(
            "joints_invalid", "The joints lie on one line, or in one place: place each where it is seen.", ("joints",)
        )
    shoulders, hips = ((at[f"Left{joint}"] + at[f"Right{joint}"]) / 2 for joint in ("Shoulder", "Hip"))
    widths = [_between(at[f"Left{joint}"], at[f"Right{joint}"]) for joint in ("Shoulder", "Hip")]
    trunk = max(_between(shoulders, hips), *widths)
    if trunk < MIN_TRUNK_SKELETON_SHARE * float(np.ptp(places, axis=0).max()):
        raise InputError(
            "joints_invalid",
            "Shoulders and hips lie in one place: place them where they are seen.",
            ("joints",),
        )
    bones = {(a, b): _between(at[a], at[b]) / trunk for a, b in BONE_JOINTS}
    (a, b), longest = max(bones.items(), key=lambda bone: bone[1])
    if longest > MAX_LIMB_TRUNK_LENGTHS:
        warn(
            "joints_out_of_proportion",
            f"From {in_words([a])} to {in_words([b])} it is {longest:.1f} times as far as from the shoulders to the hips: see whether all joints are "
            "in their places.",
        )


def _between(one: NDArray[np.float64], other: NDArray[np.float64]) -> float:
    return float(np.linalg.norm(one - other))
