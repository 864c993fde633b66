"""What the character does: a built-in clip or a file's, carried over to its skeleton, and stepped into from the picture."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np
from scipy.spatial.transform import Rotation

from engine.character.measures import pose as posed_vertices
from engine.character.rigging import Character
from engine.errors import InputError
from engine.motion.clip import Clip
from engine.motion.edit import in_place, keep
from engine.motion.library import built_in
from engine.motion.reading import read_motion
from engine.motion.retarget import retarget
from engine.motion.step_out import step_out

NEAREST = 0.3
"""How near to the camera the film lets the person come, as a share of the distance at which they are pictured."""
LONGEST = 60.0
"""Seconds of a file's motion that are used, at most."""


@dataclass(frozen=True)
class Played:
    """The clips of a character: `film`, from the pictured pose into the motion, is what the video shows; `all` are those
    that are written with it; `joints` says which joint of a file's motion moves which, `{ours: the motion's}`."""

    film: Clip
    all: tuple[Clip, ...]
    joints: Mapping[str, str] = field(default_factory=dict)


def choose_motion(
    character: Character,
    start: Clip,
    name: str,
    file: Path | None,
    kept: Sequence[str],
    seconds: float,
    fps: float,
    joints: Mapping[str, str | None] | None = None,
    file_clip: str | None = None,
) -> Played:
    """The character's clips at `fps` frames a second, beginning from the pose `start`; parts of the body that are `kept`
    stay as they are there. `joints` overrides which joint of a file's motion moves which, `file_clip` which of its animations is played.

    Raises
    ------
    InputError : what reading and mapping a file's motion may raise.
    """
    skeleton = character.mesh.skeleton
    mapping: dict[str, str] = {}
    if file is None:
        clip = built_in(name, skeleton, fps)
    else:
        clip, mapping = _carried_over(character, file, fps, joints, file_clip)
    length = seconds if clip.loops else None
    stepped = step_out(skeleton, start, clip, length=length)
    if kept:
        clip, stepped = (keep(skeleton, one, start, list(kept)) for one in (clip, stepped))
    arrived = np.flatnonzero(stepped.root[:, 2] > (1 - NEAREST) * character.eye[2])
    until = min(seconds, arrived[0] / fps) if len(arrived) else seconds
    film = replace(_cut(stepped, until), name="step_out")
    idle = built_in("idle", skeleton, fps)
    clips = [character.pictured, film, clip, replace(in_place(clip), name=f"{clip.name}_in_place")]
    if clip.name != "idle":
        clips.append(idle)
    return Played(film, tuple(clips), mapping)


def posed_by_hand(character: Character, pose: Mapping[str, tuple[float, float, float]]) -> Clip:
    """The pictured pose with joints turned on, degrees about x, y and z: its lowest point is as high as it was.

    Raises
    ------
    InputError : `unknown_joint`.
    """
    rotations = character.pictured.rotations.copy()
    for name, degrees in pose.items():
        if name not in character.mesh.skeleton.names:
            names = ", ".join(character.mesh.skeleton.names[:22])
            raise InputError(
                "unknown_joint", f"The character has no joint “{name[:40]}”: choose of {names}, ...", ("pose",)
            )
        joint = character.mesh.skeleton.index(name)
        turned = Rotation.from_quat(rotations[0, joint]) * Rotation.from_euler("xyz", degrees, degrees=True)
        rotations[0, joint] = turned.as_quat()
    posed = replace(character.pictured, name="posed", rotations=rotations)
    lowest = [posed_vertices(character, clip)[:, 1].min() for clip in (character.pictured, posed)]
    return replace(posed, root=posed.root + np.array([0, lowest[0] - lowest[1], 0], np.float32))


def _carried_over(
    character: Character, file: Path, fps: float, joints: Mapping[str, str | None] | None, clip_name: str | None
) -> tuple[Clip, dict[str, str]]:
    carried = retarget(read_motion(file, clip_name), character.mesh.skeleton, joints, fps=fps)
    clip = carried.clip
    if len(clip.rotations) < 1:
        raise InputError("motion_empty", "The motion has no frames: send one that has.", ("motion",))
    return replace(_cut(clip, LONGEST), name="motion"), carried.mapping


def _cut(clip: Clip, seconds: float) -> Clip:
    frames = max(1, round(seconds * clip.fps))
    if len(clip.rotations) <= frames:
        return clip
    return replace(clip, rotations=clip.rotations[:frames], root=clip.root[:frames], loops=False)
