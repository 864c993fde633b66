"""Where perception's 33 body landmarks lie on the template: each is carried by one joint."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from engine.body.body_space import BodySpace
from engine.body.face.face_points import EYE_CORNER_FACE_POINTS, MOUTH_CORNER_FACE_POINTS, face_points, nose_tip
from engine.body.rig import Rig
from engine.body.template import Template

SIDE_SIGNS = (("Left", 1.0), ("Right", -1.0))

JOINT_LANDMARKS = {
    "Shoulder": "Arm",
    "Elbow": "ForeArm",
    "Wrist": "Hand",
    "Hip": "UpLeg",
    "Knee": "Leg",
    "Ankle": "Foot",
    "Pinky": "HandPinky1",
    "Index": "HandIndex1",
    "Thumb": "HandThumb2",
}
"""Landmarks that are joints, both without their side. The others are points of the surface."""

LIMB_LANDMARKS = {
    "Arm": "Shoulder",
    "ForeArm": "Elbow",
    "Hand": "Wrist",
    "UpLeg": "Hip",
    "Leg": "Knee",
    "Foot": "Ankle",
}
"""Landmarks at which limbs begin and end, by the joint."""

LANDMARK_RISE_METRES = {"Shoulder": 0.012, "Hip": 0.017, "Knee": 0.007, "Ankle": 0.032, "Heel": 0.027}
"""Metres by which perception sees a landmark above the template's joint: means over renders of the template itself."""


@dataclass(frozen=True)
class LandmarkModel:
    """Landmarks at rest, linear in the body's coefficients.

    names : (L,).
    joints : (L,) int, the joint that carries each.
    mean : (L, 3) where they are in T-pose, as `engine.body.body_space.BodySpace` has its vertices.
    basis : (K, L, 3) how they move with each coefficient.
    """

    names: tuple[str, ...]
    joints: NDArray[np.intp]
    mean: NDArray[np.float32]
    basis: NDArray[np.float32]


def landmark_model(template: Template, space: BodySpace, rig: Rig) -> LandmarkModel:
    """The landmarks of `engine.perception.pose.body.BODY_LANDMARKS` on the template. `rig` has the joints of `space`."""
    found: dict[str, tuple[str, NDArray[np.intp] | None]] = {}
    for side, _ in SIDE_SIGNS:
        found |= {f"{side}{name}": (f"{side}{joint}", None) for name, joint in JOINT_LANDMARKS.items()}
    found |= {name: (carrying_joint(name), at) for name, at in surface_landmarks(template, space, rig).items()}
    means, bases = [], []
    for joint, vertices in found.values():
        if vertices is None:
            at = space.names.index(joint)
            means.append(space.joint_mean[at])
            bases.append(space.joint_basis[:, at])
        else:
            means.append(space.mean[vertices].mean(0))
            bases.append(space.basis[:, vertices].mean(1))
    higher = [LANDMARK_RISE_METRES.get(name.removeprefix("Left").removeprefix("Right"), 0.0) for name in found]
    return LandmarkModel(
        tuple(found),
        np.array([space.names.index(joint) for joint, _ in found.values()]),
        (np.stack(means) + np.outer(higher, [0, 1, 0])).astype(np.float32),
        np.stack(bases, 1),
    )


def carrying_joint(name: str) -> str:
    """The joint that carries a point of the surface."""
    if name.endswith("Heel"):
        return name.removesuffix("Heel") + "Foot"
    if name.endswith("FootIndex"):
        return name.removesuffix("FootIndex") + "Foot"
    return "Head"


def surface_landmarks(template: Template, space: BodySpace, rig: Rig) -> Mapping[str, NDArray[np.intp]]:
    """Vertices whose mean is a landmark: nose, eyes, mouth, ears, heels and tips of the feet, found on the mean body."""
    body = template.vertices_of("body")
    mesh = space.mean
    strongest = rig.bones[:, 0]
    head = body[strongest[body] == rig.index("Head")]
    eyes = {f"{side}Eye": template.vertices_of(f"{side.lower()}_eye").astype(np.intp) for side, _ in SIDE_SIGNS}
    height = mesh[np.concatenate(list(eyes.values())), 1].mean()
    points: dict[str, NDArray[np.intp]] = dict(eyes)
    points["Nose"] = np.array([nose_tip(template, space)])
    on_face = face_points(template, space)
    points |= {name: on_face[[number]] for name, number in (EYE_CORNER_FACE_POINTS | MOUTH_CORNER_FACE_POINTS).items()}
    for side, sign in SIDE_SIGNS:
        beside = head[(np.abs(mesh[head, 1] - height + 0.01) < 0.02) & (sign * mesh[head, 0] > 0)]
        points[f"{side}Ear"] = _furthest(mesh, beside, 0, sign)
        feet = [rig.index(f"{side}Foot"), rig.index(f"{side}ToeBase")]
        foot = body[np.isin(strongest[body], feet)]
        points[f"{side}Heel"] = _furthest(mesh, foot[mesh[foot, 1] < 0.05], 2, -1.0)
        points[f"{side}FootIndex"] = _furthest(mesh, foot[mesh[foot, 1] < 0.05], 2, 1.0)
    return points


def _furthest(mesh: NDArray[np.float32], among: NDArray[np.integer], axis: int, sign: float) -> NDArray[np.intp]:
    return np.array([among[np.argmax(sign * mesh[among, axis])]], np.intp)
