"""What is amiss on a made face where a tracker looks at it (see `second_look`), and what is done about it."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

import numpy as np
from numpy.typing import NDArray

from engine.face_animation.appearance import CROP_EYES
from engine.face_animation.lids_and_lips import LID_SKIN, LIDS, LIPS
from engine.perception.head_pose import canonical_face
from engine.perception.landmarks import LEFT_EYE, LEFT_IRIS, LIPS_INNER, LIPS_OUTER, MESH_SIZE, RIGHT_EYE, RIGHT_IRIS

UNIT = CROP_EYES[1][0] - CROP_EYES[0][0]
"""Eye distance in the crop, pixels."""
SHARE = 0.6
"""How much of what is amiss is corrected: the rest is the tracker's own scatter ..."""
LIPS_SHARE, LIPS_REACH = 0.35, 0.15
"""... which is larger at the lips, whose looks change most, and less so the further beside them: width in eye distances."""
ALIKE = 0.05
"""Root mean square distance of two faces' points, in eye distances, at which the frames are alike."""
SCATTER = 0.2
"""Ridge of the regression: the tracker's scatter in what it finds amiss."""
MOST = 0.08
"""Eye distances: more than this is the tracker's error."""
PARTED = 0.08
"""Eye distances between two lips or lids from which each is corrected by itself; closed ones move as one."""


@dataclass(frozen=True)
class Misfit:
    """What was amiss on the frames that were looked at, as a kernel ridge regression.

    faces : (K, 956) float32, the driver's face on them. weights : (K, 956) float32. Both in eye distances, upright.
    """

    faces: NDArray[np.float32]
    weights: NDArray[np.float32]

    def corrections(self, faces: NDArray[np.floating], placed: NDArray[np.floating]) -> NDArray[np.float32]:
        """What corrects the points of some frames: (N, 478, 2) offsets, pixels of the target.

        Parameters
        ----------
        faces : (N, 478, 2) the driver's face in its crop. placed : (N, 478, 2) the target's points as they were carried.
        """
        amiss = (_likeness(flat(faces), self.faces) @ self.weights).reshape(-1, MESH_SIZE, 2)
        right = placed[:, None, [263, 362]].mean(axis=2) - placed[:, None, [33, 133]].mean(axis=2)  # one eye distance
        down = right[..., ::-1] * (-1, 1)
        return _keep_closed(-_shares() * (amiss[..., :1] * right + amiss[..., 1:] * down), placed)


def fit_misfit(faces: NDArray[np.floating], amiss: NDArray[np.floating]) -> Misfit:
    """From what was `amiss` (K, 478, 2) on frames of the driver with these `faces` (K, 478, 2), pixels of its crop."""
    known = flat(faces)
    size = np.linalg.norm(amiss, axis=2, keepdims=True) / UNIT
    believed = flat(amiss * np.minimum(1, MOST / np.maximum(size, 1e-6)))
    weights = np.linalg.solve(_likeness(known, known) + SCATTER * np.eye(len(known)), believed)
    return Misfit(known, weights.astype(np.float32))


def no_misfit() -> Misfit:
    """Nothing amiss anywhere."""
    return Misfit(np.zeros((0, 2 * MESH_SIZE), np.float32), np.zeros((0, 2 * MESH_SIZE), np.float32))


def flat(faces: NDArray[np.floating]) -> NDArray[np.float32]:
    """(K, 478, 2) pixels of the crop as (K, 956) eye distances."""
    return np.asarray(faces.reshape(len(faces), -1) / UNIT, np.float32)


@cache
def _shares() -> NDArray[np.float32]:
    """(478, 1) how much of what is amiss is corrected at each vertex."""
    face = canonical_face()
    apart = np.linalg.norm(face[:, None] - face[list(LIPS_OUTER + LIPS_INNER)], axis=2).min(axis=1, keepdims=True)
    return np.asarray(SHARE + (LIPS_SHARE - SHARE) * np.exp(-((apart / LIPS_REACH) ** 2)), np.float32)


def _likeness(a: NDArray[np.float32], b: NDArray[np.float32]) -> NDArray[np.float32]:
    """(N, K) from 0 to 1 for the same face, between faces (N, 956) and (K, 956)."""
    apart = ((a[:, None] - b) ** 2).mean(axis=2)
    return np.asarray(np.exp(-apart / (2 * ALIKE**2)), np.float32)


def _keep_closed(offsets: NDArray[np.floating], placed: NDArray[np.floating]) -> NDArray[np.float32]:
    """Lips and lids that are closed stay so: both sides take the mean. Irises and the lids' skin go with their eye."""
    down = placed[:, 152] - placed[:, 10]
    unit = np.linalg.norm(placed[:, [263, 362]].mean(axis=1) - placed[:, [33, 133]].mean(axis=1), axis=1)
    top, bottom = np.array(LIPS + LIDS).T
    gap = np.einsum("nvi,ni->nv", placed[:, bottom] - placed[:, top], down / np.linalg.norm(down, axis=1)[:, None])
    middle, apart = (offsets[:, top] + offsets[:, bottom]) / 2, (offsets[:, bottom] - offsets[:, top]) / 2
    apart = apart * np.clip(gap / (PARTED * unit[:, None]), 0, 1)[..., None]
    offsets[:, top], offsets[:, bottom] = middle - apart, middle + apart
    skin, edge = np.array(LID_SKIN).T
    offsets[:, skin] = offsets[:, edge]
    for eye, iris in ((RIGHT_EYE, RIGHT_IRIS), (LEFT_EYE, LEFT_IRIS)):
        offsets[:, list(iris)] = offsets[:, list(eye)].mean(axis=1, keepdims=True)
    return np.asarray(offsets, np.float32)
