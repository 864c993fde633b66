"""Feet that stand are held: they neither slide nor sink.

While a foot stands, its ball has one place on the ground. The foot rolls over it: toes up, it turns about the heel;
heel up, about the ball; between, it lies flat. The leg is then bent to it by inverse kinematics, and where a leg is too
short, the hips are lowered. Before and after, the foot goes over into its own way within a fifth of a second (Kovar,
Schreiner and Gleicher 2002, section 4; the rolling foot is ours).
"""

from __future__ import annotations

import itertools
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from engine.geometry.rigging.skeleton import Skeleton
from engine.motion import rotation
from engine.motion.clip import Clip, loop_step
from engine.motion.feet.foot_contact import (
    REFERENCE_LEG_METRES,
    Contacts,
    FeetReport,
    find_contacts,
    floor_height,
    sinking_depth,
    sliding_speed,
    sole_places,
    true_runs,
)
from engine.motion.feet.legs import HeldFoot, ankle_over_ball, hip_lowering, set_legs
from engine.motion.feet.sole import Sole, leg_length, soles
from engine.motion.kinematics import local_rotations, place_joints, world_rotations

Array = NDArray[np.float64]

BLEND_SECONDS = 0.2
"""Seconds in which a foot goes over from its own way to its place on the ground, and back."""

MAX_FLAT_PITCH, MAX_FLAT_ROLL = np.radians(4), np.radians(12)
"""A standing foot tilted less than this is meant to lie flat."""

MIN_PIVOT_ANGLE = np.radians(15)
"""A standing foot that turns by more is meant to turn, about its ball."""


def hold_feet(
    skeleton: Skeleton, clip: Clip, hold: bool = True, contacts: Contacts | None = None, floor: float | None = None
) -> tuple[Clip, FeetReport]:
    """The clip with its ground at y = 0 and its feet held, and how well they stand.

    `hold` false only measures, and sets the ground. `contacts` (F, 2) says when the feet stand, `floor` (metres) where
    the ground is: without them they are found. The clip may loop; then feet are held across its end.
    """
    leg = leg_length(skeleton)
    if clip.loops and len(clip.rotations) > 2:
        return _hold_loop(skeleton, clip, hold, contacts, floor)
    points = sole_places(skeleton, clip)
    ground = floor_height(points, clip.fps) if floor is None else floor
    clip = replace(clip, root=(np.asarray(clip.root, np.float64) - [0, ground, 0]).astype(np.float32))
    if hold:
        clip_level = _level_feet(skeleton, clip, leg)
        if floor is None:
            again = floor_height(sole_places(skeleton, clip_level), clip.fps)
            clip_level = replace(clip_level, root=(clip_level.root - np.array([0, again, 0])).astype(np.float32))
        clip = clip_level
    before = sole_places(skeleton, clip)
    stands = find_contacts(before, clip.fps, leg) if contacts is None else contacts
    held = _hold(skeleton, clip, stands) if hold else clip
    after = sole_places(skeleton, held)
    return held, FeetReport(
        sliding_before=sliding_speed(before, stands, clip.fps),
        sliding_after=sliding_speed(after, stands, clip.fps),
        sinking_before=sinking_depth(before),
        sinking_after=sinking_depth(after),
        standing=float(stands.any(1).mean()),
    )


def _hold_loop(
    skeleton: Skeleton, clip: Clip, hold: bool, contacts: Contacts | None, floor: float | None
) -> tuple[Clip, FeetReport]:
    """Hold three rounds of the loop and keep the one in the middle."""
    frames = len(clip.rotations)
    travel = np.asarray(clip.root[-1], np.float64) + loop_step(clip) - clip.root[0]
    thrice = replace(
        clip,
        loops=False,
        rotations=np.concatenate([clip.rotations] * 3),
        root=np.concatenate([clip.root + (turn * travel).astype(np.float32) for turn in range(3)]),
    )
    stands = None if contacts is None else np.concatenate([contacts] * 3)
    held, report = hold_feet(skeleton, thrice, hold, stands, floor)
    middle = slice(frames, 2 * frames)
    root = held.root[middle] - travel.astype(np.float32)
    return replace(clip, rotations=held.rotations[middle], root=root), report


def _level_feet(skeleton: Skeleton, clip: Clip, leg: float) -> Clip:
    """Feet turned by one angle for the whole clip, such that they are level in the middle of standing: rest poses know
    little about feet."""
    world = world_rotations(skeleton.parents, clip.rotations)
    places = place_joints(skeleton.parents, skeleton.offsets(), world, clip.root)
    for sole in soles(skeleton):
        ankle = places[:, sole.joints[2]]
        speed = np.linalg.norm(np.gradient(ankle, axis=0), axis=-1) * clip.fps if len(ankle) > 1 else np.zeros(1)
        low = ankle[:, 1] < np.percentile(ankle[:, 1], 10) + 0.04 * leg / REFERENCE_LEG_METRES
        still = np.flatnonzero(low & (speed < 0.25 * leg / REFERENCE_LEG_METRES))
        if len(still) < 3:
            continue
        joint, toe = sole.joints[2:]
        _, tilt = _yaw_and_tilt(world[still, joint], sole)
        pitch, roll = np.median(tilt @ sole.lateral), np.median(tilt @ sole.forward)
        level = rotation.from_vector(
            -(np.clip(pitch, -0.4, 0.4) * sole.lateral + np.clip(roll, -0.3, 0.3) * sole.forward)
        )
        world[:, joint] = rotation.multiply(world[:, joint], level)
        if toe >= 0:
            world[:, toe] = rotation.multiply(world[:, toe], level)
    return replace(clip, rotations=local_rotations(skeleton.parents, world).astype(np.float32))


def _yaw_and_tilt(rotations: Array, sole: Sole) -> tuple[Array, Array]:
    """How far feet (F, 4) are turned about the vertical, radians (F,), and the rest as rotation vectors (F, 3)."""
    forward = rotation.rotate(rotations, sole.forward)
    yaw = np.arctan2(forward[..., 0], forward[..., 2]) - np.arctan2(sole.forward[0], sole.forward[2])
    return yaw, rotation.to_vector(rotation.multiply(rotation.about("y", -yaw), rotations))


def _hold(skeleton: Skeleton, clip: Clip, contacts: Contacts) -> Clip:
    world = world_rotations(skeleton.parents, clip.rotations)
    root = np.asarray(clip.root, np.float64)
    places = place_joints(skeleton.parents, skeleton.offsets(), world, root)
    feet = []
    for side, sole in enumerate(soles(skeleton)):
        ankle, toe = sole.joints[2:]
        rotations = world[:, ankle]
        own = HeldFoot(rotations, world[:, toe] if toe >= 0 else rotations, places[:, ankle], np.zeros(len(root)))
        foot = _plant(sole, own, contacts[:, side], clip.fps)
        depth = -sole.points(foot.ankle, foot.rotations, foot.toes)[..., 1].min(-1)
        foot.ankle = foot.ankle + np.maximum(depth, 0)[:, None] * [0, 1, 0]
        feet.append((sole, foot))
    root = root - hip_lowering(feet, places, clip.fps)[:, None] * [0, 1, 0]
    set_legs(world, place_joints(skeleton.parents, skeleton.offsets(), world, root), feet)
    rotations = local_rotations(skeleton.parents, world)
    return replace(clip, rotations=rotations.astype(np.float32), root=root.astype(np.float32))


def _plant(sole: Sole, own: HeldFoot, stands: NDArray[np.bool_], fps: float) -> HeldFoot:
    """The foot's way with the ball at one place in each span of standing."""
    frames = len(stands)
    yaw, tilt = _yaw_and_tilt(own.rotations, sole)
    yaw = np.unwrap(yaw)
    pitch, roll = _flattened(tilt @ sole.lateral, MAX_FLAT_PITCH), _flattened(tilt @ sole.forward, MAX_FLAT_ROLL)
    rotations, toes, ankle = own.rotations.copy(), own.toes.copy(), own.ankle.copy()
    pieces = true_runs(stands)
    for first, last in pieces:
        here = slice(first, last + 1)
        heading = yaw[here]
        if np.ptp(heading) < MIN_PIVOT_ANGLE:
            heading = np.full(last - first + 1, np.median(heading))
        level = rotation.about("y", heading)
        tilted = pitch[here, None] * sole.lateral + roll[here, None] * sole.forward
        rotations[here] = rotation.multiply(level, rotation.from_vector(tilted))
        lifted = np.minimum(pitch[here, None], 0) * sole.lateral
        toes[here] = rotation.multiply(level, rotation.from_vector(lifted))
        from_ball = ankle_over_ball(sole, rotations[here], level, pitch[here])
        anchor = np.median(own.ankle[here] - from_ball, axis=0) * [1, 0, 1]
        ankle[here] = anchor + from_ball
    held = np.zeros(frames)
    for first, last in pieces:
        held[first : last + 1] = 1
    return _blend(own, HeldFoot(rotations, toes, ankle, held), pieces, fps)


def _flattened(angles: Array, flat: float) -> Array:
    return np.asarray(np.sign(angles) * np.maximum(np.abs(angles) - flat, 0))


def _blend(own: HeldFoot, planted: HeldFoot, pieces: list[tuple[int, int]], fps: float) -> HeldFoot:
    """Between spans of standing, what was changed at their ends fades away over `BLEND_SECONDS` seconds."""
    frames = len(own.ankle)
    reach = max(round(BLEND_SECONDS * fps), 1)
    weights, moves = np.zeros((frames, 1)), np.zeros((frames, 3))
    bends, toe_bends = np.zeros((frames, 3)), np.zeros((frames, 3))
    edges = [(-1, -1), *pieces, (frames, frames)]
    for before, after in itertools.pairwise(edges):
        gap = range(before[1] + 1, after[0])
        for frame in gap:
            for edge, distance, exists in (
                (before[1], frame - before[1], before[1] >= 0),
                (after[0], after[0] - frame, after[0] < frames),
            ):
                span = min(reach, len(gap)) + 1
                if exists and distance < span:
                    weight = 0.5 + 0.5 * np.cos(np.pi * distance / span)
                    weights[frame] += weight
                    moves[frame] += weight * (planted.ankle[edge] - own.ankle[edge])
                    bends[frame] += weight * _change(own.rotations[edge], planted.rotations[edge])
                    toe_bends[frame] += weight * _change(own.toes[edge], planted.toes[edge])
    over = np.maximum(weights, 1)
    free = planted.held == 0
    rotations, toes, ankle = planted.rotations.copy(), planted.toes.copy(), planted.ankle.copy()
    ankle[free] = (own.ankle + moves / over)[free]
    rotations[free] = rotation.multiply(rotation.from_vector(bends / over), own.rotations)[free]
    toes[free] = rotation.multiply(rotation.from_vector(toe_bends / over), own.toes)[free]
    return HeldFoot(rotations, toes, ankle, np.maximum(planted.held, np.minimum(weights[:, 0], 1)))


def _change(old: Array, new: Array) -> Array:
    return rotation.to_vector(rotation.multiply(new, rotation.inverse(old)))
