"""The poses in which rigged people are photographed: where their bones point, in the world, by the joint at which each begins."""

from __future__ import annotations

from collections.abc import Mapping

from benchmarks.scan_studio.people.rigged_people import Directions


def _mirrored(directions: Directions) -> Directions:
    """Directions of limbs with left and right exchanged."""
    return {f"Right{name.removeprefix('Left')}": (-x, y, z) for name, (x, y, z) in directions.items()}


_ARM_DOWN: Directions = {"LeftArm": (0.22, -1.0, 0.0), "LeftForeArm": (0.1, -1.0, 0.12), "LeftHand": (0.02, -1.0, 0.1)}
_LEG_STRAIGHT: Directions = {"LeftUpLeg": (0.06, -1.0, 0.0), "LeftLeg": (0.04, -1.0, -0.03)}
_STANDING: Directions = {**_ARM_DOWN, **_mirrored(_ARM_DOWN), **_LEG_STRAIGHT, **_mirrored(_LEG_STRAIGHT)}
_A_ARM: Directions = dict.fromkeys(("LeftArm", "LeftForeArm", "LeftHand"), (0.7, -0.7, 0.05))

POSES: Mapping[str, Directions] = {
    "arms down": _STANDING,
    "A-pose": {**_STANDING, **_A_ARM, **_mirrored(_A_ARM)},
    "hand on hip": {
        **_STANDING,
        **{"LeftArm": (0.75, -0.75, -0.1), "LeftForeArm": (-0.8, -0.5, 0.35), "LeftHand": (-0.8, -0.4, 0.4)},
    },
    "arms crossed": {
        **_STANDING,
        **{"LeftArm": (0.25, -0.85, 0.35), "LeftForeArm": (-0.85, 0.15, 0.45), "LeftHand": (-0.95, 0.2, 0.1)},
        **{"RightArm": (-0.25, -0.9, 0.3), "RightForeArm": (0.9, 0.05, 0.35), "RightHand": (0.95, 0.1, 0.05)},
    },
    "arm raised": {
        **_STANDING,
        **{"RightArm": (-0.55, 0.8, 0.1), "RightForeArm": (-0.15, 1.0, 0.1), "RightHand": (-0.1, 1.0, 0.1)},
    },
    "stride": {
        **_STANDING,
        **{"LeftUpLeg": (0.05, -0.9, 0.42), "LeftLeg": (0.03, -1.0, 0.12)},
        **{"RightUpLeg": (-0.05, -0.93, -0.3), "RightLeg": (-0.03, -0.85, -0.5)},
        **{"LeftArm": (0.2, -0.9, -0.35), "LeftForeArm": (0.1, -1.0, -0.1)},
        **{"RightArm": (-0.2, -0.9, 0.35), "RightForeArm": (-0.1, -0.8, 0.55)},
    },
    "one foot before the other": {
        **_STANDING,
        **{"LeftUpLeg": (-0.1, -1.0, 0.16), "LeftLeg": (-0.1, -1.0, 0.06)},
        **{"RightUpLeg": (0.02, -1.0, -0.1), "RightLeg": (0.02, -1.0, -0.14)},
    },
    "hand in pocket": {
        **_STANDING,
        **{"LeftArm": (0.42, -0.88, -0.18), "LeftForeArm": (-0.28, -0.9, 0.36), "LeftHand": (-0.3, -0.95, 0.15)},
    },
}
