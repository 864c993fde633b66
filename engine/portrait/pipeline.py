"""Bringing Portraits to Life (Averbuch-Elor, Cohen-Or, Kopf, Cohen; ACM TOG 36, 2017), stage by stage."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from engine.export.still import write_first_impression, write_still
from engine.export.videos.encoders import VideoTarget
from engine.export.videos.video import VideoWriter
from engine.face_animation.animation import FaceAnimation, RegisteredDriver, RiggedTarget
from engine.face_animation.driver_tracking.neutral import choose_neutral_frame, warn_if_never_at_rest
from engine.face_animation.stages import analyse_driver, follow_driver, prepare_target
from engine.face_animation.target_face import TargetFace
from engine.kind import Candidates, Given
from engine.perception.face.landmarks import fiducials
from engine.perception.face_track.track import FaceTrack
from engine.portrait.driver_selection import choose_driver
from engine.portrait.options import PortraitOptions
from engine.portrait.target import in_pixels, look_for_face
from engine.run import ConcurrentStage, Run
from engine.run_report import write_report

STAGES = {
    "find_face": 1.0,
    "track_driver": 12.0,  # section 4: the face and the points around it, in every frame
    "register_driver": 3.0,
    "ratio_images": 3.0,  # section 6: creases
    "glance_at_driver": 0.5,
    "separate_layers": 1.0,
    "rig_target": 0.5,  # section 4: the warp, as far as it is the target's
    "look_again": 1.0,
    "animate": 12.0,  # sections 4 to 6: equation 1, the warp, creases, the inside of the mouth
}
"""The stages and their usual share of the time; `engine.face_animation` holds what they do."""


def animate_portrait(
    inputs: Mapping[str, Given],
    options: PortraitOptions,
    out: Path,
    run: Run,
    face: ConcurrentStage[TargetFace] | None = None,
) -> None:
    """Animate `inputs["image"]` by `inputs["driver"]`; leaves the artifacts of the contract in `out`. Whoever has begun to
    look for the picture's `face` hands it on."""
    image, driver = inputs["image"], inputs["driver"]
    assert isinstance(image, Path) and isinstance(driver, Path | Candidates)
    run.plan(STAGES)
    index = (
        options.driver_face_index if isinstance(driver, Path) else 0
    )  # candidates are compared by their largest face
    follows = options.fps, options.trim, index, run
    tracking = follow_driver(driver, *follows) if isinstance(driver, Path) else None
    target = first_impression(face or look_for_face(image, options, run), out, run)
    prepared = prepare_target(target, run)
    choice: dict[str, object] = {}
    if isinstance(driver, Candidates):
        chosen = choose_driver(target, driver, run)
        driver, choice = chosen.path, {"driver_chosen": chosen.name, "driver_scores": chosen.scores}
    performance = analyse_driver(
        tracking or follow_driver(driver, *follows),
        lambda track: choose_neutral_frame(track, target.mesh, options.neutral_frame),
        run,
        loop=options.loop,
    )
    track, neutral = performance.track, performance.neutral
    warn_if_never_at_rest(performance.choice, run.warn)
    residuals = performance.residuals_on(prepared, options.acting(), run)
    layers, rig = prepared.layers(), prepared.rig()
    with run.timed("animate"):
        follows_so, keeps_alpha = options.acting(), options.format != "mp4"
        animation = FaceAnimation(
            RiggedTarget(target, layers, rig),
            RegisteredDriver(track, neutral, residuals),
            follows_so,
            keep_alpha=keeps_alpha,
        )
        _write_animation(animation.frames(performance.ratios), target, track, neutral, options, driver, out, run)
    write_landmarks(out / "landmarks.json", target, track, neutral)
    write_report(
        out / "report.json",
        "portrait",
        run,
        inputs={
            "size": list(target.size),
            "fps": track.fps,
            "frames": len(track),
            "faces": in_pixels(target.faces),
            "neutral_frame": neutral,
            "neutral_frame_reason": performance.choice.reason,
            "driver_size": list(track.size),
            "driver_faces": in_pixels(track.faces),
            "animation": options.animation,
            **choice,
        },
        quality={"driver_face_share": float(track.found.mean())},
    )


def first_impression(looking: ConcurrentStage[TargetFace], out: Path, run: Run) -> TargetFace:
    """The target, once its face is found; leaves `preview.jpg` and `thumbnail.jpg`."""
    target = looking()
    for early in write_first_impression(out, target.rgb, target.alpha, run.mark_synthetic):
        run.publish(early)
    return target


def _write_animation(
    frames: Iterator[NDArray[np.uint8]], target: TargetFace, track: FaceTrack, neutral: int,
    options: PortraitOptions, driver: Path, out: Path, run: Run,
) -> None:  # fmt: skip
    sound = driver if options.sound and track.has_sound else None
    if options.sound and sound is None:
        run.warn("driver_has_no_sound", "The driver has no sound to keep.")
    with VideoWriter(
        VideoTarget(
            out / options.animation,
            target.size,
            track.fps,
            options.format,
            sound=sound,
            sound_trim=options.trim,
            loop=options.loop,
            frames=len(track),
            times=None if track.even else track.times.tolist(),
            synthetic=run.mark_synthetic,
        ),
        run.warn,
    ) as writer:
        for index, frame in enumerate(frames):
            writer.write(frame[..., :3], frame[..., 3] / np.float32(255) if frame.shape[2] == 4 else None)
            if index == neutral:
                write_still(out / "poster.jpg", frame[..., :3], run.mark_synthetic)
            run.tick((index + 1) / len(track))


def write_landmarks(path: Path, target: TargetFace, track: FaceTrack, neutral: int) -> None:
    """The target's 68 points in the pixels of the original picture, for correction by hand."""
    scale = target.place[0, 0]
    points = (fiducials(target.mesh[:, :2]) + 0.5 - target.place[:, 2]) / scale - 0.5
    document = {
        "size": list(target.original_size),
        "landmarks": np.round(points, 2).tolist(),
        "neutral_frame": neutral,
        "frames": len(track),
    }
    path.write_text(json.dumps(document) + "\n")
