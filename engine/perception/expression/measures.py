"""What is measured of a face in every frame to tell what it shows: a few lengths and the head's angles."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from engine.geometry.registration.rigid import fit_similarities
from engine.perception.expression.features import frontalise
from engine.perception.face.head_pose import canonical_face
from engine.perception.face.landmarks import EYE_CORNER_VERTICES, RIGID_VERTICES, eye_opening

MEASURES = (
    *("mouth_open", "mouth_wide", "right_corner_up", "left_corner_up"),
    *("inner_brows_up", "outer_brows_up", "brows_apart", "right_eye_open", "left_eye_open"),
    *("yaw", "pitch", "roll"),
)
"""Lengths are in eye distances of the face turned to the front; the eyes' opening is over their own width; angles in
radians: `yaw` > 0 turns the face to the picture's right, `pitch` > 0 upwards, `roll` > 0 clockwise as seen."""

MOUTH_MEASURES = slice(0, 4)
"""The measures of the mouth among `MEASURES`."""
LID_MEASURES = slice(7, 9)
"""The measures of the lids among `MEASURES`."""
FACE_MEASURES = slice(0, 9)
"""The measures of the face itself among `MEASURES`, without the head's turn."""

REST_SPREAD = np.array([0.06, 0.10, 0.07, 0.07, 0.04, 0.04, 0.03, 0.08, 0.08, 0.25, 0.20, 0.20])
"""By how much each of `MEASURES` may differ from rest on a face that shows nothing. That is twice to three times what
it varies by while people wait (from the idle performances and the quiet stretches of the clips in
`benchmarks/driver_segments`)."""

SPREAD_BETWEEN_PEOPLE = np.array([0.03, 0.10, 0.04, 0.04, 0.10, 0.08, 0.05, 0.06, 0.06, 0.20, 0.20, 0.20])
"""By how much the measures at rest differ between people."""

SPREAD_BELOW_REST = np.array([0.03, 0.10, 0.04, 0.04, 0.05, 0.05, 0.05, 0.06, 0.06, 0.20, 0.20, 0.20])
"""By how much measures at rest that lie below the general rest differ from it between people. Brows lie higher by much on
some people, and lower by much only where they frown."""

LID_VARIATION = 0.2
"""The share of how far lids are usually open by which they vary while they are."""

CORNER_DROP_PER_OPENING = 0.25
"""The share of the mouth's opening by which the jaw takes the corners down (0.22 to 0.29 in the built-in performances of
surprise, whose corners do nothing of themselves). What is left is their own doing."""


def measure(meshes: NDArray[np.floating]) -> NDArray[np.float32]:
    """`MEASURES` of meshes (N, 478, 3) in pixels: (N, 12)."""
    face = frontalise(meshes)
    nose = face[:, 2, 1]
    mouth_open = np.linalg.norm(face[:, 13] - face[:, 14], axis=1)
    lids = face[:, list(EYE_CORNER_VERTICES), 1].mean(axis=1)
    eyes = eye_opening(meshes)
    return np.column_stack(
        [
            mouth_open,
            np.linalg.norm(face[:, 61] - face[:, 291], axis=1),
            nose - face[:, 61, 1] + CORNER_DROP_PER_OPENING * mouth_open,
            nose - face[:, 291, 1] + CORNER_DROP_PER_OPENING * mouth_open,
            lids - face[:, [107, 336], 1].mean(axis=1),
            lids - face[:, [70, 300], 1].mean(axis=1),
            np.abs(face[:, 55, 0] - face[:, 285, 0]),
            eyes[:, 0],
            eyes[:, 1],
            *_angles(meshes),
        ]
    ).astype(np.float32)


def general_rest() -> NDArray[np.float32]:
    """The measures (12,) of a face at rest that is nobody's in particular."""
    return measure(canonical_face()[None].astype(float))[0]


def lid_lowering(values: NDArray[np.floating], usual: NDArray[np.floating]) -> NDArray[np.float64]:
    """(N,) by which share of how far they are `usual`ly open (2,) the lids of measures (N, 12) are lowered, beyond what these
    vary by."""
    return np.asarray(
        np.clip(1 - LID_VARIATION - values[:, LID_MEASURES] / np.maximum(usual, 1e-3), 0, 1).max(axis=1), float
    )


def _angles(meshes: NDArray[np.floating]) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
    """Yaw, pitch and roll, (N,) each, of the rigid vertices against the canonical face."""
    chosen = list(RIGID_VERTICES)
    _, turn, _ = fit_similarities(canonical_face()[chosen].astype(float), meshes[:, chosen], np.ones(len(chosen)))
    yaw = np.arctan2(-turn[:, 0, 2], turn[:, 2, 2])
    pitch = np.arctan2(turn[:, 1, 2], turn[:, 2, 2])
    return yaw, pitch, np.arctan2(turn[:, 1, 0], turn[:, 0, 0])
