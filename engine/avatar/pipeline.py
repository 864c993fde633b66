"""Realistic Virtual Humans from Smartphone Videos (Wenninger, Achenbach, Bartl, Latoschik, Botsch; VRST 2020), stage by stage."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np

from engine.avatar.acting import Scene
from engine.avatar.animating import chosen_scene, file_of, video_writer, write_animation
from engine.avatar.avatar import Avatar, assemble
from engine.avatar.capture.cameras import ClipCameras
from engine.avatar.capture.chosen_frames import ChosenFrames, choose_frames
from engine.avatar.capture.coverage import coverage
from engine.avatar.frame_sheet import write_frame_sheets
from engine.avatar.further_clips import onto_body, with_further
from engine.avatar.interim_previews import write_fitted_shape, write_small_texture
from engine.avatar.landmarks.given import GivenLandmark, given_landmarks
from engine.avatar.options import AvatarOptions
from engine.avatar.registration.fitted_template import FittedTemplate
from engine.avatar.registration.models import load_models
from engine.avatar.stages import (
    ClipScan,
    find_attachments,
    find_cameras,
    find_landmarks,
    fit_template,
    in_body_s_world,
    in_metres,
    measure_cloud,
    placed_frames,
    scan_clip,
    stitch_texture,
)
from engine.avatar.turntable import turntable
from engine.avatar.writing import WrittenCameras, write_avatar, write_cameras
from engine.body.parts import BODY_PARTS, vertex_parts
from engine.errors import InputError
from engine.export.ply import write_ply
from engine.export.still import write_first_impression, write_still
from engine.geometry.point_clouds.point_cloud import PointCloud, joined, thinned
from engine.geometry.registration.rigid import Similarity
from engine.kind import Given
from engine.run import Run
from engine.run_report import write_report

STAGES = {
    "choose_frames": 2.0,
    "find_cameras": 4.0,
    "find_landmarks": 2.0,
    "measure_cloud": 6.0,
    "fit_template": 2.0,
    "find_attachments": 0.5,
    "stitch_texture": 3.0,
    "capture_face": 0.5,
    "write_avatar": 1.0,
    "turntable": 1.0,
    "animate": 1.0,
}
"""The stages and their usual share of the time."""
STAGES_PER_CLIP = ("choose_frames", "find_landmarks", "measure_cloud")
"""The stages that come once for each clip."""
TURN_SECONDS = 6.0
"""Of the turntable."""
PREVIEW_SPACING_METRES = 0.006
"""Metres between the points of `preview.ply`, which pages show: one or two megabytes."""

MAX_FURTHER_CLIPS = 4
"""Further clips, at most: each takes its minutes."""
UNMEASURED_CODES = frozenset({"person_not_measured"})
"""What makes a clip beside the body's, whose cameras were found, one that is not used: the body alone is an avatar, too."""

Clipped = tuple[ChosenFrames, ClipScan]
"""A clip: its frames, and what they measured, metres."""


def make_avatar(inputs: Mapping[str, Given], options: AvatarOptions, out: Path, run: Run) -> None:
    """Make an avatar of the person in the clips `body`, `head` and `more`; leaves the artifacts of the contract in `out`."""
    body, head, motion, driver = (file_of(inputs, name) for name in ("body", "head", "motion", "driver"))
    more = inputs.get("more", ())
    assert body is not None and isinstance(more, tuple)
    if len(more) > MAX_FURTHER_CLIPS:
        raise InputError(
            "too_many_clips", f"Give {MAX_FURTHER_CLIPS} further clips at most: those that show most.", ("more",)
        )
    run.plan(STAGES, dict.fromkeys(STAGES_PER_CLIP, (1 if head is None else 2) + len(more)))
    if head is None:
        run.warn(
            "head_clip_missing", "Without a clip of the head, its shape and its texture are as good as the body's."
        )

    chosen = [
        run.stage("choose_frames", choose_frames, path, count, name, run.limits, run.tick, run.warn)
        for name, path, count in (("body", body, options.body_frames), ("head", head, options.head_frames))
        if path is not None
    ]
    beside = tuple(
        run.stage("choose_frames", choose_frames, path, options.more_frames, "more", run.limits, run.tick, run.warn)
        for path in more
    )
    for early in write_frame_sheets(out, dict(zip(("body", "head"), chosen, strict=False)), run.mark_synthetic):
        run.publish(early)
    left_out = (options.body_frames_left_out, options.head_frames_left_out)
    chosen = [
        frames.without(some, name) for frames, some, name in zip(chosen, left_out, ("body", "head"), strict=False)
    ]
    for early in write_first_impression(out, chosen[0].picture(0, 1280), None, run.mark_synthetic):
        run.publish(early)
    lenses = (options.body_lens, options.head_lens)
    near_frames = chosen[1] if head else None
    found = run.stage("find_cameras", find_cameras, chosen[0], near_frames, beside, lenses, run.warn, run.tick)
    given = given_landmarks(options.landmarks, chosen[0].indices, placed_frames(found.body))
    grown = in_metres(options.height_m)
    clips = [_scanned(chosen[0], found.body, given, grown, True, run)]
    for early in _write_capture(out, {"body": clips[0]})[1:]:  # written again once the head's have joined them
        run.publish(early)
    clips += _scanned_if_measured([(chosen[-1], found.head if head else None)], "head_not_measured", grown, run)
    further = [
        (frames, onto_body(scan, clips[0][1]))
        for frames, scan in _scanned_if_measured(
            list(zip(beside, found.further, strict=True)), "further_not_measured", grown, run
        )
    ]
    near = clips[1][1] if len(clips) > 1 else None
    whole = with_further(clips[0][1], [scan for _, scan in further])
    fitted = run.stage("fit_template", fit_template, whole, near, run.check)
    for notice in fitted.notices:
        run.warn(notice.code, notice.message)
    human = load_models()
    run.publish(write_fitted_shape(out, human.template, fitted))
    if options.height_m is None:
        run.warn(
            "height_guessed", "How tall the person is was not said: the avatar's size is that of an average person."
        )
    worn = run.stage("find_attachments", find_attachments, fitted, whole, near, run.check)
    texture = run.stage("stitch_texture", stitch_texture, fitted, worn, clips, further, options.texture_size, run.check)
    run.publish(write_small_texture(out, texture.texture, run.mark_synthetic))
    scans = in_body_s_world([scan for _, scan in clips], fitted)
    shown = {name: (frames, scan) for name, (frames, _), scan in zip(("body", "head"), clips, scans, strict=False)}
    shown |= {f"more_{number}": one for number, one in enumerate(further, 1)}
    avatar = assemble(human.template, human.rig, fitted, worn, texture.texture, options.triangles)
    scene = chosen_scene(avatar, motion, driver, options, run)
    with run.timed("write_avatar"):
        write_avatar(out, avatar, scene, options, run)
        _write_capture(out, shown)
    _write_films(out, avatar, scene, options, run)
    height = float(np.ptp(fitted.rest[human.template.vertices_of("body"), 1]))
    write_report(
        out / "report.json",
        "avatar",
        run,
        inputs={
            name: {
                "size": [frames.size[1], frames.size[0]],
                "frames": frames.indices.tolist(),
                "placed": len(scan.placed),
            }
            for name, (frames, scan) in {**dict(zip(("body", "head"), clips, strict=False)), **shown}.items()
        },
        quality={
            "height_m": round(height, 4),
            "points": float(sum(len(scan.dense.cloud) for _, scan in shown.values())),
            "seen_share": round(texture.seen_share, 4),
            "triangles": float(len(avatar.mesh.triangles)),
            "largest_coefficient": round(float(np.abs(fitted.coefficients).max()), 2),
        },
        more={"eyes_seen": texture.eyes_seen, "coverage": _coverage(fitted, whole.dense.cloud)},
    )


def _scanned(
    frames: ChosenFrames,
    cameras: ClipCameras,
    given: tuple[GivenLandmark, ...],
    grown: Similarity,
    whole: bool,
    run: Run,
) -> Clipped:
    """A clip of the `whole` person or of a part with its cloud and landmarks, some `given` by hand, as large as the person is
    (`grown`)."""
    seen = run.stage("find_landmarks", find_landmarks, frames, cameras, whole, run.warn, run.tick)
    dense = run.stage("measure_cloud", measure_cloud, frames, cameras, seen, run.tick)
    return frames, scan_clip(frames, seen, dense, given, whole).moved(grown)


def _scanned_if_measured(
    placed: Sequence[tuple[ChosenFrames, ClipCameras | None]], code: str, grown: Similarity, run: Run
) -> list[Clipped]:
    """Those clips beside the body's that have cameras, and of which enough is measured; of the others `code` warns."""
    found = []
    for frames, cameras in placed:
        if cameras is None:
            continue
        try:
            found.append(_scanned(frames, cameras, (), grown, False, run))
        except InputError as refused:
            if refused.code not in UNMEASURED_CODES:
                raise
            run.warn(code, f"A clip beside that of the body is not used. {refused.detail}")
    return found


def _coverage(fitted: FittedTemplate, cloud: PointCloud) -> dict[str, float]:
    """Which share of each part of the body a cloud shows."""
    human = load_models()
    part = vertex_parts(human.rig)
    skin = np.zeros(len(part), np.bool_)
    skin[human.skin.vertices] = True
    shown = coverage(fitted.vertices, {name: skin & (part == k) for k, name in enumerate(BODY_PARTS)}, cloud)
    return {name: round(share, 3) for name, share in shown.items()}


def _write_capture(out: Path, clips: Mapping[str, Clipped]) -> tuple[Path, Path, Path]:
    """`points.ply`, `preview.ply`, a thin one of it, and `cameras.json`, all in the world of the fitted template; their paths."""
    written = []
    for name, (frames, scan) in clips.items():
        indices, seconds = frames.indices[scan.placed].tolist(), frames.seconds[scan.placed].tolist()
        written.append(WrittenCameras(name, indices, seconds, scan.cameras))
    points, preview, cameras_path = (out / name for name in ("points.ply", "preview.ply", "cameras.json"))
    cloud = joined([scan.dense.cloud for _, scan in clips.values()])
    write_ply(points, cloud)
    write_ply(preview, thinned(cloud, PREVIEW_SPACING_METRES))
    write_cameras(cameras_path, written)
    return points, preview, cameras_path


def _write_films(out: Path, avatar: Avatar, scene: Scene, options: AvatarOptions, run: Run) -> None:
    """`turntable.mp4`, `animation.mp4`, and `poster.jpg`, the turntable's first frame."""
    with run.timed("turntable"), video_writer(out / "turntable.mp4", options, run) as writer:
        for index, frame in enumerate(turntable(avatar.mesh, avatar.filmed, options.size, TURN_SECONDS, options.fps)):
            if index == 0:
                write_still(out / "poster.jpg", frame, run.mark_synthetic)
            writer.write(frame)
            run.tick(index / (TURN_SECONDS * options.fps))
    write_animation(out, avatar, scene, options, run)
