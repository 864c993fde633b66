"""Clips cut, joined and changed: in place or travelling, parts kept as pictured, one after another."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import gaussian_filter1d

from engine.motion import rotation
from engine.motion.clip import Clip
from engine.motion.foot_contact import sole_places
from engine.motion.foot_hold import hold_feet
from engine.motion.kinematics import local_rotations, place_joints, world_rotations
from engine.motion.legs import HeldFoot, set_legs
from engine.motion.resampling import loop_step, resample
from engine.motion.skeleton import Skeleton
from engine.motion.sole import soles

__all__ = [
    "BODY_PARTS",
    "closed",
    "concatenate",
    "in_place",
    "keep",
    "moved",
    "repeated",
    "resample",
    "travel",
    "travelling",
]

Array = NDArray[np.float64]

_ARM = ("Shoulder", "Arm", "ForeArm", "Hand")
_LEG = ("UpLeg", "Leg", "Foot", "ToeBase")

BODY_PARTS: dict[str, tuple[str, ...]] = {
    "head": ("Neck", "Head"),
    "torso": ("Spine", "Spine1", "Spine2"),
    "left_arm": tuple(f"Left{part}" for part in _ARM),
    "right_arm": tuple(f"Right{part}" for part in _ARM),
    "left_leg": tuple(f"Left{part}" for part in _LEG),
    "right_leg": tuple(f"Right{part}" for part in _LEG),
}
"""What can be kept as pictured, and its joints; fingers go with their arm. Besides: `arms` and `legs`, both sides."""


def in_place(clip: Clip) -> Clip:
    """The clip without its travel over the ground: a loop without its even way, another clip without the way that is
    left when everything quicker than a second is smoothed out. What the body sways stays."""
    root = np.asarray(clip.root, np.float64)
    if clip.loops:
        way = travel(clip) * (np.arange(len(root)) / len(root))[:, None]
    else:
        way = gaussian_filter1d(root, 0.5 * clip.fps, axis=0, mode="nearest")
        way -= way[0]
    return replace(clip, root=(root - way * [1, 0, 1]).astype(np.float32))


def travel(clip: Clip) -> Array:
    """(3,) how far a loop's root gets in one round, metres; level."""
    return np.asarray((clip.root[-1] - clip.root[0] + loop_step(clip)) * [1, 0, 1], np.float64)


def closed(clip: Clip, degrees: float = 3.0) -> Clip:
    """The clip as a loop, if its last frame shows the first frame's pose again: that frame is left out then."""
    if clip.loops or len(clip.rotations) < 8:
        return clip
    apart = rotation.angle(rotation.multiply(rotation.inverse(clip.rotations[0]), clip.rotations[-1]))
    if np.degrees(apart).max() > degrees or abs(clip.root[0, 1] - clip.root[-1, 1]) > 0.02:
        return clip
    return replace(clip, rotations=clip.rotations[:-1], root=clip.root[:-1], loops=True)


def travelling(skeleton: Skeleton, clip: Clip) -> Clip:
    """A clip that walks in place, walking: the root goes back the way that the lowest sole goes over the ground."""
    points = sole_places(skeleton, clip)
    if clip.loops:
        points = np.concatenate([points, points[:1]])
    steps = np.diff(points, axis=0).reshape(len(points) - 1, 6, 3)
    heights = points[:-1, ..., 1].reshape(-1, 6)
    weights = np.exp(-(heights - heights.min(1, keepdims=True)) / 0.01)
    step = -(steps * weights[..., None]).sum(1) / weights.sum(1)[:, None] * [1, 0, 1]
    step = gaussian_filter1d(step, 0.06 * clip.fps, axis=0, mode="wrap" if clip.loops else "nearest")
    way = np.concatenate([np.zeros((1, 3)), np.cumsum(step, 0)])[: len(clip.root)]
    return hold_feet(skeleton, replace(clip, root=(clip.root + way).astype(np.float32)))[0]


def keep(skeleton: Skeleton, clip: Clip, pictured: Clip, parts: Sequence[str]) -> Clip:
    """The clip with some parts of the body as in the pictured pose (the first frame of `pictured`), seen from the part
    that carries them. With both legs kept, hips and root stay as pictured as well; with one, it is dragged along.

    Raises
    ------
    ValueError : there is no such part in `BODY_PARTS`.
    """
    wanted = {part for name in parts for part in _parts(name)}
    joints = {joint for part in wanted for joint in BODY_PARTS[part]}
    rotations, root = clip.rotations.copy(), clip.root.copy()
    if {"left_leg", "right_leg"} <= wanted:
        joints.add("Hips")
        root[:] = pictured.root[0]
    for index, name in enumerate(skeleton.names):
        finger = any(name.startswith(f"{side}Hand") and f"{side}Hand" in joints for side in ("Left", "Right"))
        if name in joints or finger:
            rotations[:, index] = pictured.rotations[0, index]
    kept = replace(clip, rotations=rotations, root=root)
    legs = [leg in wanted for leg in ("left_leg", "right_leg")]
    return _dragging(skeleton, clip, kept, legs.index(True)) if legs.count(True) == 1 else kept


def _dragging(skeleton: Skeleton, clip: Clip, kept: Clip, side: int) -> Clip:
    """`kept`, whose leg on one side (0 left, 1 right) is not the clip's, with its lowest sole as high as the clip's is. Where
    that raises the body, the other foot stays where it is in the clip, as far as its leg reaches."""
    lowest, wanted = (sole_places(skeleton, one)[..., 1].min((1, 2)) for one in (kept, clip))
    up = np.array([0.0, 1.0, 0.0])
    root = kept.root + (wanted - lowest)[:, None] * up
    world = world_rotations(skeleton.parents, kept.rotations)
    places = place_joints(skeleton.parents, skeleton.offsets(), world, root)
    sole = soles(skeleton)[1 - side]
    ankle, toe = sole.joints[2:]
    there = places[:, ankle] - np.maximum(wanted - lowest, 0)[:, None] * up
    set_legs(world, places, [(sole, HeldFoot(world[:, ankle], world[:, toe], there, np.ones(len(root))))])
    leg = [joint for joint in sole.joints if joint >= 0]
    rotations = kept.rotations.copy()
    rotations[:, leg] = local_rotations(skeleton.parents, world)[:, leg]
    return replace(kept, rotations=rotations, root=root.astype(np.float32))


def _parts(name: str) -> tuple[str, ...]:
    if name in ("arms", "legs"):
        return f"left_{name[:-1]}", f"right_{name[:-1]}"
    if name not in BODY_PARTS:
        raise ValueError(f"there is no part {name!r}: choose among {', '.join(BODY_PARTS)}, arms, legs")
    return (name,)


def repeated(clip: Clip, frames: int, start: int = 0) -> Clip:
    """`frames` frames of a loop from frame `start` on, travelling on from round to round; it loops no more. A clip that
    does not loop stays in its last frame."""
    wanted = start + np.arange(frames)
    if not clip.loops:
        chosen = np.minimum(wanted, len(clip.rotations) - 1)
        return replace(clip, rotations=clip.rotations[chosen], root=clip.root[chosen])
    rounds, chosen = np.divmod(wanted, len(clip.rotations))
    root = clip.root[chosen] + rounds[:, None] * travel(clip)
    return replace(clip, rotations=clip.rotations[chosen], root=root.astype(np.float32), loops=False)


def moved(clip: Clip, turn: float, start: Array) -> Clip:
    """The clip turned by `turn` radians about the vertical and moved over the ground, so that its root begins above
    `start` (3,)."""
    about = rotation.about("y", turn)
    rotations = clip.rotations.copy()
    rotations[:, 0] = rotation.multiply(about, rotations[:, 0])
    root = rotation.rotate(about, clip.root)
    root += (np.asarray(start, np.float64) - root[0]) * [1, 0, 1]
    return replace(clip, rotations=rotations, root=root.astype(np.float32))


def concatenate(skeleton: Skeleton, clips: Sequence[Clip], seconds: float = 0.4) -> Clip:
    """Clips one after another, each beginning where and whither the one before ends, faded over `seconds`, feet held.

    Raises
    ------
    ValueError : no clips.
    """
    if not clips:
        raise ValueError("there is no clip to play")
    whole = replace(clips[0], loops=False)
    for clip in clips[1:]:
        whole = _crossfade(whole, resample(clip, whole.fps), seconds)
    return whole if len(clips) == 1 else hold_feet(skeleton, whole, floor=0.0)[0]


def _crossfade(first: Clip, second: Clip, seconds: float) -> Clip:
    frames = int(np.clip(round(seconds * first.fps), 1, min(len(first.rotations), len(second.rotations)) - 1))
    begin = len(first.rotations) - frames
    turn = _heading(first.rotations[begin, 0]) - _heading(second.rotations[0, 0])
    second = moved(second, turn, first.root[begin])
    share = (np.arange(frames) + 0.5) / frames
    share = share * share * (3 - 2 * share)
    rotations = rotation.slerp(
        first.rotations[begin:],
        second.rotations[:frames],
        np.broadcast_to(share[:, None], (frames, first.rotations.shape[1])),
    )
    root = first.root[begin:] * (1 - share[:, None]) + second.root[:frames] * share[:, None]
    return replace(
        first,
        name=f"{first.name}, {second.name}",
        rotations=np.concatenate([first.rotations[:begin], rotations, second.rotations[frames:]]).astype(np.float32),
        root=np.concatenate([first.root[:begin], root, second.root[frames:]]).astype(np.float32),
        loops=False,
    )


def _heading(hips: NDArray[np.floating]) -> float:
    forward = rotation.rotate(hips, (0.0, 0.0, 1.0))
    return float(np.arctan2(forward[0], forward[2]))
