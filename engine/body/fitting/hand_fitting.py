"""Fitting a hand of the template, its turn at the wrist and its fingers, to 21 landmarks of a hand that is seen.

Landmarks in the picture say where fingers are. The directions of their bones in space, as perception believes them, say
which way they lean. It is robust least squares, as in `engine.body.fitting.body_fitting`, with what joints of fingers
can do as priors.
"""

from __future__ import annotations

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
from engine.body.fitting.least_squares import levenberg_marquardt
from engine.body.hands import HandModel, finger_landmarks
from engine.geometry.camera import Camera
from engine.geometry.rigging.joint_names import FINGER_NAMES

LANDMARK_SIGMA_HAND_LENGTHS = 0.05
"""How far landmarks are off, usually, in lengths of the hand seen."""
BONE_DIRECTION_SIGMA = 0.25
"""How far the directions of bones in space are off, usually (the difference of unit vectors)."""
SEEN_HAND_SCALE_SIGMA = 0.2
"""Share by which a hand seen is larger or smaller than the template's, usually."""
SHIFT_SIGMA_HAND_LENGTHS = 0.15
"""Lengths of the hand by which it is elsewhere than the body's fit has it, usually."""

PICTURE_TO_WORLD = np.array([1.0, -1.0, 1.0])
"""From pixels, y down, to the world's axes."""
HAND_BONES = tuple(
    (a, b)
    for finger in FINGER_NAMES
    for a, b in zip((0, *finger_landmarks(finger)[:3]), finger_landmarks(finger), strict=True)
)
"""The bones of a hand as pairs of landmarks."""


@dataclass(frozen=True)
class HandAnchor:
    """What a hand hangs on, and who sees it.

    forearm_axes : (3, 3) those of the forearm, as columns, in the world.
    wrist : (3,) where it is in the world, metres.
    hand_rotation : (3, 3) the hand's turn on its forearm, as the body's fit has it.
    camera : it looks along the world's -z, for what is nearer to it is known as depth along that axis.
    """

    forearm_axes: NDArray[np.floating]
    wrist: NDArray[np.floating]
    hand_rotation: NDArray[np.floating]
    camera: Camera


@dataclass(frozen=True)
class HandFit:
    """A hand fitted to its landmarks.

    joints : (N,) of the space, the hand, then its fingers.
    rotations : (N, 3, 3) theirs, each in its parent's axes.
    shift : (2,) pixels, by which the hand seen is beside the body's fit.
    scale : by which it is larger than the template's.
    median_error : of the landmarks, with shift and scale, in lengths of the hand.
    """

    joints: NDArray[np.intp]
    rotations: NDArray[np.float64]
    shift: NDArray[np.float64]
    scale: float
    median_error: float


class _SeenHand:
    """A hand's landmarks before a camera for many parameters at once: turn (3), shift (2), logarithm of the scale, then the
    angles of `ArticulatedHand`."""

    def __init__(self, model: HandModel, coefficients: NDArray[np.floating], anchor: HandAnchor):
        self.articulated = ArticulatedHand(model, coefficients, anchor.forearm_axes)
        self.anchor = anchor

    def __call__(self, parameters: NDArray[np.float64]) -> NDArray[np.float64]:
        """Landmarks (N, 21, 3) in metres around the wrist, in the world's axes."""
        return self.articulated.places(parameters[:, :3], parameters[:, 6:])

    def pixels(self, parameters: NDArray[np.float64], places: NDArray[np.float64]) -> NDArray[np.float64]:
        """(N, 21, 2) where they are seen, shift and scale included."""
        at = self.anchor.wrist + places * np.exp(parameters[:, 5])[:, None, None]
        return np.asarray(self.anchor.camera.project(at, np.float64)[..., :2] + parameters[:, None, 3:5])


def fit_hand(
    model: HandModel, coefficients: NDArray[np.floating], anchor: HandAnchor, seen: NDArray[np.floating]
) -> HandFit:
    """Fit a hand to what is seen of it.

    `seen` (21, 3): pixels x and y of its landmarks, and by how many each is nearer to the viewer than the wrist.
    """
    hand = _SeenHand(model, coefficients, anchor)
    length = hand_length(seen)
    of_body = Rotation.from_matrix(anchor.hand_rotation).as_rotvec()
    residuals = partial(_residuals, hand, seen, length)
    tried = [levenberg_marquardt(residuals, _start(hand, seen, turn)) for turn in (_turn(hand, seen), of_body)]
    parameters = min(tried, key=lambda found: float((residuals(found[None]) ** 2).sum()))
    off = np.linalg.norm(hand.pixels(parameters[None], hand(parameters[None]))[0] - seen[:, :2], axis=1)
    return HandFit(
        model.joints[TURNED_LANDMARKS],
        hand.articulated.rotations(parameters[None, :3], parameters[None, 6:])[0],
        parameters[3:5],
        float(np.exp(parameters[5])),
        float(np.median(off)) / length,
    )


def openness(seen: NDArray[np.floating]) -> float:
    """How far the most bent of the four fingers of a hand (21, 3) reaches across the view, as a share of its length: near one
    where all are stretched and seen whole."""
    reach = []
    for finger in FINGER_NAMES[1:]:
        joints = seen[finger_landmarks(finger)]
        length = np.linalg.norm(np.diff(joints, axis=0), axis=1).sum()
        reach.append(np.linalg.norm(joints[-1, :2] - joints[0, :2]) / max(float(length), 1e-6))
    return float(min(reach))


def fingers_apart(seen: NDArray[np.floating]) -> float:
    """The least distance of neighbouring fingertips of a hand (21, 2 or more) in the picture, in lengths of the hand."""
    tips = seen[[finger_landmarks(finger)[3] for finger in FINGER_NAMES], :2]
    return float(np.linalg.norm(np.diff(tips, axis=0), axis=1).min()) / hand_length(seen)


def hand_length(points: NDArray[np.floating]) -> float:
    """For landmarks (21, 2 or more): pixels from the wrist along the middle finger, or across the palm if that is longer: the hand's length as seen."""
    points = points[:, :2]
    finger = points[[0, *finger_landmarks("Middle")]]
    across = float(np.linalg.norm(points[finger_landmarks("Index")[0]] - points[finger_landmarks("Pinky")[0]]))
    return max(float(np.linalg.norm(np.diff(finger, axis=0), axis=1).sum()), 2 * across, 1.0)


def _start(hand: _SeenHand, seen: NDArray[np.floating], turn: NDArray[np.floating]) -> NDArray[np.float64]:
    """Parameters with which to begin: a straight hand, its wrist where it is seen, turned (3,)."""
    parameters = np.zeros(6 + HAND_ANGLE_COUNT)
    parameters[:3] = turn
    placed = hand.pixels(parameters[None], hand(parameters[None]))[0]
    parameters[3:5] = seen[0, :2] - placed[0]
    return parameters


def _turn(hand: _SeenHand, seen: NDArray[np.floating]) -> NDArray[np.float64]:
    """The hand's turn by which its palm lies as the one seen in space."""
    palm = [finger_landmarks(finger)[0] for finger in FINGER_NAMES[1:]]
    turn, _ = Rotation.align_vectors(
        (seen[palm] - seen[0]) * PICTURE_TO_WORLD @ hand.anchor.forearm_axes, hand.articulated.rest[palm]
    )
    return np.asarray(turn.as_rotvec())


def _residuals(
    hand: _SeenHand, seen: NDArray[np.floating], length: float, parameters: NDArray[np.float64]
) -> NDArray[np.float64]:
    """(N, R): what is to be small, in standard deviations."""
    places = hand(parameters)
    off = (hand.pixels(parameters, places) - seen[:, :2]) / (LANDMARK_SIGMA_HAND_LENGTHS * length)
    starts, ends = np.array(HAND_BONES).T
    bones = (
        _unit(places[:, ends] - places[:, starts]) - _unit((seen[ends] - seen[starts]) * PICTURE_TO_WORLD)
    ) / BONE_DIRECTION_SIGMA
    count = len(parameters)
    return np.concatenate(
        [
            robust(off).reshape(count, -1),
            robust(bones).reshape(count, -1),
            parameters[:, :3] / WRIST_SIGMA,
            parameters[:, 3:5] / (SHIFT_SIGMA_HAND_LENGTHS * length),
            parameters[:, 5:6] / SEEN_HAND_SCALE_SIGMA,
            finger_priors(parameters[:, 6:]),
        ],
        axis=1,
    )


def _unit(vectors: NDArray[np.floating]) -> NDArray[np.float64]:
    return np.asarray(vectors / np.maximum(np.linalg.norm(vectors, axis=-1, keepdims=True), 1e-9))
