"""Bringing Portraits to Life (Averbuch-Elor, Cohen-Or, Kopf, Cohen; ACM TOG 36, 2017), stage by stage."""

from __future__ import annotations

import json
import os
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

import numpy as np

from engine.export.video import VideoWriter
from engine.media.image import write_image
from engine.perception.landmarks import fiducials
from engine.perception.models import matting_model
from engine.portrait.driver import DriverTrack, track_driver
from engine.portrait.loop import close_loop
from engine.portrait.neutral import choose_neutral_frame
from engine.portrait.options import PortraitOptions
from engine.portrait.registration import register_track
from engine.portrait.render import render
from engine.portrait.target import Layers, TargetFace, find_target_face, separate_layers
from engine.run import Run, write_report

STAGES = {"find_face": 1.0, "track_driver": 12.0, "register_driver": 4.0, "separate_layers": 1.0, "animate": 15.0}
"""The stages and their usual share of the time."""


def animate_portrait(
    inputs: Mapping[str, Path | tuple[Path, ...]], options: PortraitOptions, out: Path, run: Run
) -> None:
    """Animate `inputs["image"]` by `inputs["driver"]`; leaves the artifacts of the contract in `out`."""
    image, driver = inputs["image"], inputs["driver"]
    assert isinstance(image, Path) and isinstance(driver, Path)
    limits = run.limits
    run.plan(STAGES)
    framing = options.framing()
    target = run.stage("find_face", find_target_face, image, framing, limits, run.warn)
    write_image(out / "preview.jpg", target.rgb)
    run.publish(out / "preview.jpg")
    model = matting_model(os.environ)
    layers_beside = run.beside("separate_layers", separate_layers, target, model, model and model.file.sha256)
    track = run.stage(
        "track_driver", track_driver, driver, options.fps, options.trim, limits, run.tick, run.warn, shared=True
    )
    neutral = choose_neutral_frame(track, target.mesh, options.neutral_frame)
    registration = run.stage("register_driver", register_track, track, neutral, run.tick, shared=True)
    track = replace(track, meshes=registration.meshes)
    layers = layers_beside()
    if options.loop:
        track = close_loop(track)
    with run.timed("animate"):
        name = _write_animation(track, neutral, target, layers, options, driver, out, run)
    _write_landmarks(out / "landmarks.json", target, track, neutral)
    height, width = target.rgb.shape[:2]
    write_report(
        out / "report.json",
        "portrait",
        run,
        inputs={
            "size": [width, height],
            "fps": track.fps,
            "frames": len(track),
            "faces": [[round(float(v), 1) for v in box] for box in target.faces],
            "neutral_frame": neutral,
            "driver_size": list(track.size),
            "animation": name,
        },
        quality={"driver_face_share": float(track.found.mean())},
    )


def _write_animation(
    track: DriverTrack, neutral: int, target: TargetFace, layers: Layers,
    options: PortraitOptions, driver: Path, out: Path, run: Run,
) -> str:  # fmt: skip
    height, width = target.rgb.shape[:2]
    name = "animation." + {"png": "zip"}.get(options.format, options.format)
    sound = driver if options.sound and track.has_sound else None
    if options.sound and sound is None:
        run.warn("driver_has_no_sound", "The driver has no sound to keep.")
    with VideoWriter(
        out / name, (width, height), track.fps, options.format, sound=sound, sound_trim=options.trim, loop=options.loop
    ) as writer:
        for index, frame in enumerate(render(track, neutral, target, layers, options)):
            writer.write(frame[..., :3], frame[..., 3] / np.float32(255) if frame.shape[2] == 4 else None)
            if index == neutral:
                write_image(out / "poster.jpg", frame[..., :3])
            run.tick((index + 1) / len(track))
    return name


def _write_landmarks(path: Path, target: TargetFace, track: DriverTrack, neutral: int) -> None:
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
