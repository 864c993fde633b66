"""Fitting a hand of the template, its turn at the wrist, its fingers and its size, to landmarks in space."""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from engine.body.fitting.articulated_hand import (
    ANGLES,
    TURNED_LANDMARKS,
    WRIST_SIGMA,
    ArticulatedHand,
    finger_priors,
    robust,
)
from engine.body.fitting.least_squares import levenberg_marquardt
from engine.body.hands import HandModel, finger_landmarks
from engine.geometry.joint_names import FINGERS

LANDMARK_SIGMA = 0.006
"""Metres by which landmarks are off, usually."""
SHIFT_SIGMA = 0.02
"""Metres by which the wrist is elsewhere than the body's fit has it, usually."""
SCALE_SIGMA = 0.15
"""Share by which a hand is larger or smaller than one of that body, usually."""
MIN_LANDMARKS = 12
"""Landmarks with which a hand is known."""
PALM = (0, *(finger_landmarks(finger)[0] for finger in FINGERS[1:]))
"""Landmarks that do not move as fingers bend."""
MIN_PALM = 4
"""Of those, how many have to be known."""


@dataclass(frozen=True)
class HandInSpace:
    """A hand fitted to its landmarks.

    `joints` (16,): of the space, the hand, then its fingers.
    `rotations` (16, 3, 3): theirs, each in its parent's axes.
    `shift` (3,) metres: from where the body's fit has the wrist to where it is.
    `scale`: by which the hand is larger than that of the body's fit.
    `median_error`: of the landmarks, metres.
    """

    joints: NDArray[np.intp]
    rotations: NDArray[np.float64]
    shift: NDArray[np.float64]
    scale: float
    median_error: float


def fit_hand_in_space(
    model: HandModel,
    coefficients: NDArray[np.floating],
    forearm_axes: NDArray[np.floating],
    wrist: NDArray[np.floating],
    landmarks: NDArray[np.floating],
) -> HandInSpace | None:
    """Fit a hand to `landmarks` (21, 3), metres in the world, NaN where unknown; None where too few are known.

    `forearm_axes` (3, 3) are the forearm's axes as columns in the world, `wrist` (3,) where the body's fit has the wrist.
    """
    known = np.isfinite(landmarks).all(1)
    palm = [k for k in PALM if known[k]]
    if known.sum() < MIN_LANDMARKS or len(palm) < MIN_PALM:
        return None
    hand = ArticulatedHand(model, coefficients, forearm_axes)
    seen = np.asarray(landmarks[known] - wrist, np.float64)
    start = np.zeros(7 + ANGLES)
    middle = landmarks[palm].mean(0)
    turn, _ = Rotation.align_vectors(
        (landmarks[palm] - middle) @ forearm_axes, hand.rest[palm] - hand.rest[palm].mean(0)
    )
    start[:3] = turn.as_rotvec()
    placed = hand.places(start[None, :3], start[None, 7:])[0, palm]
    start[3:6] = middle - wrist - placed.mean(0)
    found = levenberg_marquardt(partial(_residuals, hand, seen, known), start)[None]
    off = np.linalg.norm(_places(hand, found)[0, known] - seen, axis=1)
    return HandInSpace(
        model.joints[TURNED_LANDMARKS],
        hand.rotations(found[:, :3], found[:, 7:])[0],
        found[0, 3:6],
        float(np.exp(found[0, 6])),
        float(np.median(off)),
    )


def _places(hand: ArticulatedHand, parameters: NDArray[np.float64]) -> NDArray[np.float64]:
    """(N, 21, 3) metres from the body's wrist, for turn (3), shift (3), logarithm of the scale, and angles."""
    scale = np.exp(parameters[:, 6])[:, None, None]
    return parameters[:, None, 3:6] + scale * hand.places(parameters[:, :3], parameters[:, 7:])


def _residuals(
    hand: ArticulatedHand, seen: NDArray[np.float64], known: NDArray[np.bool_], parameters: NDArray[np.float64]
) -> NDArray[np.float64]:
    """(N, R): what is to be small, in standard deviations."""
    off = robust((_places(hand, parameters)[:, known] - seen) / LANDMARK_SIGMA)
    return np.concatenate(
        [
            off.reshape(len(parameters), -1),
            parameters[:, :3] / WRIST_SIGMA,
            parameters[:, 3:6] / SHIFT_SIGMA,
            parameters[:, 6:7] / SCALE_SIGMA,
            finger_priors(parameters[:, 7:]),
        ],
        axis=1,
    )
