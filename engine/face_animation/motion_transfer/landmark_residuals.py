"""By how much the landmarks tracked on a drawn face miss where they were put (see `tracking_refinement`), and what is
done about it."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

import numpy as np
from numpy.typing import NDArray

from engine.face_animation.motion_transfer.lids_and_lips import (
    INNER_LIP_PAIRS,
    LID_EDGE_VERTEX_PAIRS,
    LID_SKIN_VERTEX_PAIRS,
)
from engine.perception.face.head_pose import canonical_face
from engine.perception.face.landmarks import (
    LEFT_EYE,
    LEFT_IRIS,
    LIPS_INNER,
    LIPS_OUTER,
    MESH_SIZE,
    RIGHT_EYE,
    RIGHT_IRIS,
    eye_centres,
    eye_distance,
)
from engine.perception.face_track.face_crop import CROP_EYE_DISTANCE_PIXELS

CORRECTED_SHARE = 0.6
"""Share of a residual that is corrected; the rest is the tracker's own scatter."""
CORRECTED_SHARE_AT_LIPS = 0.35
"""Share of a residual that is corrected at the lips, whose looks change most."""
LIPS_FALLOFF_EYE_DISTANCES = 0.15
"""Eye distances from the lips over which the share of a residual that is corrected rises to `CORRECTED_SHARE`, as a
Gaussian."""
KERNEL_WIDTH_EYE_DISTANCES = 0.05
"""Root mean square distance of two faces' points, in eye distances, at which the frames are alike."""
REGRESSION_RIDGE = 0.2
"""Ridge of the regression: the tracker's scatter."""
MAX_RESIDUAL_EYE_DISTANCES = 0.08
"""Eye distances; what is more, is the tracker's error."""
INDEPENDENT_GAP_EYE_DISTANCES = 0.08
"""Eye distances between two lips or lids from which each is corrected by itself; closed ones move as one."""


@dataclass(frozen=True)
class LandmarkResiduals:
    """The residuals of the frames that were looked at, as a kernel ridge regression.

    faces : (K, 956) float32, the driver's face on them.
    weights : (K, 956) float32.

    Both are in eye distances, upright.
    """

    faces: NDArray[np.float32]
    weights: NDArray[np.float32]

    def corrections(self, faces: NDArray[np.floating], placed: NDArray[np.floating]) -> NDArray[np.float32]:
        """What corrects the points of some frames: (N, 478, 2) offsets, pixels of the target.

        Parameters
        ----------
        faces : (N, 478, 2) the driver's face in its crop. placed : (N, 478, 2) the target's points as they were carried.
        """
        measured = (_likeness(flatten_residuals(faces), self.faces) @ self.weights).reshape(-1, MESH_SIZE, 2)
        right_eye, left_eye = eye_centres(placed)
        right = (left_eye - right_eye)[:, None]  # one eye distance
        down = right[..., ::-1] * (-1, 1)
        return _keep_closed(-_shares() * (measured[..., :1] * right + measured[..., 1:] * down), placed)


def fit_residuals(faces: NDArray[np.floating], measured: NDArray[np.floating]) -> LandmarkResiduals:
    """From the residuals `measured` (K, 478, 2) of frames of the driver with these `faces` (K, 478, 2), pixels of its crop."""
    known = flatten_residuals(faces)
    size = np.linalg.norm(measured, axis=2, keepdims=True) / CROP_EYE_DISTANCE_PIXELS
    believed = flatten_residuals(measured * np.minimum(1, MAX_RESIDUAL_EYE_DISTANCES / np.maximum(size, 1e-6)))
    weights = np.linalg.solve(_likeness(known, known) + REGRESSION_RIDGE * np.eye(len(known)), believed)
    return LandmarkResiduals(known, weights.astype(np.float32))


def no_residuals() -> LandmarkResiduals:
    """No residual anywhere."""
    return LandmarkResiduals(np.zeros((0, 2 * MESH_SIZE), np.float32), np.zeros((0, 2 * MESH_SIZE), np.float32))


def flatten_residuals(faces: NDArray[np.floating]) -> NDArray[np.float32]:
    """(K, 478, 2) pixels of the crop as (K, 956) eye distances."""
    return np.asarray(faces.reshape(len(faces), -1) / CROP_EYE_DISTANCE_PIXELS, np.float32)


@cache
def _shares() -> NDArray[np.float32]:
    """(478, 1) share of its residual that is corrected at each vertex."""
    face = canonical_face()
    apart = np.linalg.norm(face[:, None] - face[list(LIPS_OUTER + LIPS_INNER)], axis=2).min(axis=1, keepdims=True)
    return np.asarray(
        CORRECTED_SHARE
        + (CORRECTED_SHARE_AT_LIPS - CORRECTED_SHARE) * np.exp(-((apart / LIPS_FALLOFF_EYE_DISTANCES) ** 2)),
        np.float32,
    )


def _likeness(a: NDArray[np.float32], b: NDArray[np.float32]) -> NDArray[np.float32]:
    """(N, K) from 0 to 1 for the same face, between faces (N, 956) and (K, 956)."""
    apart = ((a[:, None] - b) ** 2).mean(axis=2)
    return np.asarray(np.exp(-apart / (2 * KERNEL_WIDTH_EYE_DISTANCES**2)), np.float32)


def _keep_closed(offsets: NDArray[np.floating], placed: NDArray[np.floating]) -> NDArray[np.float32]:
    """Lips and lids that are closed stay so: both sides take the mean. Irises and the lids' skin go with their eye."""
    down = placed[:, 152] - placed[:, 10]
    unit = eye_distance(placed)
    top, bottom = np.array(INNER_LIP_PAIRS + LID_EDGE_VERTEX_PAIRS).T
    gap = np.einsum("nvi,ni->nv", placed[:, bottom] - placed[:, top], down / np.linalg.norm(down, axis=1)[:, None])
    middle, apart = (offsets[:, top] + offsets[:, bottom]) / 2, (offsets[:, bottom] - offsets[:, top]) / 2
    apart = apart * np.clip(gap / (INDEPENDENT_GAP_EYE_DISTANCES * unit[:, None]), 0, 1)[..., None]
    offsets[:, top], offsets[:, bottom] = middle - apart, middle + apart
    skin, edge = np.array(LID_SKIN_VERTEX_PAIRS).T
    offsets[:, skin] = offsets[:, edge]
    for eye, iris in ((RIGHT_EYE, RIGHT_IRIS), (LEFT_EYE, LEFT_IRIS)):
        offsets[:, list(iris)] = offsets[:, list(eye)].mean(axis=1, keepdims=True)
    return np.asarray(offsets, np.float32)
