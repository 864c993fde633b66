"""What an avatar does: the scene that was asked for, its film, and both for an avatar of an earlier job, without a capture."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

import cv2
import numpy as np

from engine.avatar.acting import Scene, film
from engine.avatar.avatar import Avatar, with_fewer_triangles
from engine.avatar.earlier_avatar import read_avatar
from engine.avatar.face_performance import acting_clip, capture_performance
from engine.avatar.options import CAPTURE_OPTIONS, AvatarOptions
from engine.avatar.writing import write_avatar
from engine.errors import InputError
from engine.export.still import write_still, write_thumbnail
from engine.export.videos.encoders import VideoTarget
from engine.export.videos.video import VideoWriter
from engine.kind import Given
from engine.media.excerpt import Excerpt
from engine.motion.arms.arms_outside import arms_outside
from engine.motion.arms.solid_body import solid_body
from engine.motion.clip import Clip
from engine.motion.edit import in_place, repeat_loop
from engine.motion.files.reading import read_motion
from engine.motion.library import built_in
from engine.motion.retargeting.joint_map import lost_warning
from engine.motion.retargeting.retarget import retarget
from engine.run import Run
from engine.run_report import write_report

AVATAR_ANIMATING_STAGES = {"read_avatar": 0.2, "capture_face": 1.0, "write_avatar": 1.0, "animate": 2.0}
"""The stages of an avatar that is there already, and their usual share of the time."""


def animate_avatar(inputs: Mapping[str, Given], options: AvatarOptions, out: Path, run: Run) -> None:
    """Have the `avatar` of an earlier job do what a `motion` or a `driver` does. Leaves its files in `out`, but for what comes of a
    capture; they hold the new clip.

    Raises
    ------
    InputError : `avatar_and_clips`, `option_needs_clips`; what reading avatar, motion and driver raises.
    """
    path, motion, driver = (file_of(inputs, name) for name in ("avatar", "motion", "driver"))
    assert path is not None
    _require_no_capture(inputs, options)
    run.plan(AVATAR_ANIMATING_STAGES)
    with run.timed("read_avatar"):
        avatar = _as_wanted(read_avatar(path), options)
    scene = chosen_scene(avatar, motion, driver, options, run)
    with run.timed("write_avatar"):
        write_avatar(out, avatar, scene, options, run)
    write_animation(out, avatar, scene, options, run, poster=True)
    mesh = avatar.mesh
    write_report(
        out / "report.json",
        "avatar",
        run,
        inputs={"avatar": {"size": [mesh.texture.shape[1], mesh.texture.shape[0]]}},
        quality={
            "height_m": round(float(np.ptp(mesh.vertices[:, 1])), 4),
            "triangles": float(len(mesh.triangles)),
        },
    )


def chosen_scene(avatar: Avatar, motion: Path | None, driver: Path | None, options: AvatarOptions, run: Run) -> Scene:
    """What the animation shows: a driver's face, or a motion by a file or a name."""
    skeleton, fps = avatar.mesh.skeleton, options.fps
    clip: Clip
    if motion is not None:
        source = read_motion(motion, options.motion_clip)
        carried = retarget(source, skeleton, options.motion_joints, fps=fps)
        if lost := lost_warning(source, carried.mapping):
            run.warn("motion_joints_unmapped", lost)
        clip = replace(carried.clip, name="motion")
    else:
        clip = built_in(options.motion, skeleton, fps)
    clip = arms_outside(solid_body(avatar.mesh), clip)
    if driver is None:
        return Scene(clip)
    with run.timed("capture_face"):
        performance = capture_performance(Excerpt(driver, fps, None, run.limits), run.tick, run.warn)
    return Scene(acting_clip(skeleton, performance, in_place(clip)), performance.units)


def write_animation(
    out: Path, avatar: Avatar, scene: Scene, options: AvatarOptions, run: Run, poster: bool = False
) -> None:
    """`animation.mp4` and, where there are no better ones, `poster.jpg`, its first frame, and that as `thumbnail.jpg`."""
    shown = scene
    if scene.expressions is None:
        frames = max(1, round(options.seconds * options.fps))
        shown = Scene(repeat_loop(scene.clip, frames))
    with run.timed("animate"), video_writer(out / "animation.mp4", options, run) as writer:
        for index, frame in enumerate(film(avatar.mesh, avatar.morphs, shown, options.size)):
            if poster and index == 0:
                write_still(out / "poster.jpg", frame, run.mark_synthetic)
                write_thumbnail(out / "thumbnail.jpg", frame, run.mark_synthetic)
            writer.write(frame)
            run.tick(index / len(shown.clip.rotations))


def video_writer(path: Path, options: AvatarOptions, run: Run) -> VideoWriter:
    """What writes a video of the size and the rate of the options."""
    return VideoWriter(VideoTarget(path, options.size, options.fps, "mp4", synthetic=run.mark_synthetic))


def file_of(inputs: Mapping[str, Given], name: str) -> Path | None:
    """The file that was given for an input that takes one."""
    given = inputs.get(name)
    assert given is None or isinstance(given, Path)
    return given


def _require_no_capture(inputs: Mapping[str, Given], options: AvatarOptions) -> None:
    """Refuse what an avatar that is there already cannot have any more."""
    if given := [name for name in ("body", "head", "more") if name in inputs]:
        raise InputError(
            "avatar_and_clips",
            f"An avatar of an earlier job was given, and a clip of a person ({given[0]}): give one or the other.",
        )
    usual = AvatarOptions()
    if set_ones := [name for name in CAPTURE_OPTIONS if getattr(options, name) != getattr(usual, name)]:
        raise InputError(
            "option_needs_clips",
            f"The option {set_ones[0]} is about clips of a person, and there are none beside an avatar of an earlier job: leave it"
            " out, or revise that job.",
        )


def _as_wanted(avatar: Avatar, options: AvatarOptions) -> Avatar:
    """The avatar with a texture and triangles as the options allow at most."""
    mesh, morphs = with_fewer_triangles(avatar.mesh, avatar.morphs, options.triangles)
    if max(mesh.texture.shape[:2]) > options.texture_size:
        scale = options.texture_size / max(mesh.texture.shape[:2])
        smaller = cv2.resize(mesh.texture, None, fx=scale, fy=scale, interpolation=cv2.INTER_AREA)
        mesh = replace(mesh, texture=np.asarray(smaller, np.uint8))
    return Avatar(mesh, morphs, avatar.filmed)
