"""Bringing Portraits to Life (Averbuch-Elor, Cohen-Or, Kopf, Cohen; ACM TOG 36, 2017), stage by stage."""

from __future__ import annotations

import json
import os
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from engine.export.still import write_first_impression, write_still
from engine.export.video import VideoWriter
from engine.face_animation.driver import DriverTrack, track_driver
from engine.face_animation.fine_details import DetailRegion, RatioStrip, detail_region, keep_ratio_images
from engine.face_animation.layers import Layers, separate_layers
from engine.face_animation.loop import close_loop
from engine.face_animation.misfit import Misfit
from engine.face_animation.neutral import NeutralFrame, choose_neutral_frame, warn_of_unrest
from engine.face_animation.registration import register_track
from engine.face_animation.render import render
from engine.face_animation.rig import Rig, rig_target
from engine.face_animation.second_look import Glances, glance_at_driver, look_again
from engine.face_animation.target_face import TargetFace
from engine.kind import Candidates, Given
from engine.perception.landmarks import fiducials
from engine.perception.models import matting_model
from engine.portrait.choice import choose_driver
from engine.portrait.options import PortraitOptions
from engine.portrait.target import in_pixels, look_for_face
from engine.run import Beside, Run, write_report

STAGES = {
    "find_face": 1.0,
    "track_driver": 12.0,
    "register_driver": 3.0,
    "ratio_images": 3.0,
    "glance_at_driver": 0.5,
    "separate_layers": 1.0,
    "rig_target": 0.5,
    "look_again": 1.0,
    "animate": 12.0,
}
"""The stages and their usual share of the time."""


def animate_portrait(
    inputs: Mapping[str, Given], options: PortraitOptions, out: Path, run: Run, face: Beside[TargetFace] | None = None
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
    tracking = follow(driver, *follows) if isinstance(driver, Path) else None
    prepared = prepare_target(face or look_for_face(image, options, run), out, run)
    target = prepared.face
    choice: dict[str, object] = {}
    if isinstance(driver, Candidates):
        chosen = choose_driver(target, driver, run)
        driver, choice = chosen.path, {"driver_chosen": chosen.name, "driver_scores": chosen.scores}
    performed = analyse_driver(
        tracking or follow(driver, *follows),
        lambda track: choose_neutral_frame(track, target.mesh, options.neutral_frame),
        run,
        loop=options.loop,
    )
    track, neutral = performed.track, performed.neutral
    warn_of_unrest(performed.choice, run.warn)
    height, width = target.rgb.shape[:2]
    misfit = performed.look_again(target, prepared.details(), options, run)
    layers, rig = prepared.layers(), prepared.rig()
    with run.timed("animate"):
        acting, keep_alpha = options.acting(), options.format != "mp4"
        frames = render(track, neutral, performed.ratios, target, layers, rig, acting, misfit, keep_alpha)
        _write_animation(frames, (width, height), track, neutral, options, driver, out, run)
    write_landmarks(out / "landmarks.json", target, track, neutral)
    write_report(
        out / "report.json",
        "portrait",
        run,
        inputs={
            "size": [width, height],
            "fps": track.fps,
            "frames": len(track),
            "faces": in_pixels(target.faces),
            "neutral_frame": neutral,
            "neutral_frame_reason": performed.choice.reason,
            "driver_size": list(track.size),
            "driver_faces": in_pixels(track.faces),
            "animation": options.animation,
            **choice,
        },
        quality={"driver_face_share": float(track.found.mean())},
    )


@dataclass(frozen=True)
class PreparedTarget:
    """A target's `face`, and what is made of it on another core meanwhile: the region that `details` go to, the `layers`
    and the `rig`."""

    face: TargetFace
    details: Beside[DetailRegion]
    layers: Beside[Layers]
    rig: Beside[Rig]


def prepare_target(looking: Beside[TargetFace], out: Path, run: Run) -> PreparedTarget:
    """Everything that depends on the picture alone; leaves `preview.jpg` and `thumbnail.jpg`."""
    face = looking()
    for early in write_first_impression(out, face.rgb, face.alpha, run.mark_synthetic):
        run.publish(early)
    model = matting_model(os.environ)
    details = run.beside("detail_region", detail_region, face.rgb, face.mesh)
    layers = run.beside("separate_layers", separate_layers, face, model, model and model.file.sha256)
    return PreparedTarget(face, details, layers, run.beside("rig_target", rig_target, face, layers, details))


@dataclass(frozen=True)
class Performed:
    """A driver's performance: its `track` on the skin, the `choice` of its neutral frame, its `ratios`, the `glances` at it."""

    track: DriverTrack
    choice: NeutralFrame
    ratios: RatioStrip
    glances: Glances

    @property
    def neutral(self) -> int:
        """The neutral frame's index."""
        return self.choice.frame

    def look_again(self, target: TargetFace, details: DetailRegion, options: PortraitOptions, run: Run) -> Misfit:
        """What is amiss where a target acts this out."""
        seen = self.track, self.neutral, self.glances, self.ratios
        return run.stage("look_again", look_again, *seen, target, details, options.acting(), run.tick, run.idle_cores)


def follow(
    driver: Path, fps: float | None, trim: tuple[float, float] | None, face_index: int, run: Run
) -> Beside[DriverTrack]:
    """Begin to follow one of the driver's faces, which nothing else has to wait for."""
    given = driver, fps, trim, run.limits, face_index
    return run.beside("track_driver", track_driver, *given, run.tick, run.warn, shared=True)


def analyse_driver(
    tracking: Beside[DriverTrack], neutral_of: Callable[[DriverTrack], NeutralFrame], run: Run, loop: bool = False
) -> Performed:
    """Everything that depends on the driver alone, but for the choice of its neutral frame."""
    track = tracking.once()
    choice = neutral_of(track)
    neutral = choice.frame
    registered = run.stage("register_driver", register_track, track, neutral, run.tick, track.meshes, shared=True)
    track = replace(track, meshes=registered.meshes)
    if loop:
        track = close_loop(track)
    glances = run.beside("glance_at_driver", glance_at_driver, track, neutral, shared=True)
    ratios = run.stage("ratio_images", keep_ratio_images, track, neutral, run.tick, shared=True)
    return Performed(track, choice, ratios, glances())


def _write_animation(
    frames: Iterator[NDArray[np.uint8]], size: tuple[int, int], track: DriverTrack, neutral: int,
    options: PortraitOptions, driver: Path, out: Path, run: Run,
) -> None:  # fmt: skip
    sound = driver if options.sound and track.has_sound else None
    if options.sound and sound is None:
        run.warn("driver_has_no_sound", "The driver has no sound to keep.")
    with VideoWriter(
        out / options.animation,
        size,
        track.fps,
        options.format,
        sound=sound,
        sound_trim=options.trim,
        loop=options.loop,
        frames=len(track),
        times=None if track.even else track.times,
        synthetic=run.mark_synthetic,
        warn=run.warn,
    ) as writer:
        for index, frame in enumerate(frames):
            writer.write(frame[..., :3], frame[..., 3] / np.float32(255) if frame.shape[2] == 4 else None)
            if index == neutral:
                write_still(out / "poster.jpg", frame[..., :3], run.mark_synthetic)
            run.tick((index + 1) / len(track))


def write_landmarks(path: Path, target: TargetFace, track: DriverTrack, neutral: int) -> None:
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
