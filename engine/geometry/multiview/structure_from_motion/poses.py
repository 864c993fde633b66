"""Poses of cameras out of what they see: one to another, and one to known points. Lenses are known: what is seen lies on the
plane at distance 1, without distortion.

Sources: D. Nister, An efficient solution to the five-point relative pose problem, PAMI 2004; T. Ke, S. Roumeliotis, An
efficient algebraic solution to the perspective-three-point problem, CVPR 2017, both within random samples (OpenCV's).
"""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

RANSAC_CONFIDENCE = 0.9999
"""Probability with which a sample without a wrong match is to be among those drawn."""
RESECTION_SAMPLES = 2000


@dataclass(frozen=True)
class Pose:
    """`rotation` (3, 3) and `translation` (3,) from the world to a camera; `agreed` (N,) bool: what was seen in accord."""

    rotation: NDArray[np.float64]
    translation: NDArray[np.float64]
    agreed: NDArray[np.bool_]


def relative_pose(first: NDArray[np.float64], second: NDArray[np.float64], max_error: float) -> Pose | None:
    """The second camera's pose, as the first one has it, one unit away; None where too few agree.

    Parameters
    ----------
    first, second : (N, 2) what both see. max_error : how far from the epipolar line, on the plane.
    """
    if len(first) < 8:
        return None
    essential, mask = cv2.findEssentialMat(
        first, second, np.eye(3), method=cv2.RANSAC, prob=RANSAC_CONFIDENCE, threshold=max_error
    )
    if essential is None or essential.shape != (3, 3):
        return None
    count, rotation, translation, mask = cv2.recoverPose(essential, first, second, np.eye(3), mask=mask)
    if count < 8:
        return None
    return Pose(np.asarray(rotation, np.float64), np.asarray(translation, np.float64).ravel(), mask.ravel() > 0)


def resection(points: NDArray[np.float64], seen: NDArray[np.float64], max_error: float) -> Pose | None:
    """The pose of a camera that sees points (N, 3) at (N, 2); None where there is none that six agree with."""
    if len(points) < 6:
        return None
    found, turn, shift, inliers = cv2.solvePnPRansac(
        *(points, seen, np.eye(3), None),
        iterationsCount=RESECTION_SAMPLES,
        reprojectionError=max_error,
        confidence=RANSAC_CONFIDENCE,
        flags=cv2.SOLVEPNP_AP3P,
    )
    if not found or inliers is None or len(inliers) < 6:
        return None
    chosen = inliers.ravel()
    turn, shift = cv2.solvePnPRefineLM(points[chosen], seen[chosen], np.eye(3), None, turn, shift)
    rotation, translation = cv2.Rodrigues(turn)[0], shift.ravel()
    at = points @ rotation.T + translation
    with np.errstate(divide="ignore", invalid="ignore"):
        off = np.linalg.norm(at[:, :2] / at[:, 2:] - seen, axis=1)
    agreed = (at[:, 2] > 0) & (off <= max_error)
    return Pose(np.asarray(rotation, np.float64), np.asarray(translation, np.float64), agreed)
