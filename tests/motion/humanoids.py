"""A skeleton by hand: the joints of our Mixamo rig, a person of 1.75 m in T-pose; and motions told by other skeletons."""

from __future__ import annotations

import numpy as np

from engine.geometry.rigging.skeleton import Skeleton
from engine.motion import rotation
from engine.motion.clip import Clip
from engine.motion.feet.legs import HeldFoot, set_legs
from engine.motion.feet.sole import soles
from engine.motion.files.source_motion import SourceMotion
from engine.motion.kinematics import local_rotations, place_joints, world_rotations

TRUNK = {
    "Hips": ("", (0.0, 0.97, 0.0)),
    "Spine": ("Hips", (0.0, 1.08, -0.005)),
    "Spine1": ("Spine", (0.0, 1.19, -0.01)),
    "Spine2": ("Spine1", (0.0, 1.31, -0.02)),
    "Neck": ("Spine2", (0.0, 1.46, -0.02)),
    "Head": ("Neck", (0.0, 1.55, 0.0)),
}
LEFT = {
    "UpLeg": ("Hips", (0.09, 0.92, 0.0)),
    "Leg": ("UpLeg", (0.09, 0.5, 0.01)),
    "Foot": ("Leg", (0.09, 0.08, -0.02)),
    "ToeBase": ("Foot", (0.1, 0.02, 0.11)),
    "Shoulder": ("Spine2", (0.05, 1.42, -0.01)),
    "Arm": ("Shoulder", (0.17, 1.42, -0.02)),
    "ForeArm": ("Arm", (0.44, 1.42, -0.02)),
    "Hand": ("ForeArm", (0.68, 1.42, -0.02)),
}
FINGERS = {"Thumb": 0.04, "Index": 0.025, "Middle": 0.0, "Ring": -0.02, "Pinky": -0.04}


def build_skeleton(fingers: bool = True, toes: bool = True, scale: float = 1.0) -> Skeleton:
    """The skeleton, with or without fingers and toes, of any height."""
    joints = dict(TRUNK)
    for side, sign in (("Left", 1), ("Right", -1)):
        for part, (parent, (x, y, z)) in LEFT.items():
            if toes or part != "ToeBase":
                above = parent if parent in TRUNK else side + parent
                joints[side + part] = (above, (sign * x, y, z))
        for finger, z in FINGERS.items() if fingers else ():
            for n in (1, 2, 3):
                above = f"{side}Hand" if n == 1 else f"{side}Hand{finger}{n - 1}"
                reach = 0.68 + (0.03 if finger == "Thumb" else 0.09) + 0.03 * (n - 1)
                joints[f"{side}Hand{finger}{n}"] = (above, (sign * reach, 1.42, z - 0.02))
    names = tuple(joints)
    return Skeleton(
        names=names,
        parents=np.array([names.index(parent) if parent else -1 for parent, _ in joints.values()], np.int32),
        heads=np.array([place for _, place in joints.values()], np.float32) * np.float32(scale),
    )


def told_by(
    skeleton: Skeleton,
    clip: Clip,
    turns: np.ndarray,
    world: np.ndarray,
    unit: float,
    rest: np.ndarray | None = None,
    prefix: str = "mixamorig:",
) -> SourceMotion:
    """The clip as another file would tell it: joints with axes of their own (`turns`, (J, 4) from ours), a world turned
    by `world` (4,), lengths in `unit` metres, and a pose at rest (J, 4: turns in the world from the T-pose)."""
    own = rotation.multiply(world, rotation.multiply(world_rotations(skeleton.parents, clip.rotations), turns))
    at_rest = rotation.identity(len(skeleton.names)) if rest is None else rest
    offsets = skeleton.offsets().astype(np.float64) / unit
    above = np.maximum(skeleton.parents, 0)
    offsets = rotation.rotate(rotation.inverse(turns[above]), offsets)
    translations = np.tile(offsets, (len(own), 1, 1))
    translations[:, 0] = rotation.rotate(world, clip.root / unit)
    return SourceMotion(
        name=clip.name,
        fps=clip.fps,
        names=tuple(prefix + name for name in skeleton.names),
        parents=skeleton.parents,
        rest_rotations=local_rotations(skeleton.parents, rotation.multiply(at_rest, turns)),
        rest_offsets=offsets,
        ends=np.full(offsets.shape, np.nan),
        rotations=local_rotations(skeleton.parents, own),
        translations=translations,
    )


def treadmill_walk(skeleton: Skeleton, speed: float, frames: int = 30, fps: float = 30.0) -> Clip:
    """A loop in place by hand: each foot stands for six tenths of the round, and goes back with the ground at `speed`
    metres a second, level and on y = 0; then it is lifted, and swings forward."""
    share = (np.arange(frames)[:, None] / frames + [0.0, 0.5]) % 1.0
    swing = np.clip((share - 0.6) / 0.4, 0, 1)
    ahead = np.where(share < 0.6, 0.5 - share / 0.6, swing - 0.5) * (0.6 * speed * frames / fps)
    return on_feet(skeleton, ahead, 0.12 * np.sin(np.pi * swing), 0.08, fps)


def on_feet(skeleton: Skeleton, ahead: np.ndarray, up: np.ndarray, lower: float, fps: float = 30.0) -> Clip:
    """A loop in place, the arms down, the hips `lower` than at rest, with level feet `ahead` and `up` (F, 2) of where
    they rest, metres, left and right."""
    frames = len(ahead)
    world = rotation.identity(frames, len(skeleton.names))
    for side, sign in (("Left", -1), ("Right", 1)):
        for part in ("Arm", "ForeArm", "Hand"):
            world[:, skeleton.index(side + part)] = rotation.about("z", sign * np.radians(75))
    root = np.tile(skeleton.heads[0].astype(np.float64) - [0, lower, 0], (frames, 1))
    places = place_joints(skeleton.parents, skeleton.offsets(), world, root)
    level, feet = rotation.identity(frames), []
    for side, sole in enumerate(soles(skeleton)):
        ankle = sole.ankle + np.stack([np.zeros(frames), up[:, side], ahead[:, side]], 1)
        feet.append((sole, HeldFoot(level, level, ankle, np.ones(frames))))
    set_legs(world, places, feet)
    rotations = local_rotations(skeleton.parents, world).astype(np.float32)
    return Clip("by hand", fps, rotations, root.astype(np.float32), loops=True)
