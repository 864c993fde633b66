"""What Makes Tom Hanks Look Like Tom Hanks (Suwajanakorn, Seitz, Kemelmacher-Shlizerman; ICCV 2015), stage by stage."""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from engine.errors import InputError
from engine.export.encoders import VideoTarget
from engine.export.still import write_first_impression, write_still
from engine.export.video import VideoWriter
from engine.face_animation.driver_tracking.neutral import choose_neutral_frame, warn_if_never_at_rest
from engine.face_animation.stages import follow_driver
from engine.kind import Given
from engine.media.excerpt import Excerpt
from engine.media.video import read_video
from engine.perception.face_track.track import FaceTrack
from engine.perception.identity.backend import descriptor_distances, descriptor_name
from engine.persona.collection.coverage import rare, shown_expressions, shown_sides
from engine.persona.collection.face_sheet import write_faces
from engine.persona.collection.photos import Photos, read_photos
from engine.persona.collection.sorting import Choice
from engine.persona.film import beside, puppet_frames
from engine.persona.motion.performance import perform
from engine.persona.options import PersonaOptions
from engine.persona.persona import Persona, read_persona, write_persona
from engine.persona.stages import SortedFaces, find_faces_of_photos, learn, sort_faces, texture_width
from engine.persona.texture.expression_weights import expression_points, expression_weights
from engine.run import Run
from engine.run_report import write_report

STAGES = {
    "read_photos": 1.0,
    "find_faces": 6.0,
    "learn_persona": 3.0,
    "write_persona": 1.0,
    "track_driver": 3.0,
    "perform": 3.0,
    "animate": 3.0,
}
"""The stages and their usual share of the time."""


def make_persona(inputs: Mapping[str, Given], options: PersonaOptions, out: Path, run: Run) -> None:
    """Make a persona of `inputs["photos"]`, or take that of `inputs["persona"]`, and let it play `inputs["driver"]` where there is
    one; leaves the artifacts of the contract in `out`."""
    run.plan(STAGES)
    photos, kept, driver = inputs.get("photos", ()), inputs.get("persona"), inputs.get("driver")
    told: dict[str, object] = {}
    if isinstance(kept, Path):
        persona = read_persona(kept)
    else:
        assert isinstance(photos, tuple)
        persona, told = _learnt(photos, options, out, run)
    with run.timed("write_persona"):
        write_persona(out / "persona.npz", persona)
        average = average_texture(persona)
        write_still(out / "average.png", average, run.mark_synthetic)
        if not isinstance(driver, Path):
            write_still(out / "poster.jpg", average, run.mark_synthetic)
    if isinstance(driver, Path):
        told |= _animated(persona, driver, options, out, run)
    write_report(
        out / "report.json",
        "persona",
        run,
        inputs={"photos_used": len(persona), "texture_size": list(persona.frame.size[::-1]), **told},
        quality={"belief": float(persona.belief[:, persona.frame.face].mean() / 255)},
    )


def average_texture(persona: Persona) -> NDArray[np.uint8]:
    """(H, W, 3) the face at rest, of all photographs."""
    scale = persona.frame.scale
    at_rest = expression_points(persona.neutral[None]) * scale
    return persona.synthesis(expression_weights(at_rest, persona.points * scale))[0]


def _learnt(paths: Sequence[Path], options: PersonaOptions, out: Path, run: Run) -> tuple[Persona, dict[str, object]]:
    photos: Photos = run.stage("read_photos", read_photos, tuple(paths), run.limits, run.tick)
    if not len(photos):
        raise InputError(
            "no_photos", "None of the files is a photo: send pictures, or an archive of pictures.", ("photos",)
        )
    for early in write_first_impression(out, photos.picture(0), None, run.mark_synthetic):
        run.publish(early)
    described_by = descriptor_name(os.environ)
    found = run.stage("find_faces", find_faces_of_photos, photos, described_by, run.tick)
    choice = Choice(options.keep, options.leave_out)
    chosen = sort_faces(found, descriptor_distances(os.environ), choice, options.example)
    _tell_faces(out, photos, chosen, run)  # before anything is refused: its numbers are those of what mends it
    chosen.require_enough()
    width = options.texture_width or texture_width(chosen.kept)
    learnt = run.stage("learn_persona", learn, photos, chosen, options.keep, width, run.tick)
    if not learnt.used.all():
        chosen = chosen.without_covered(learnt.used)
        _tell_faces(out, photos, chosen, run)
        chosen.require_enough()
    expressions, sides = shown_expressions(chosen.kept), shown_sides(chosen.kept)
    if few := rare(expressions):
        run.warn(
            "expressions_rare",
            f"Few photos show: {few}. Where a driver does, what is nearest stands in for it: add photos that show it.",
        )
    told = {"photos": len(photos), "files_skipped": len(photos.skipped), "faces": len(chosen.faces)}
    return learnt.persona, {**told, "expressions": expressions, "sides": sides}


def _tell_faces(out: Path, photos: Photos, chosen: SortedFaces, run: Run) -> None:
    distances = chosen.whose.distance.tolist()
    for early in write_faces(out, photos, chosen.faces, chosen.reasons, distances, run.mark_synthetic):
        run.publish(early)


def _animated(persona: Persona, driver: Path, options: PersonaOptions, out: Path, run: Run) -> dict[str, object]:
    track = follow_driver(driver, options.fps, options.trim, options.driver_face_index, run).once()
    choice = choose_neutral_frame(track, persona.neutral.astype(np.float32), None)
    warn_if_never_at_rest(choice, run.warn)
    with run.timed("perform"):
        performance = perform(persona, track.meshes, choice.frame, run.tick)
    with run.timed("animate"):
        width, height = options.size
        alone = options.composite == "none"
        frames = puppet_frames(
            persona, performance, options.size if alone else (width // 2, height), options.background
        )
        if alone:
            _write_film(frames, track, driver, options, out, run)
        else:
            excerpt = Excerpt(driver, options.fps, options.trim, run.limits)
            filmed = read_video(excerpt.path, excerpt.fps, excerpt.trim, excerpt.limits)
            both = (beside(one.rgb, other, options.size) for one, other in zip(filmed, frames, strict=False))
            _write_film(both, track, driver, options, out, run)
    return {"frames": len(track), "fps": track.fps, "driver_size": list(track.size), "rest_frame": choice.frame}


def _write_film(
    frames: Iterator[NDArray[np.uint8]], track: FaceTrack, driver: Path, options: PersonaOptions, out: Path, run: Run
) -> None:
    sound = driver if options.sound and track.has_sound else None
    if options.sound and sound is None:
        run.warn("driver_has_no_sound", "The driver has no sound to keep.")
    target = VideoTarget(
        out / "animation.mp4",
        options.size,
        track.fps,
        sound=sound,
        sound_trim=options.trim,
        frames=len(track),
        times=None if track.even else track.times.tolist(),
        synthetic=run.mark_synthetic,
    )
    with VideoWriter(target, run.warn) as writer:
        for index, frame in enumerate(frames):
            writer.write(frame, None)
            if index == len(track) // 2:
                write_still(out / "poster.jpg", frame, run.mark_synthetic)
            run.tick((index + 1) / len(track))
