"""How a motion's skeleton would stand if it stood in our T-pose.

Files do not agree on the pose at rest: T-pose, A-pose, legs astride (CMU), z up (MakeHuman), or every bone along its own
first axis, which is no pose at all (Bandai). Where the pose at rest is a standing person's, it is taken; else the mean
of all frames, which is one. Then limbs are turned, bone by bone, the shortest way into the directions that they have in
our T-pose; what a bone turns about itself is kept. The trunk is left as it is at rest: its joints lie differently in
every skeleton, so that its bones' directions say nothing (of a mean pose, it is set upright). Feet are only turned
about the vertical, for at rest they stand on the ground.
"""

from __future__ import annotations

from collections.abc import Mapping
from itertools import pairwise, permutations, product

import numpy as np
from numpy.typing import NDArray

from engine.geometry.rigging.joint_names import SIDE_NAMES
from engine.geometry.rigging.skeleton import Skeleton
from engine.motion import rotation
from engine.motion.files.source_motion import SourceMotion
from engine.motion.kinematics import world_rotations

Array = NDArray[np.float64]

LIMB_ENDS = {"Arm": "ForeArm", "ForeArm": "Hand", "UpLeg": "Leg", "Leg": "Foot"}

MAX_SNAP_ANGLE = np.radians(25)
"""A rest pose that stands nearer than this to a world axis is meant to stand along it."""


def t_pose_rotations(motion: SourceMotion, mapping: Mapping[str, str], skeleton: Skeleton) -> dict[str, Array]:
    """`{our joint: (4,)}`: the world rotation that the motion's joint would have in our T-pose, facing +z, y up."""
    joints = {name: motion.names.index(source) for name, source in mapping.items()}
    rotations, places = motion.rest()
    at_rest = is_standing(places, joints)
    if not at_rest:
        rotations, places = _mean_pose(motion, joints)
    upright = standing_rotation(places, joints, snap=at_rest)
    rotations, places = rotation.multiply(upright, rotations), rotation.rotate(upright, places)
    corrections = {name: rotation.identity() for name in joints}
    if not at_rest:
        corrections.update(_upright_trunk(places, joints))
    for side in SIDE_NAMES:
        _correct_limb(("Arm", "ForeArm"), "Hand", side, places, joints, skeleton, corrections)
        _correct_limb(("UpLeg", "Leg"), "Foot", side, places, joints, skeleton, corrections)
        _correct_ends(side, places, joints, skeleton, corrections, pitch=not at_rest)
    return {name: rotation.multiply(corrections[name], rotations[joint]) for name, joint in joints.items()}


def is_standing(places: Array, joints: Mapping[str, int]) -> bool:
    """Whether joints at these places (J, 3) could be a person's who stands: legs down, arms at two sides."""
    up, left = _trunk_axes(places, joints)
    if not (up.any() and left.any()) or abs(float(up @ left)) > 0.3:
        return False
    for side, sign in (("Left", 1), ("Right", -1)):
        leg = places[joints[f"{side}Foot"]] - places[joints[f"{side}UpLeg"]]
        shin = places[joints[f"{side}Foot"]] - places[joints[f"{side}Leg"]]
        arm = places[joints[f"{side}ForeArm"]] - places[joints[f"{side}Arm"]]
        if rotation.normalize(leg) @ up > -0.7 or rotation.normalize(shin) @ up > -0.7:
            return False
        if sign * float(rotation.normalize(arm) @ left) < -0.1 or rotation.normalize(arm) @ up > 0.5:
            return False
    return True


def standing_rotation(places: Array, joints: Mapping[str, int], snap: bool) -> Array:
    """(4,) the rotation that brings a standing person to y up, left to +x; with `snap`, one of the 24 that keep the
    axes, if one is near."""
    up, left = _trunk_axes(places, joints)
    left = rotation.normalize(left - (left @ up) * up)
    turn = rotation.from_matrix(np.stack([left, up, np.cross(left, up)]))
    if snap:
        nearest = min(
            _axis_rotations(), key=lambda other: float(rotation.angle(rotation.multiply(other, rotation.inverse(turn))))
        )
        if rotation.angle(rotation.multiply(nearest, rotation.inverse(turn))) < MAX_SNAP_ANGLE:
            return nearest
    return turn


def _trunk_axes(places: Array, joints: Mapping[str, int]) -> tuple[Array, Array]:
    """Up and to the left, as hips, shoulders and legs have it."""
    hips = (places[joints["LeftUpLeg"]] + places[joints["RightUpLeg"]]) / 2
    shoulders = (places[joints["LeftArm"]] + places[joints["RightArm"]]) / 2
    left = places[joints["LeftUpLeg"]] - places[joints["RightUpLeg"]]
    left = rotation.normalize(left) + rotation.normalize(places[joints["LeftArm"]] - places[joints["RightArm"]])
    return rotation.normalize(shoulders - hips), rotation.normalize(left)


def _axis_rotations() -> list[Array]:
    rotations = []
    for order in permutations(range(3)):
        for signs in product((1.0, -1.0), repeat=3):
            matrix = np.zeros((3, 3))
            matrix[range(3), order] = signs
            if np.linalg.det(matrix) > 0:
                rotations.append(rotation.from_matrix(matrix))
    return rotations


def _mean_pose(motion: SourceMotion, joints: Mapping[str, int]) -> tuple[Array, Array]:
    """World rotations (J, 4) and places (J, 3) of the mean pose: each joint's mean rotation as seen from the hips."""
    world = world_rotations(motion.parents, motion.rotations)
    hips = world[:, joints["Hips"], None]
    seen = rotation.mean(rotation.multiply(rotation.inverse(hips), world))
    offsets = np.mean(motion.translations, axis=0)
    places = np.zeros_like(offsets)
    for joint, parent in enumerate(motion.parents):
        if parent >= 0:
            places[joint] = places[parent] + rotation.rotate(seen[parent], offsets[joint])
    return seen, places


def _upright_trunk(places: Array, joints: Mapping[str, int]) -> dict[str, Array]:
    """Corrections that set the bones of the trunk upright; shoulders go along with the chest."""
    chain = [name for name in ("Hips", "Spine", "Spine1", "Spine2", "Neck") if name in joints]
    corrections = {}
    for name, following in pairwise(chain):
        bone = places[joints[following]] - places[joints[name]]
        up = np.array([0.0, 1.0, 0.0])
        corrections[name] = rotation.between(bone, up) if np.linalg.norm(bone) > 1e-6 else rotation.identity()
    chest = corrections.get("Spine2", rotation.identity())
    return corrections | {name: chest for name in ("LeftShoulder", "RightShoulder") if name in joints}


def _correct_limb(
    parts: tuple[str, str],
    end: str,
    side: str,
    places: Array,
    joints: Mapping[str, int],
    skeleton: Skeleton,
    corrections: dict[str, Array],
) -> None:
    correction = corrections.get(f"{side}Shoulder", rotation.identity()) if end == "Hand" else rotation.identity()
    for part in parts:
        name, following = side + part, side + LIMB_ENDS[part]
        wanted = _direction(skeleton, name, following)
        if name in joints and following in joints and wanted is not None:
            bone = rotation.rotate(correction, places[joints[following]] - places[joints[name]])
            correction = rotation.multiply(rotation.between(bone, wanted), correction)
        corrections[name] = correction
    for name in joints:
        if name.startswith(side + end) or (end == "Foot" and name == f"{side}ToeBase"):
            corrections[name] = correction


def _correct_ends(
    side: str,
    places: Array,
    joints: Mapping[str, int],
    skeleton: Skeleton,
    corrections: dict[str, Array],
    pitch: bool,
) -> None:
    """Feet point where ours do: about the vertical, and with `pitch` up and down as well."""
    foot, toe = f"{side}Foot", f"{side}ToeBase"
    wanted = _direction(skeleton, foot, toe)
    if foot not in joints or toe not in joints or wanted is None:
        return
    bone = rotation.rotate(corrections[foot], places[joints[toe]] - places[joints[foot]])
    if not pitch:
        bone, wanted = bone * [1, 0, 1], wanted * [1, 0, 1]
    if np.linalg.norm(bone) < 1e-6 or np.linalg.norm(wanted) < 1e-6:
        return
    turn = rotation.between(bone, wanted)
    corrections[foot] = rotation.multiply(turn, corrections[foot])
    corrections[toe] = rotation.multiply(turn, corrections[toe])


def _direction(skeleton: Skeleton, name: str, following: str) -> Array | None:
    if name not in skeleton.names or following not in skeleton.names:
        return None
    return np.asarray(skeleton.heads[skeleton.index(following)] - skeleton.heads[skeleton.index(name)], np.float64)
