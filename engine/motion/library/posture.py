"""Postures in the words of anatomy, for a skeleton of any proportions.

Angles are degrees, lengths are lengths of the skeleton's own legs. The trunk and the arms are turned; the legs reach for
where the feet are put, so that feet stand however long the legs are.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from engine.geometry.rigging.joint_names import FINGER_NAMES, SIDE_NAMES
from engine.geometry.rigging.skeleton import Skeleton
from engine.motion import rotation
from engine.motion.clip import Clip
from engine.motion.feet.inverse_kinematics import two_bones
from engine.motion.feet.legs import HeldFoot, ankle_over_ball, hip_lowering, set_legs
from engine.motion.feet.sole import Sole, leg_length, soles
from engine.motion.kinematics import local_rotations, place_joints

Array = NDArray[np.float64]
Value = float | Array

Turn = tuple[Value, Value, Value]
"""Pitch (forwards), yaw (to the left) and roll (towards the right), degrees."""

ELBOW_AXES = {"Left": (0.0, -1.0, 0.0), "Right": (0.0, 1.0, 0.0)}
"""Elbows bend about these axes: a positive turn brings the forearm forward."""


@dataclass(frozen=True)
class Arm:
    """An arm, measured from hanging at the side, palm inwards; degrees.

    swing : forward.
    lift : away from the body.
    twist : of the upper arm, the bent forearm outwards.
    elbow : bent.
    palm : turned, the thumb outwards.
    wrist : bent to the palm.
    shrug : of the shoulder.
    curl : of each finger's joints.
    rests : how far the hand is laid on the thigh, in [0, 1].
    """

    swing: Value = 0.0
    lift: Value = 8.0
    twist: Value = 0.0
    elbow: Value = 12.0
    palm: Value = 0.0
    wrist: Value = 0.0
    shrug: Value = 0.0
    curl: Value = 18.0
    rests: Value = 0.0


@dataclass(frozen=True)
class Foot:
    """A foot.

    aside, up, ahead : where its ball is, in leg lengths from where it is at rest; the first to the left.
    pitch : degrees. Positive: the heel is up and the foot stands on its ball; negative: on its heel.
    yaw : degrees, of the toes outwards.
    """

    aside: Value = 0.0
    up: Value = 0.0
    ahead: Value = 0.0
    pitch: Value = 0.0
    yaw: Value = 6.0


@dataclass(frozen=True)
class Posture:
    """A body in `frames` frames; every value is a number or an array (F,).

    `root`: the hips' way from rest (to the left, up, ahead). `hips`, `spine` (the whole of it) and `head` are turns;
    the head's is in the world: it looks where it is told, whatever the body does.
    """

    frames: int
    root: tuple[Value, Value, Value] = (0.0, -0.006, 0.0)
    hips: Turn = (0.0, 0.0, 0.0)
    spine: Turn = (0.0, 0.0, 0.0)
    head: Turn = (0.0, 0.0, 0.0)
    arms: Mapping[str, Arm] = field(default_factory=lambda: {"Left": Arm(), "Right": Arm()})
    feet: Mapping[str, Foot] = field(default_factory=lambda: {"Left": Foot(), "Right": Foot()})


def embody(posture: Posture, skeleton: Skeleton, name: str, fps: float, loops: bool = False) -> Clip:
    """The posture as a motion of the skeleton. Hips that are too high for the legs to reach the ground are lowered."""
    frames = posture.frames
    world = rotation.identity(frames, len(skeleton.names))
    hips = skeleton.index("Hips")
    world[:] = _turn(posture.hips, frames)[:, None]
    _bend_spine(world, skeleton, _turn(posture.spine, frames), _turn(posture.head, frames))
    for side, arm in posture.arms.items():
        _hang_arm(world, skeleton, side, arm)
    leg = leg_length(skeleton)
    root = np.asarray(skeleton.heads[hips], np.float64) + leg * _columns(posture.root, frames)
    feet = [(sole, _stand(sole, posture.feet[side], side, leg, frames)) for sole, side in _sides(skeleton)]
    _straighten_legs(world, feet)
    places = place_joints(skeleton.parents, skeleton.offsets(), world, root)
    root = root - hip_lowering(feet, places, fps, loops)[:, None] * [0, 1, 0]
    set_legs(world, place_joints(skeleton.parents, skeleton.offsets(), world, root), feet)
    for side, arm in posture.arms.items():
        if np.any(np.asarray(arm.rests) > 0):
            _lay_hand(world, skeleton, side, arm, root)
    rotations = local_rotations(skeleton.parents, world)
    return Clip(name, float(fps), rotations.astype(np.float32), root.astype(np.float32), loops)


def _turn(turn: Turn, frames: int) -> Array:
    pitch, yaw, roll = (np.broadcast_to(np.radians(angle), frames) for angle in turn)
    return rotation.chain(rotation.about("y", yaw), rotation.about("x", pitch), rotation.about("z", roll))


def _columns(values: tuple[Value, Value, Value], frames: int) -> Array:
    return np.stack([np.broadcast_to(np.asarray(value, np.float64), frames) for value in values], -1)


def _below(skeleton: Skeleton, name: str) -> list[int]:
    """The joint and all that hang below it."""
    below = [skeleton.index(name)]
    for joint, parent in enumerate(skeleton.parents):
        if parent in below:
            below.append(joint)
    return below


def _bend_spine(world: Array, skeleton: Skeleton, bend: Array, head: Array) -> None:
    """The bend is shared by the spine's joints; the neck goes half way to the head."""
    chain = [name for name in ("Spine", "Spine1", "Spine2") if name in skeleton.names]
    share = rotation.slerp(rotation.identity(len(bend)), bend, np.full(len(bend), 1 / len(chain)))
    for name in chain:
        below = _below(skeleton, name)
        joint = skeleton.index(name)
        turned = rotation.multiply(world[:, joint], share)
        world[:, below] = turned[:, None]
    if "Head" in skeleton.names:
        world[:, _below(skeleton, "Head")] = head[:, None]
        if "Neck" in skeleton.names:
            chest = world[:, skeleton.index(chain[-1])]
            world[:, skeleton.index("Neck")] = rotation.slerp(chest, head, np.full(len(head), 0.5))


def _hang_arm(world: Array, skeleton: Skeleton, side: str, arm: Arm) -> None:
    """Written for the left arm, whose rest is along +x, palm down; the right one is its mirror image."""
    frames = len(world)

    def sided(axis: str, degrees: Value) -> Array:
        turn = rotation.about(axis, np.broadcast_to(np.radians(degrees), frames))
        return turn if side == "Left" else rotation.mirrored(turn)

    shoulder = sided("z", arm.shrug)
    down = rotation.chain(
        sided("x", -np.asarray(arm.swing)), sided("z", np.asarray(arm.lift) - 90.0), sided("x", -np.asarray(arm.twist))
    )
    elbow = rotation.multiply(sided("y", -np.asarray(arm.elbow)), sided("x", np.asarray(arm.palm)))
    for name, turn in (
        ("Shoulder", shoulder),
        ("Arm", down),
        ("ForeArm", elbow),
        ("Hand", sided("z", -np.asarray(arm.wrist))),
    ):
        if side + name in skeleton.names:
            below = _below(skeleton, side + name)
            world[:, below] = rotation.multiply(world[:, below[0]], turn)[:, None]
    for finger in FINGER_NAMES:
        for phalanx in (1, 2, 3):
            name = f"{side}Hand{finger}{phalanx}"
            if name in skeleton.names:
                below = _below(skeleton, name)
                curl = (
                    sided("y", -0.5 * np.asarray(arm.curl)) if finger == "Thumb" else sided("z", -np.asarray(arm.curl))
                )
                world[:, below] = rotation.multiply(world[:, below[0]], curl)[:, None]


def _sides(skeleton: Skeleton) -> list[tuple[Sole, str]]:
    return list(zip(soles(skeleton), SIDE_NAMES, strict=True))


def _stand(sole: Sole, foot: Foot, side: str, leg: float, frames: int) -> HeldFoot:
    sign = 1 if side == "Left" else -1
    level = rotation.about("y", np.broadcast_to(sign * np.radians(foot.yaw), frames))
    pitch = np.broadcast_to(np.radians(foot.pitch), frames)
    rotations = rotation.multiply(level, rotation.about(sole.lateral, pitch))
    toes = rotation.multiply(level, rotation.about(sole.lateral, np.minimum(pitch, 0)))
    rest = sole.ankle + sole.toe + sole.ball
    ball = rest + leg * _columns((foot.aside, foot.up, foot.ahead), frames)
    return HeldFoot(rotations, toes, ball + ankle_over_ball(sole, rotations, level, pitch), np.ones(frames))


def _straighten_legs(world: Array, feet: list[tuple[Sole, HeldFoot]]) -> None:
    """Legs straight down, knees towards between where the pelvis and where the foot points: what they are bent from."""
    for sole, foot in feet:
        hip, knee, ankle, _ = sole.joints
        pelvis = _yaw(world[:, hip])
        world[:, [hip, knee, ankle]] = rotation.about("y", pelvis + (_yaw(foot.rotations) - pelvis) * 0.6)[:, None]


def _lay_hand(world: Array, skeleton: Skeleton, side: str, arm: Arm, root: Array) -> None:
    """Bring the hand onto the thigh by inverse kinematics, as far as `rests` says."""
    places = place_joints(skeleton.parents, skeleton.offsets(), world, root)
    hip, knee, upper, lower, hand = (skeleton.index(side + part) for part in ("UpLeg", "Leg", "Arm", "ForeArm", "Hand"))
    thigh = places[:, knee] - places[:, hip]
    length = np.linalg.norm(thigh, axis=-1, keepdims=True)
    wanted = places[:, hip] + 0.62 * thigh + 0.2 * length * [0, 1, 0]
    share = np.broadcast_to(np.asarray(arm.rests, np.float64), len(world))[:, None]
    target = places[:, hand] * (1 - share) + wanted * share
    limb = (places[:, upper], places[:, lower], places[:, hand])
    old = world[:, hand].copy()
    before = world[:, lower].copy()
    world[:, upper], world[:, lower], _ = two_bones(limb, (world[:, upper], world[:, lower]), target, ELBOW_AXES[side])
    carried = rotation.multiply(rotation.multiply(world[:, lower], rotation.inverse(before)), old)
    sign = 1 if side == "Left" else -1
    along = np.arctan2(-thigh[:, 2], sign * thigh[:, 0]) * sign
    flat = rotation.multiply(rotation.about("y", along), rotation.about("z", np.full(len(world), -0.1 * sign)))
    turned = rotation.slerp(carried, flat, share[:, 0])
    below = _below(skeleton, f"{side}Hand")
    world[:, below] = rotation.multiply(rotation.multiply(turned, rotation.inverse(old))[:, None], world[:, below])


def _yaw(rotations: Array) -> Array:
    forward = rotation.rotate(rotations, (0.0, 0.0, 1.0))
    return np.asarray(np.arctan2(forward[..., 0], forward[..., 2]))
