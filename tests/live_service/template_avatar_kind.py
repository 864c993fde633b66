"""An avatar that is made without a capture, small enough for tests: the template itself, as if it had been fitted to somebody.

Its inputs, options and files are those of avatars. Frames are its clips'; the cloud is the template's vertices; both films are
the turntable. Of somebody under a metre it finds no joints; with a giant, of over 2.3 metres, it is busy until it is canceled.
"""

from __future__ import annotations

import time
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

import numpy as np
from pydantic import BaseModel
from template_avatar import fitted_template

from engine.avatar import KIND as AVATAR
from engine.avatar import AvatarOptions
from engine.avatar.acting import Scene
from engine.avatar.animating import animate_avatar
from engine.avatar.avatar import assemble
from engine.avatar.capture.chosen_frames import choose_frames
from engine.avatar.frame_sheet import write_frame_sheets
from engine.avatar.interim_previews import write_fitted_shape, write_small_texture
from engine.avatar.turntable import turntable
from engine.avatar.worn import no_attachments
from engine.avatar.writing import WrittenCameras, write_avatar, write_cameras
from engine.body.rig import HUMAN_RIG
from engine.body.template import load_rig, load_template
from engine.errors import InputError
from engine.export.ply import write_ply
from engine.export.still import write_first_impression, write_still
from engine.export.videos.encoders import VideoTarget
from engine.export.videos.video import VideoWriter
from engine.geometry.camera import Camera
from engine.geometry.point_clouds.point_cloud import PointCloud
from engine.kind import Given, Needs
from engine.motion.library import built_in
from engine.run import Run
from engine.run_report import write_report


def _work(inputs: Mapping[str, Given], options: BaseModel, out: Path, run: Run) -> None:
    assert isinstance(options, AvatarOptions)
    if "avatar" in inputs:
        animate_avatar(inputs, options, out, run)
        return
    clips = {
        name: choose_frames(given, 16, name, run.limits)
        for name in ("body", "head")
        if isinstance(given := inputs.get(name), Path)
    }
    for path in write_frame_sheets(out, clips, run.mark_synthetic):
        run.publish(path)
    body = clips["body"].without(options.body_frames_left_out, "body")
    if options.height_m is not None and options.height_m < 1:
        raise InputError(
            "landmarks_needed", "Joints were not found.", ("landmarks",), {"doubtful": ["LeftElbow", "RightKnee"]}
        )
    for path in write_first_impression(out, body.picture(0), None, run.mark_synthetic):
        run.publish(path)
    template, rig, fitted = load_template(), load_rig(HUMAN_RIG), fitted_template()
    skin = fitted.rest[template.vertices_of("body")]
    normals = np.tile(np.array([0, 0, 1], np.float32), (len(skin), 1))
    write_ply(out / "preview.ply", PointCloud(skin, normals, np.full(skin.shape, 150, np.uint8)))
    places = [(2.2 * np.sin(angle), 1.2, 2.2 * np.cos(angle)) for angle in np.linspace(0, 5.5, len(body))]
    cameras = [Camera(place, 900.0, (359.5, 639.5), (1280, 720)).aimed(place, (0, 1, 0)) for place in places]
    write_cameras(out / "cameras.json", [WrittenCameras("body", body.indices.tolist(), body.seconds.tolist(), cameras)])
    for name in ("preview.ply", "cameras.json"):
        run.publish(out / name)
    run.publish(write_fitted_shape(out, template, fitted))

    texture = np.full((64, 64, 3), (190, 150, 130), np.uint8)
    run.publish(write_small_texture(out, texture, run.mark_synthetic))
    while options.height_m is not None and options.height_m > 2.3:
        run.check()
        time.sleep(0.05)
    avatar = assemble(template, rig, fitted, no_attachments(), texture, options.triangles)
    scene = Scene(built_in(options.motion, avatar.mesh.skeleton, 10.0))
    write_avatar(out, avatar, scene, options, run)
    frames = list(turntable(avatar.mesh, avatar.filmed, (180, 320), 0.4, 10.0))
    write_still(out / "poster.jpg", frames[0], False)
    for name in ("turntable", "animation"):
        with VideoWriter(VideoTarget(out / f"{name}.mp4", (180, 320), 10.0, "mp4", synthetic=False)) as writer:
            for frame in frames:
                writer.write(frame)
    if "head" not in clips:
        run.warn("head_clip_missing", "Without a clip of the head, its shape is as good as the body's.")
    write_report(
        out / "report.json",
        "avatar",
        run,
        inputs={name: {"frames": chosen.indices.tolist()} for name, chosen in clips.items()},
        quality={},
        more={},
    )


def _prepare() -> None:
    load_template()  # a job may not read the user's cache, in which it lies
    load_rig(HUMAN_RIG)


KIND = replace(AVATAR, work=_work, prepare=_prepare, rehearse=None, needs=Needs(seconds=120, memory_mb=3000, cores=1))
