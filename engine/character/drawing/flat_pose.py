"""A drawing's skeleton: the template's joints where the drawing has them, all in one plane.

A drawn figure has nobody's proportions, so no body is fitted to it: its bones are as long as they are drawn. They lie across the view,
and the way to the T-pose turns them in the picture's plane alone; what is flat stays flat.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from engine.body.fitting.body_fitting import Fit
from engine.body.landmarks import LIMB_LANDMARKS
from engine.body.rest_pose import T_POSE_DIRECTIONS
from engine.character.figure.figure import Figure
from engine.character.fit.template_fit import FIGURE_FOCAL_LENGTH_SIDES, FittedBody, load_human
from engine.geometry.camera import Camera
from engine.geometry.rigging.joint_names import FINGER_NAMES, SIDE_NAMES
from engine.geometry.rigging.skeleton import Skeleton
from engine.imaging.masks.mask_pieces import bounding_box

DRAWING_HEIGHT_METRES = 1.7
"""Metres from top to bottom of a drawn figure: it walks among people."""
SPINE_JOINT_SHARES = {"Spine": 0.2, "Spine1": 0.45, "Spine2": 0.7}
"""Where the spine's joints are on the way from the hips to between the shoulders."""
NECK_BELOW_HEAD_EAR_DISTANCES, HEAD_JOINT_SHARE, COLLARBONE_JOINT_SHARE = 1.6, 0.3, 0.3
"""How far below the head's middle the neck's joint is, in distances from there to an ear; where the head's is on the way back up, and a
collarbone's on that from between the shoulders to one of them."""
FINGER_JOINTS = (0.45, 0.65, 0.82)
"""Where finger joints are on the way from wrist to fingertip."""
TOES_FORWARD_METRES = 0.1
"""Metres by which toes are before the ankle: feet roll over them although they are drawn flat."""
BONE_END_LANDMARKS = {
    "Arm": "Elbow",
    "ForeArm": "Wrist",
    "Hand": "Index",
    "UpLeg": "Knee",
    "Leg": "Ankle",
    "Foot": "FootIndex",
}
"""Landmarks at which the bones of joints end."""


@dataclass(frozen=True)
class FlatPose:
    """Where a drawing has its joints.

    places : (J, 2) in the picture, pixels.
    angles : (J,) radians by which each is turned in the world from the T-pose, from x to y, which is up.
    """

    places: NDArray[np.float64]
    angles: NDArray[np.float64]


def flat_pose(figure: Figure) -> FlatPose:
    """Where a drawn figure's landmarks have the joints of the characters' rig."""
    rig = load_human().rig
    at = {name: figure.point(name).astype(np.float64) for name in _landmarks()}
    hips, chest = ((at[f"Left{joint}"] + at[f"Right{joint}"]) / 2 for joint in ("Hip", "Shoulder"))
    upright = _turn(chest - hips, (0.0, 1.0))
    head = at["Nose"] - chest
    nod = _turn(head, (0.0, 1.0)) if np.linalg.norm(head) > 1e-6 else upright
    chin = NECK_BELOW_HEAD_EAR_DISTANCES * float(np.linalg.norm(at["LeftEar"] - at["RightEar"])) / 2
    neck = chest + max(0.0, 1 - chin / max(float(np.linalg.norm(head)), 1e-6)) * head
    places = {"Hips": hips, "Neck": neck, "Head": neck + HEAD_JOINT_SHARE * (at["Nose"] - neck)}
    places |= {name: hips + share * (chest - hips) for name, share in SPINE_JOINT_SHARES.items()}
    angles = dict.fromkeys(("Hips", *SPINE_JOINT_SHARES), upright) | {"Neck": nod, "Head": nod}
    for side in SIDE_NAMES:
        places[f"{side}Shoulder"], angles[f"{side}Shoulder"] = (
            chest + COLLARBONE_JOINT_SHARE * (at[f"{side}Shoulder"] - chest),
            upright,
        )
        for joint, mark in LIMB_LANDMARKS.items():
            begin, end = at[f"{side}{mark}"], at[f"{side}{BONE_END_LANDMARKS[joint]}"]
            places[f"{side}{joint}"] = begin
            straight = T_POSE_DIRECTIONS.get(f"{side}{joint}")
            angles[f"{side}{joint}"] = 0.0 if straight is None else _turn(end - begin, straight[:2])
        places[f"{side}ToeBase"], angles[f"{side}ToeBase"] = at[f"{side}Ankle"], 0.0
        wrist, tip = at[f"{side}Wrist"], at[f"{side}Index"]
        for finger in FINGER_NAMES:
            for number, share in enumerate(FINGER_JOINTS, 1):
                places[f"{side}Hand{finger}{number}"] = wrist + share * (tip - wrist)
                angles[f"{side}Hand{finger}{number}"] = angles[f"{side}Hand"]
    return FlatPose(np.stack([places[name] for name in rig.names]), np.array([angles[name] for name in rig.names]))


def fit_drawing(figure: Figure, mask: NDArray[np.bool_]) -> FittedBody:
    """The pose of a drawing whose outline is `mask` (H, W), as a fit of nobody's body: each joint's turn, the camera and the distance."""
    human = load_human()
    rows, _ = bounding_box(mask)
    height, width = mask.shape
    camera = Camera(
        (0.0, 0.0, 0.0),
        FIGURE_FOCAL_LENGTH_SIDES * max(height, width),
        ((width - 1) / 2, (height - 1) / 2),
        (height, width),
    )
    distance = camera.focal * DRAWING_HEIGHT_METRES / (rows.stop - rows.start)
    pose, parents = flat_pose(figure), human.rig.parents
    own = pose.angles - np.where(parents >= 0, pose.angles[parents], 0)
    root = camera.unproject(pose.places[:1], np.array([distance]))[0]
    fit = Fit(
        np.zeros(0, np.float32),
        Rotation.from_rotvec(np.outer(own, [0.0, 0.0, 1.0])).as_matrix().astype(np.float32),
        root.astype(np.float32),
        0.0,
        np.zeros(0),
    )
    return FittedBody(fit, camera, np.zeros(len(parents), np.bool_))


def flat_skeleton(pose: FlatPose, fitted: FittedBody, ground: float) -> Skeleton:
    """The skeleton in T-pose, with the root where it is in the picture: each bone's way in the picture, turned back. `ground`: the y of
    the ground, metres, as the picture's camera has it."""
    rig, camera = load_human().rig, fitted.picture_camera()
    seen = camera.to_metres(np.column_stack([pose.places, np.zeros(len(pose.places))]))
    for side in SIDE_NAMES:
        ankle = seen[rig.index(f"{side}Foot")]
        seen[rig.index(f"{side}ToeBase")] = [
            ankle[0],
            ground + 0.2 * (ankle[1] - ground),
            ankle[2] + TOES_FORWARD_METRES,
        ]
    back = Rotation.from_rotvec(np.outer(-pose.angles, [0.0, 0.0, 1.0]))
    heads = seen.copy()
    for joint, parent in enumerate(rig.parents):
        if parent >= 0:
            heads[joint] = heads[parent] + back[int(parent)].apply(seen[joint] - seen[parent])
    return Skeleton(rig.names, rig.parents, heads.astype(np.float32))


def _turn(way: NDArray[np.float64], straight: tuple[float, ...]) -> float:
    """The angle from a direction of the T-pose to a way (2,) in the picture, whose y points down."""
    turn = float(np.arctan2(-way[1], way[0]) - np.arctan2(straight[1], straight[0]))
    return float((turn + np.pi) % (2 * np.pi) - np.pi)


def _landmarks() -> list[str]:
    marks = {"Ear", *LIMB_LANDMARKS.values(), *BONE_END_LANDMARKS.values()}
    return ["Nose", *(f"{side}{mark}" for side in SIDE_NAMES for mark in sorted(marks))]
