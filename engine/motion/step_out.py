"""Out of the picture: from the pose in which a person is pictured into a clip.

The person starts from rest: the clip's own time starts slowly. The foot on which the clip stands is put where the
person's foot is pictured, and stays; the other steps from its place into the clip's step. If the clip stands on both
feet, they step into their places one after the other. Everything else turns over by slerp; legs follow their feet by
inverse kinematics.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from engine.geometry.rigging.skeleton import Skeleton
from engine.motion import rotation
from engine.motion.clip import Clip
from engine.motion.edit import repeat_loop
from engine.motion.feet.foot_contact import find_contacts, sole_places, true_runs
from engine.motion.feet.legs import HeldFoot, hip_lowering, set_legs
from engine.motion.feet.sole import Sole, leg_length, soles
from engine.motion.interpolation import places_at, rotations_at
from engine.motion.kinematics import local_rotations, place_joints, world_rotations

Array = NDArray[np.float64]

STEP_LIFT = 0.08
"""Leg lengths that a foot is lifted in a step; less if the step is shorter than three times this."""

MAX_STEP_SECONDS = 0.45
"""Seconds of a step into place, at most."""


@dataclass(frozen=True)
class _Window:
    """When a foot goes from its pictured place to the clip's, seconds, and whether it is lifted on its way."""

    begin: float
    end: float
    lifted: bool


def step_out(
    skeleton: Skeleton,
    pictured: Clip,
    clip: Clip,
    seconds: float = 0.8,
    length: float | None = None,
    back: float = 0.0,
) -> Clip:
    """From the first frame of `pictured` into `clip`, at the clip's frame rate; frame 0 is the pictured pose exactly.

    Parameters
    ----------
    pictured : the pose with the root where it is pictured; soles near the ground y = 0.
    clip : it keeps its own facing. A loop is entered at the frame whose feet are most like the pictured ones, and plays
        one round after that; another clip is entered at its beginning, and plays to its end.
    seconds : how long it takes to be in the clip.
    length : seconds in all, where the default does not fit.
    back : metres by which the first steps lead away from the viewer, out of where the person is pictured.
    """
    fps, leg = clip.fps, leg_length(skeleton)
    round_ = repeat_loop(clip, 3 * len(clip.rotations)) if clip.loops else clip
    stands = find_contacts(sole_places(skeleton, round_), fps, leg)
    start = _best_start(skeleton, pictured, clip, stands, leg) if clip.loops else 0
    slow = 0.5 * seconds
    rest = (len(clip.rotations) if clip.loops else len(clip.rotations) - 1) / fps
    frames = round((length if length is not None else rest + slow) * fps) + 1
    times = np.arange(frames) / fps
    own_frames = start + np.maximum(_own_time(times, seconds), 0) * fps
    source = repeat_loop(clip, int(np.ceil(own_frames[-1])) + 2)
    played = replace(
        clip,
        rotations=rotations_at(np.asarray(source.rotations, np.float64), own_frames).astype(np.float32),
        root=places_at(np.asarray(source.root, np.float64), own_frames).astype(np.float32),
        loops=False,
    )
    contacts = np.concatenate([stands, np.repeat(stands[-1:], len(source.rotations), 0)])
    contacts = contacts[np.round(own_frames).astype(int)]
    played = _aligned(skeleton, pictured, played, contacts, back)
    blended = _blend(skeleton, pictured, played, contacts, seconds, leg)
    return replace(blended, name=f"step out, {clip.name}")


def _own_time(times: Array, seconds: float) -> Array:
    """The clip's time: its speed goes from 0 to 1 within `seconds`, as 3 u^2 - 2 u^3."""
    u = np.minimum(times / seconds, 1)
    return np.asarray(seconds * (u**3 - u**4 / 2) + np.maximum(times - seconds, 0))


def _best_start(skeleton: Skeleton, pictured: Clip, clip: Clip, stands: NDArray[np.bool_], leg: float) -> int:
    """The frame of a loop whose feet lie to the hips as the pictured ones do, some foot standing on for a while."""
    frames = len(clip.rotations)
    wanted = _feet_from_hips(skeleton, pictured)[0]
    feet = _feet_from_hips(skeleton, clip)
    cost = np.linalg.norm(feet - wanted, axis=-1).sum(-1) / leg
    ahead = max(round(0.25 * clip.fps), 1)
    lasting = np.stack([stands[f : f + ahead].all(0).any() for f in range(frames)])
    return int(np.argmin(cost + np.where(lasting, 0, 10)))


def _feet_from_hips(skeleton: Skeleton, clip: Clip) -> Array:
    """(F, 2, 3) the balls of the feet, seen from the hips, in leg's axes of the world."""
    return np.asarray(sole_places(skeleton, clip)[:, :, 1] - np.asarray(clip.root, np.float64)[:, None])


def _aligned(skeleton: Skeleton, pictured: Clip, played: Clip, contacts: NDArray[np.bool_], back: float) -> Clip:
    """The clip moved over the ground, so that the feet on which it begins to stand are where they are pictured, or as far
    behind that as the person steps `back`."""
    there = sole_places(skeleton, replace(pictured, rotations=pictured.rotations[:1], root=pictured.root[:1]))[0, :, 1]
    here = sole_places(skeleton, replace(played, rotations=played.rotations[:1], root=played.root[:1]))[0, :, 1]
    lasting = np.array([_stands_on(contacts[:, side]) for side in range(2)])
    if lasting.min() == len(contacts) or not lasting.any():
        shift = (there - here).mean(0)
    else:
        side = int(np.argmax(lasting))
        shift = there[side] - here[side]
    return replace(played, root=(played.root + shift * [1, 0, 1] - [0, 0, back]).astype(np.float32))


def _stands_on(stands: NDArray[np.bool_]) -> int:
    """For how many frames a foot stands from the beginning."""
    return int(np.argmin(stands)) if not stands.all() else len(stands)


def _windows(contacts: NDArray[np.bool_], gaps: Array, seconds: float, fps: float) -> list[_Window]:
    """When each foot leaves its pictured place. It leaves with its first step in the clip if that comes soon, else in a
    step of its own. Feet that are where they should be only settle."""
    windows: list[_Window] = []
    lasting = [_stands_on(contacts[:, side]) / fps for side in range(2)]
    both_wait = min(lasting) > seconds
    for side in range(2):
        if gaps[side] < 0.01:
            windows.append(_Window(0.0, seconds, False))
        elif both_wait:
            step = min(MAX_STEP_SECONDS, 0.48 * seconds)
            begin = 0.04 * seconds if side == int(np.argmax(gaps)) else 0.52 * seconds
            windows.append(_Window(begin, begin + step, True))
        elif lasting[side] > 0:
            step = min(MAX_STEP_SECONDS, max(lasting[side], 0.3))
            windows.append(_Window(0.0, step, True))
        else:
            landing = next((first / fps for first, _ in true_runs(contacts[:, side])), seconds)
            windows.append(_Window(0.0, max(landing, 0.3), True))
    return _in_turn(windows, lasting)


def _in_turn(windows: list[_Window], lasting: list[float]) -> list[_Window]:
    """Where both feet would leave their places at once, the one on which the clip stands longer waits for the other."""
    if not all(window.lifted for window in windows) or windows[0].begin != windows[1].begin:
        return windows
    later = int(np.argmax(lasting))
    begin, step = windows[1 - later].end, windows[later].end - windows[later].begin
    windows[later] = replace(windows[later], begin=begin, end=begin + step)
    return windows


def _blend(
    skeleton: Skeleton, pictured: Clip, played: Clip, contacts: NDArray[np.bool_], seconds: float, leg: float
) -> Clip:
    frames, fps = len(played.rotations), played.fps
    times = np.arange(frames) / fps
    share = _eased(times / seconds)
    rotations = rotation.slerp(
        np.broadcast_to(pictured.rotations[:1], played.rotations.shape),
        played.rotations,
        np.broadcast_to(share[:, None], played.rotations.shape[:2]),
    )
    root = pictured.root[:1] * (1 - share[:, None]) + played.root * share[:, None]
    world = world_rotations(skeleton.parents, rotations)
    places = place_joints(skeleton.parents, skeleton.offsets(), world, root)
    wanted = _tracks(skeleton, played)
    began = _tracks(skeleton, replace(pictured, rotations=pictured.rotations[:1], root=pictured.root[:1]))
    gaps = np.array([np.linalg.norm((a.toe - b.toe[:1])[0, [0, 2]]) for a, b in zip(wanted, began, strict=True)])
    feet = []
    for sole, clip_foot, own, window in zip(
        soles(skeleton), wanted, began, _windows(contacts, gaps, seconds, fps), strict=True
    ):
        feet.append((sole, _stepped(sole, own, clip_foot, window, times, leg)))
    root = root - hip_lowering(feet, places, fps)[:, None] * np.minimum(times / 0.2, 1)[:, None] * [0, 1, 0]
    set_legs(world, place_joints(skeleton.parents, skeleton.offsets(), world, root), feet)
    local = local_rotations(skeleton.parents, world).astype(np.float32)
    local[0] = pictured.rotations[0]
    return replace(played, rotations=local, root=root.astype(np.float32))


@dataclass(frozen=True)
class _Track:
    """Where the toe joint of a foot is (F, 3), and the world rotations of foot and toes (F, 4)."""

    toe: Array
    rotations: Array
    toes: Array


def _tracks(skeleton: Skeleton, clip: Clip) -> list[_Track]:
    world = world_rotations(skeleton.parents, clip.rotations)
    places = place_joints(skeleton.parents, skeleton.offsets(), world, clip.root)
    tracks = []
    for sole in soles(skeleton):
        ankle, toe = sole.joints[2:]
        rotations = world[:, ankle]
        joint = places[:, ankle] + rotation.rotate(rotations, sole.toe)
        tracks.append(_Track(joint, rotations, world[:, toe] if toe >= 0 else rotations))
    return tracks


def _stepped(sole: Sole, own: _Track, clip_foot: _Track, window: _Window, times: Array, leg: float) -> HeldFoot:
    """A foot on its way from its pictured place into the clip's."""
    u = np.clip((times - window.begin) / (window.end - window.begin), 0, 1)
    share = _eased(u)
    toe = own.toe * (1 - share[:, None]) + clip_foot.toe * share[:, None]
    end = int(np.searchsorted(times, window.end).clip(0, len(times) - 1))
    gap = float(np.linalg.norm((clip_foot.toe[end] - own.toe[0])[[0, 2]]))
    high = min(STEP_LIFT * leg, gap / 3) * np.sin(np.pi * u) ** 2 * window.lifted
    toe = toe + high[:, None] * [0, 1, 0]
    rotations = rotation.slerp(np.broadcast_to(own.rotations, clip_foot.rotations.shape), clip_foot.rotations, share)
    toes = rotation.slerp(np.broadcast_to(own.toes, clip_foot.toes.shape), clip_foot.toes, share)
    ankle = toe - rotation.rotate(rotations, sole.toe)
    depth = -sole.points(ankle, rotations, toes)[..., 1].min(-1)
    ankle = ankle + (np.maximum(depth, 0) * np.minimum(times / 0.2, 1))[:, None] * [0, 1, 0]
    return HeldFoot(rotations, toes, ankle, np.ones(len(times)))


def _eased(share: Array) -> Array:
    u = np.clip(share, 0, 1)
    return np.asarray(u * u * (3 - 2 * u))
