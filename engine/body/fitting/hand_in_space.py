"""Fitting a hand of the template, its turn at the wrist, its fingers and its size, to landmarks in space."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from engine.body.fitting.articulated_hand import (
    HAND_ANGLE_COUNT,
    TURNED_LANDMARKS,
    WRIST_SIGMA,
    ArticulatedHand,
    finger_priors,
    robust,
)
from engine.body.fitting.hand_on_points import HAND_GATES_METRES, HandSkin, PointsOfHand
from engine.body.fitting.least_squares import levenberg_marquardt
from engine.body.hands import HandModel, finger_landmarks
from engine.geometry.rigging.joint_names import FINGER_NAMES

HAND_LANDMARK_SIGMA_METRES = 0.006
"""Metres by which landmarks are off, usually."""
SHIFT_SIGMA_METRES = 0.02
"""Metres by which the wrist is elsewhere than the body's fit has it, usually."""
OWN_HAND_SCALE_SIGMA = 0.15
"""Share by which a hand is larger or smaller than one of that body, usually."""
STEPS_OF_ROUND = 4
"""Steps of the search until other points of the cloud are the nearest."""
MAX_MEDIAN_ERROR_METRES = 0.015
"""Metres by which landmarks are off in the median: beyond, they are not those of a hand."""
MIN_HAND_LANDMARKS = 12
"""Landmarks with which a hand is known."""
RIGID_PALM_LANDMARKS = (0, *(finger_landmarks(finger)[0] for finger in FINGER_NAMES[1:]))
"""Landmarks that do not move as fingers bend."""
MIN_PALM = 4
"""How many of `RIGID_PALM_LANDMARKS` have to be known."""


@dataclass(frozen=True)
class HandInSpace:
    """A hand fitted to its landmarks.

    joints : (16,) of the space, the hand, then its fingers.
    rotations : (16, 3, 3) theirs, each in its parent's axes.
    shift : (3,) metres, from where the body's fit has the wrist to where it is.
    scale : by which the hand is larger than that of the body's fit.
    """

    joints: NDArray[np.intp]
    rotations: NDArray[np.float64]
    shift: NDArray[np.float64]
    scale: float


def fit_hand_in_space(
    model: HandModel,
    coefficients: NDArray[np.floating],
    forearm_axes: NDArray[np.floating],
    wrist: NDArray[np.floating],
    landmarks: NDArray[np.floating],
    skin: HandSkin | None = None,
) -> HandInSpace | None:
    """Fit a hand to `landmarks` (21, 3), metres in the world, NaN where unknown. With a `skin` it is fitted to a cloud,
    too. None where too few landmarks are known or agree.

    `forearm_axes` (3, 3) are the forearm's axes as columns in the world, `wrist` (3,) where the body's fit has the wrist.
    """
    hand = ArticulatedHand(model, coefficients, forearm_axes)
    seen = np.asarray(landmarks - wrist, np.float64)
    found, off = _by_landmarks(hand, seen)
    if not off < MAX_MEDIAN_ERROR_METRES:
        return None
    if skin is not None:
        found = _on_points(partial(skin.posed, hand, wrist), partial(_residuals, hand, seen), skin, found)
    found = found[None]
    return HandInSpace(
        model.joints[TURNED_LANDMARKS],
        hand.rotations(found[:, :3], found[:, 7:])[0],
        found[0, 3:6],
        float(np.exp(found[0, 6])),
    )


def _by_landmarks(hand: ArticulatedHand, seen: NDArray[np.float64]) -> tuple[NDArray[np.float64], float]:
    """The parameters (P,) by the landmarks that are `seen` (21, 3) around the wrist, and metres by which these are off in the median:
    NaN where they are too few."""
    known = np.asarray(np.isfinite(seen).all(1))
    palm = [k for k in RIGID_PALM_LANDMARKS if known[k]]
    start = np.zeros(7 + HAND_ANGLE_COUNT)
    if known.sum() < MIN_HAND_LANDMARKS or len(palm) < MIN_PALM:
        return start, np.nan
    middle = seen[palm].mean(0)
    turn, _ = Rotation.align_vectors(
        (seen[palm] - middle) @ hand.forearm_axes, hand.rest[palm] - hand.rest[palm].mean(0)
    )
    start[:3] = turn.as_rotvec()
    placed = hand.places(start[None, :3], start[None, 7:])[0, palm]
    start[3:6] = middle - placed.mean(0)
    found = levenberg_marquardt(partial(_residuals, hand, seen), start)
    return found, float(np.median(np.linalg.norm(_places(hand, found[None])[0, known] - seen[known], axis=1)))


def _on_points(
    posed: Callable[[NDArray[np.float64]], NDArray[np.float64]],
    by_landmarks: Callable[[NDArray[np.float64]], NDArray[np.float64]],
    skin: HandSkin,
    parameters: NDArray[np.float64],
) -> NDArray[np.float64]:
    """The parameters (P,) for which the hand is near the points of the cloud as well."""
    for gate in HAND_GATES_METRES:
        points = skin.matched(posed(parameters[None])[0], gate)
        if points is None:
            break

        def both(tried: NDArray[np.float64], points: PointsOfHand = points) -> NDArray[np.float64]:
            return np.concatenate([by_landmarks(tried), points.residuals(posed(tried))], axis=1)

        parameters = levenberg_marquardt(both, parameters, STEPS_OF_ROUND)
    return parameters


def _places(hand: ArticulatedHand, parameters: NDArray[np.float64]) -> NDArray[np.float64]:
    """(N, 21, 3) metres from the body's wrist, for turn (3), shift (3), logarithm of the scale, and angles."""
    scale = np.exp(parameters[:, 6])[:, None, None]
    return parameters[:, None, 3:6] + scale * hand.places(parameters[:, :3], parameters[:, 7:])


def _residuals(
    hand: ArticulatedHand, seen: NDArray[np.float64], parameters: NDArray[np.float64]
) -> NDArray[np.float64]:
    """(N, R): what is to be small, in standard deviations; landmarks that are not `seen` (21, 3), NaN, say nothing."""
    known = np.isfinite(seen).all(1)
    off = robust((_places(hand, parameters)[:, known] - seen[known]) / HAND_LANDMARK_SIGMA_METRES)
    return np.concatenate(
        [
            off.reshape(len(parameters), -1),
            parameters[:, :3] / WRIST_SIGMA,
            parameters[:, 3:6] / SHIFT_SIGMA_METRES,
            parameters[:, 6:7] / OWN_HAND_SCALE_SIGMA,
            finger_priors(parameters[:, 7:]),
        ],
        axis=1,
    )
