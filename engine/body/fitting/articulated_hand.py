"""A hand of the template that turns at its wrist and bends its fingers, and what joints of hands can do."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from engine.body.fitting.pose_prior import JOINT_LIMIT_SIGMA
from engine.body.fitting.posing import rotation_matrices
from engine.body.hands import HandModel, finger_landmarks
from engine.geometry.rigging.joint_names import FINGER_NAMES

WRIST_SIGMA = (1.0, 0.5, 0.7)
"""Radians about x, y and z of the T-pose by which hands turn on their arms, usually: the forearm turns with them about x."""
THUMB_SIGMA = (*(0.4, 0.4, 0.4), *(0.4, 0.5))
"""Radians by which the thumb turns at its root, and bends at its other joints, usually."""
FINGER_SIGMA = (0.12, 0.6, 0.7)
"""Radians by which a finger is spread, and bends at its first and second joint, usually."""
CURL_RATIO = 0.6
"""How much the last joint of a finger bends for what the one before it does: one tendon bends both."""
CURL_SIGMA = 0.3
"""Radians by which the last joint of a finger usually bends otherwise than by `CURL_RATIO`."""
MIN_ANGLES_RADIANS = np.array([*(-0.8, -0.8, -0.8), *(-0.4, -0.5), *(4 * (-0.35, -0.6, -0.3, -0.4))])
"""Radians to which joints turn at least, from the hand at rest, in which fingers are bent a little."""
MAX_ANGLES_RADIANS = np.array([*(0.8, 0.8, 0.8), *(1.0, 1.3), *(4 * (0.35, 1.6, 1.9, 1.4))])
"""Radians to which joints turn at most, from the hand at rest."""

STRONGEST_PULL_SIGMAS = 3.0
"""Deviations at which the pull of a landmark, or of a bone's direction, is at its strongest (Geman-McClure)."""

HAND_ANGLE_COUNT = 5 + 4 * 4
"""Angles of a hand: the thumb's root (3) and two bends, for each other finger spread and three bends."""
TURNED_LANDMARKS = [0, *(landmark for finger in FINGER_NAMES for landmark in finger_landmarks(finger)[:3])]
"""The landmarks that are joints which turn: the wrist, then those 1 to 3 of each finger."""


class ArticulatedHand:
    """The landmarks of a hand on its forearm, whose axes (3, 3) are columns in the world, for N turns and angles at once."""

    def __init__(self, model: HandModel, coefficients: NDArray[np.floating], forearm_axes: NDArray[np.floating]):
        self.model, self.forearm_axes = model, forearm_axes
        rest = model.mean + np.tensordot(np.asarray(coefficients), model.basis[: len(coefficients)], 1)
        self.rest = (rest - rest[0]).astype(np.float64)

    def rotations(self, wrist_vectors: NDArray[np.float64], angles: NDArray[np.float64]) -> NDArray[np.float64]:
        """(N, 16, 3, 3) the hand's turn (N, 3), a rotation vector in the forearm's axes, and for its angles (N,
        `HAND_ANGLE_COUNT`) those of the joints 1 to 3 of each finger, each in its parent's axes."""
        vectors = np.zeros((len(wrist_vectors), 16, 3))
        thumb, others = angles[:, :5], angles[:, 5:].reshape(-1, 4, 4)
        vectors[:, 1] = thumb[:, :3]
        vectors[:, 2], vectors[:, 3] = (thumb[:, [k]] * self.model.bend[0] for k in (3, 4))
        spreads = np.zeros((len(wrist_vectors), 4, 3))
        for finger in range(4):
            spreads[:, finger] = others[:, finger, :1] * self.model.spread
            for joint in range(3):
                vectors[:, 4 + 3 * finger + joint] = others[:, finger, [1 + joint]] * self.model.bend[1 + finger]
        found = rotation_matrices(vectors)
        found[:, 4::3] = rotation_matrices(spreads) @ found[:, 4::3]
        found[:, 0] = rotation_matrices(wrist_vectors)
        return found

    def places(self, wrist_vectors: NDArray[np.float64], angles: NDArray[np.float64]) -> NDArray[np.float64]:
        """Landmarks (N, 21, 3) in metres around the wrist, in the world's axes."""
        rotations = self.rotations(wrist_vectors, angles)
        hand = self.forearm_axes @ rotations[:, 0]
        places = np.zeros((len(wrist_vectors), 21, 3))
        for k, finger in enumerate(FINGER_NAMES):
            axes, before = hand, 0
            for joint, landmark in enumerate(finger_landmarks(finger)):
                step = self.rest[landmark] - self.rest[before]
                places[:, landmark] = places[:, before] + np.einsum("nij,j->ni", axes, step)
                if joint < 3:
                    axes = axes @ rotations[:, 1 + 3 * k + joint]
                before = landmark
        return places


def finger_priors(angles: NDArray[np.float64]) -> NDArray[np.float64]:
    """(N, R) how far angles (N, `HAND_ANGLE_COUNT`) are from what fingers usually do, in standard deviations."""
    fingers = angles[:, 5:].reshape(-1, 4, 4)
    count = len(angles)
    return np.concatenate(
        [
            angles[:, :5] / THUMB_SIGMA,
            (fingers[..., :3] / FINGER_SIGMA).reshape(count, -1),
            (fingers[..., 3] - CURL_RATIO * fingers[..., 2]) / CURL_SIGMA,
            (np.maximum(angles - MAX_ANGLES_RADIANS, 0) + np.maximum(MIN_ANGLES_RADIANS - angles, 0))
            / JOINT_LIMIT_SIGMA,
        ],
        axis=1,
    )


def robust(off: NDArray[np.float64]) -> NDArray[np.float64]:
    """Deviations (..., D) of which large ones pull less and less."""
    return np.asarray(off / np.sqrt(1 + (off**2).sum(-1, keepdims=True) / STRONGEST_PULL_SIGMAS**2))
