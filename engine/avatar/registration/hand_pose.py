"""Hands as they were held: their turn, fingers and size from landmarks and points, set upon the coarse fit of the body."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from engine.avatar.landmarks.spatial import SpatialLandmarks
from engine.avatar.registration.models import HumanModels
from engine.body.fitting.articulated_hand import TURNED_LANDMARKS
from engine.body.fitting.hand_in_space import fit_hand_in_space
from engine.body.fitting.hand_on_points import HandSkin
from engine.geometry.point_clouds.point_cloud import PointCloud
from engine.geometry.rigging.joint_names import SIDE_NAMES
from engine.geometry.rigging.skinning import skin as blend


@dataclass(frozen=True)
class CoarseBody:
    """The coarse fit as it is handed on.

    vertices : (S, 3) the skin, metres.
    whole : (V, 3) all the template's vertices.
    joints : (J, 3) where the joints are.
    rotations : (J, 3, 3) how their axes are turned from the T-pose, in the world.
    hands : which hands were set by their own landmarks.
    """

    vertices: NDArray[np.float64]
    whole: NDArray[np.float64]
    joints: NDArray[np.float64]
    rotations: NDArray[np.float64]
    hands: tuple[str, ...]


def with_hands(
    models: HumanModels,
    parameters: NDArray[np.float64],
    landmarks: SpatialLandmarks,
    cloud: PointCloud | None = None,
) -> CoarseBody:
    """The body of the coarse fit's `parameters` (P,), its hands as their landmarks, and a `cloud`, have them; a hand without landmarks
    stays as it is."""
    posed = models.body.poser(parameters[None])
    rest, joints, rotations = posed.rest[0], posed.joints[0].copy(), posed.world_rotations[0].copy()
    scales = np.ones(len(joints))
    coefficients = parameters[-models.body.coefficients :]
    found = []
    for side, seen in zip(SIDE_NAMES, landmarks.hands, strict=True):
        wrist, forearm = (models.space.names.index(f"{side}{name}") for name in ("Hand", "ForeArm"))
        skin = None if cloud is None else _hand_skin(models, side, parameters, rest[wrist], cloud)
        fit = fit_hand_in_space(models.hands[side], coefficients, rotations[forearm], joints[wrist], seen, skin)
        if fit is None:
            continue
        found.append(side)
        joints[wrist] += fit.shift
        for joint, own in zip(fit.joints, fit.rotations, strict=True):
            parent = int(models.space.parents[joint])
            rotations[joint] = rotations[parent] @ own
            scales[joint] = fit.scale
            if joint != wrist:
                joints[joint] = joints[parent] + fit.scale * rotations[parent] @ (rest[joint] - rest[parent])
    transforms = np.zeros((len(joints), 4, 4))
    transforms[:, :3, :3] = scales[:, None, None] * rotations
    transforms[:, :3, 3] = joints - np.einsum("jab,jb->ja", transforms[:, :3, :3], rest)
    transforms[:, 3, 3] = 1
    shaped = models.space.vertices(coefficients)
    whole = blend(shaped, models.rig.bones, models.rig.weights, transforms).astype(np.float64)
    return CoarseBody(whole[models.skin.vertices], whole, joints, rotations, tuple(found))


def _hand_skin(
    models: HumanModels, side: str, parameters: NDArray[np.float64], wrist: NDArray[np.float64], cloud: PointCloud
) -> HandSkin:
    """The skin of the body of `parameters` (P,), and which of it a hand moves; `wrist` (3,) is where that is at rest."""
    skin = models.skin
    number = np.zeros(len(models.space.names), np.intp)
    number[models.hands[side].joints[TURNED_LANDMARKS]] = np.arange(1, len(TURNED_LANDMARKS) + 1)
    moved = np.flatnonzero(((skin.weights > 0) & (number[skin.bones] > 0)).any(1))
    return HandSkin(
        cloud,
        models.body.vertices(parameters),
        skin.triangles,
        moved,
        models.body.rest(parameters)[moved] - wrist,
        number[skin.bones[moved]],
        skin.weights[moved].astype(np.float64),
    )
