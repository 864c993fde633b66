"""What the character does: a built-in clip or a file's, carried over to its skeleton, and stepped into from the picture."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np
from scipy.spatial.transform import Rotation

from engine.character.film.framing import kept_in_frame
from engine.character.rig.measures import pose as posed_vertices
from engine.character.rig.rigging import Character
from engine.errors import InputError
from engine.geometry.camera import Camera
from engine.motion.arms.arms_outside import arms_outside
from engine.motion.arms.solid_body import SolidBody, solid_body
from engine.motion.beginning import beginning, length_warning
from engine.motion.clip import Clip
from engine.motion.edit import in_place, keep_pictured_parts, loop_travel
from engine.motion.files.reading import read_motion
from engine.motion.files.source_motion import SourceMotion
from engine.motion.library import CLIPS, built_in
from engine.motion.retargeting.retarget import retarget
from engine.motion.step_out import step_out

MIN_TRAVEL_METRES = 0.1
"""Metres: a loop that gets further than this in one round goes somewhere."""


@dataclass(frozen=True)
class Played:
    """The clips of a character.

    film : what the video shows, from the pictured pose into the motion.
    all : what is written with it, the chosen motion before the other built-in ones.
    joints : which joint of a file's motion moves which, `{ours: the motion's}`.
    """

    film: Clip
    all: tuple[Clip, ...]
    joints: Mapping[str, str] = field(default_factory=dict)


def motion_in_use(
    file: Path | None, clip: str | None, joints: Mapping[str, str | None], warn: Callable[[str, str], None]
) -> SourceMotion | None:
    """What is used of a file's motion, or of its animation `clip`; None without a file, where neither this nor `joints`
    means anything.

    Raises
    ------
    InputError : what reading a motion may raise.
    """
    if file is None:
        unused = [name for name, given in (("motion_joints", joints), ("motion_clip", clip)) if given]
        if unused:
            warn("motion_options_unused", f"{' and '.join(unused)}: of no use to a built-in motion, send a file.")
        return None
    motion = read_motion(file, clip)
    if too_long := length_warning(motion):
        warn("motion_cut", too_long)
    return beginning(motion)


@dataclass(frozen=True)
class MotionChoice:
    """What is played, and for how long."""

    name: str
    """The built-in motion's, where there is no other."""
    motion: SourceMotion | None
    """A file's."""
    kept: Sequence[str]
    """Parts of the body that stay as they are at the start."""
    seconds: float
    """Of film."""
    fps: float
    """Frames a second."""
    joints: Mapping[str, str | None] | None = None
    """Which joint of the file's motion moves which of the character's, where that is not to be found."""


def choose_motion(
    character: Character, camera_at: Callable[[float], Camera], start: Clip, choice: MotionChoice
) -> Played:
    """The character's clips, beginning from the pose `start`. In the film the person stays in the picture of
    `camera_at(second)`. The other built-in motions stay where they are.

    Raises
    ------
    InputError : what mapping a file's motion may raise.
    """
    skeleton, kept, seconds = character.mesh.skeleton, choice.kept, choice.seconds
    mapping: dict[str, str] = {}
    if choice.motion is None:
        clip = built_in(choice.name, skeleton, choice.fps)
    else:
        carried = retarget(choice.motion, skeleton, choice.joints, fps=choice.fps)
        clip, mapping = replace(carried.clip, name="motion"), carried.mapping
    body = solid_body(character.mesh)
    clip = arms_outside(body, clip)
    length = seconds if clip.loops else None

    def stepped(back: float) -> Clip:
        film = _lasting(step_out(skeleton, start, clip, length=length, back=back), seconds)
        return keep_pictured_parts(skeleton, film, start, list(kept)) if kept else film

    film = replace(kept_in_frame(character, camera_at, stepped), name="step_out")
    if kept:
        clip = keep_pictured_parts(skeleton, clip, start, list(kept))
    others = [_other_motion(body, start, other, kept) for other in CLIPS if other != clip.name]
    clips = [character.pictured, film, clip, replace(in_place(clip), name=_in_place_name(clip)), *others]
    return Played(film, tuple(clips), mapping)


def _other_motion(body: SolidBody, start: Clip, name: str, kept: Sequence[str]) -> Clip:
    """A built-in motion that was not chosen, for whoever plays the file: in one place, and at 30 frames a second, of
    whatever rate the film is, for players fill in between."""
    clip = arms_outside(body, built_in(name, body.skeleton))
    if kept:
        clip = keep_pictured_parts(body.skeleton, clip, start, list(kept))
    if clip.loops and np.linalg.norm(loop_travel(clip)) > MIN_TRAVEL_METRES:
        return replace(in_place(clip), name=_in_place_name(clip))
    return clip


def _in_place_name(clip: Clip) -> str:
    return f"{clip.name}_in_place"


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


def _lasting(clip: Clip, seconds: float) -> Clip:
    """The clip for just so long: cut, or its last pose held."""
    frames = np.minimum(np.arange(max(1, round(seconds * clip.fps))), len(clip.rotations) - 1)
    return replace(clip, rotations=clip.rotations[frames], root=clip.root[frames], loops=False)
