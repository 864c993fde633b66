"""Where fitting begins: the trunk's turn and each limb's from directions in space, the place from the height view."""

from __future__ import annotations

from collections.abc import Mapping

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.body.body_space import BodySpace
from engine.body.fitting.observation import DIRECTED_LIMBS, Observation
from engine.body.fitting.posing import FITTED_JOINTS, POSED_SHAPE_COEFFICIENTS
from engine.body.landmarks import LandmarkModel
from engine.body.rest_pose import T_POSE_DIRECTIONS, shortest_rotation
from engine.geometry.rigging.joint_names import SIDE_NAMES


def first_guess(
    space: BodySpace, landmarks: LandmarkModel, view: Observation, trunk: Mapping[str, NDArray[np.floating]]
) -> NDArray[np.float64]:
    """The first parameters (P,) for `engine.body.fitting.body_fitting.fit_body`, from one view.

    `trunk`: places in space of `LeftArm`, `RightArm`, `LeftUpLeg` and `RightUpLeg`, metres, x right, y up, z to the
    viewer.
    """
    to_world = np.array(view.camera.axes).T
    rotation_vectors = np.zeros((len(FITTED_JOINTS), 3))
    hips = to_world @ facing(trunk)
    rotation_vectors[0] = _vector(hips)
    for (first, _), direction in zip(DIRECTED_LIMBS, view.directions, strict=True):
        if not np.linalg.norm(direction):
            continue
        side = "Left" if first.startswith("Left") else "Right"
        upper = f"{side}Arm" if "Arm" in first else f"{side}UpLeg"
        frame = hips
        if first != upper:
            frame = frame @ cv2.Rodrigues(rotation_vectors[FITTED_JOINTS.index(upper)])[0]
        rotation_vectors[FITTED_JOINTS.index(first)] = _vector(
            shortest_rotation(np.array(T_POSE_DIRECTIONS[first]), frame.T @ (to_world @ direction))
        )
    return np.concatenate(
        [_place(space, landmarks, view), rotation_vectors.ravel(), np.zeros(POSED_SHAPE_COEFFICIENTS)]
    )


def facing(trunk: Mapping[str, NDArray[np.floating]]) -> NDArray[np.float64]:
    """The trunk's axes as columns: its left, its up, its front."""
    across = trunk["LeftArm"] - trunk["RightArm"] + trunk["LeftUpLeg"] - trunk["RightUpLeg"]
    up = trunk["LeftArm"] + trunk["RightArm"] - trunk["LeftUpLeg"] - trunk["RightUpLeg"]
    up = up / np.linalg.norm(up)
    across = across - (across @ up) * up
    across = across / np.linalg.norm(across)
    return np.stack([across, up, np.cross(across, up)], 1).astype(np.float64)


def _vector(matrix: NDArray[np.floating]) -> NDArray[np.float64]:
    return np.asarray(cv2.Rodrigues(np.asarray(matrix, np.float64))[0].ravel(), np.float64)


def _place(space: BodySpace, landmarks: LandmarkModel, view: Observation) -> NDArray[np.float64]:
    """The root's place from how large shoulders, hips and ankles appear."""
    names = landmarks.names
    trunk = [names.index(f"{side}{part}") for part in ("Shoulder", "Hip") for side in SIDE_NAMES]
    shoulders, hips = view.points[trunk[:2]].mean(0), view.points[trunk[2:]].mean(0)
    model = landmarks.mean[trunk]
    length = float(np.linalg.norm(model[:2].mean(0) - model[2:].mean(0)))
    pixels = max(
        float(np.linalg.norm(shoulders - hips)), float(np.linalg.norm(np.diff(view.points[trunk[:2]], axis=0))), 2
    )
    return view.camera.unproject(hips, view.camera.focal * length / pixels)
