"""What poses people take: how far their joints turn, and cannot turn.

The priors of F. Bogo et al., Keep it SMPL, ECCV 2016 (their 3.2), as independent normal distributions about a usual pose.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from engine.body.fitting.posing import FITTED_JOINTS

JOINT_SIGMA = {
    "Spine": (0.25, 0.2, 0.15),
    "Spine1": (0.25, 0.2, 0.15),
    "Spine2": (0.25, 0.2, 0.15),
    "Neck": (0.15, 0.4, 0.25),
    "Head": (0.3, 0.4, 0.25),
    "Shoulder": (0.1, 0.2, 0.2),
    "Arm": (0.8, 1.5, 1.5),
    "ForeArm": (0.6, 1.2, 0.15),
    "Hand": (0.3, 0.4, 0.4),
    "UpLeg": (0.5, 0.4, 0.4),
    "Leg": (0.6, 0.1, 0.1),
    "Foot": (0.4, 0.2, 0.2),
}
"""Radians by which joints turn about x, y and z, usually: their prior's standard deviation."""

JOINT_LIMIT_SIGMA = 0.05
"""Radians beyond a joint's limit that weigh as much as one standard deviation."""

MEAN_LOWERED_ARMS_RADIANS = 0.8
"""Radians by which arms hang lower than in T-pose, in the mean."""


def pose_prior(rotation_vectors: NDArray[np.float64]) -> NDArray[np.float64]:
    """Rotation vectors (N, T, 3) of `FITTED_JOINTS` in standard deviations, (N, 3 (T - 1)): arms rest half lowered, and the
    hips turn as they like."""
    sigma = np.array([JOINT_SIGMA[_kind(name)] for name in FITTED_JOINTS[1:]])
    mean = np.zeros_like(sigma)
    for side, sign in (("Left", -1), ("Right", 1)):
        mean[FITTED_JOINTS.index(f"{side}Arm") - 1, 2] = sign * MEAN_LOWERED_ARMS_RADIANS
    return np.asarray(((rotation_vectors[:, 1:] - mean) / sigma).reshape(len(rotation_vectors), -1))


def joint_limits(rotation_vectors: NDArray[np.float64]) -> NDArray[np.float64]:
    """How far elbows and knees are bent the wrong way, legs stretched behind, and necks and heads twisted beyond what they
    can, (N, 8) in standard deviations, for rotation vectors (N, T, 3)."""
    at = FITTED_JOINTS.index
    wrong = [
        rotation_vectors[:, at("LeftForeArm"), 1],
        -rotation_vectors[:, at("RightForeArm"), 1],
        -rotation_vectors[:, at("LeftLeg"), 0],
        -rotation_vectors[:, at("RightLeg"), 0],
        rotation_vectors[:, at("LeftUpLeg"), 0] - 0.15,
        rotation_vectors[:, at("RightUpLeg"), 0] - 0.15,
        np.abs(rotation_vectors[:, at("Neck"), 1] + rotation_vectors[:, at("Head"), 1]) - 1.4,
        np.abs(rotation_vectors[:, at("Neck"), 0] + rotation_vectors[:, at("Head"), 0]) - 1.0,
    ]
    return np.asarray(np.maximum(np.stack(wrong, 1), 0) / JOINT_LIMIT_SIGMA)


def _kind(name: str) -> str:
    return name.removeprefix("Left").removeprefix("Right")
