"""A persona plays a driver, which is a video or a picture. A video becomes a film of the puppet, alone or beside it, or
of the person as a photograph shows them."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from engine.export.still import write_still
from engine.export.videos.encoders import VideoTarget
from engine.export.videos.video import VideoWriter
from engine.face_animation.driver_tracking.neutral import choose_neutral_frame, warn_if_never_at_rest
from engine.face_animation.stages import follow_driver
from engine.kind import Given
from engine.media.excerpt import Excerpt
from engine.media.sniff import IMAGE_TYPES, VIDEO_TYPES, is_still_webp, sniff
from engine.media.video import read_video
from engine.perception.expression.features import frontalise
from engine.perception.face_track.track import FaceTrack
from engine.persona.backdrop import backdrop
from engine.persona.composite.photo_performance import perform_photo
from engine.persona.film import beside, puppet_frames, size_beside
from engine.persona.motion.driver_rest import rest_of_frames
from engine.persona.motion.performance import perform
from engine.persona.options import PersonaOptions
from engine.persona.persona import Persona
from engine.persona.stages import rest_of_photos
from engine.persona.still import play_picture
from engine.run import Run


def with_composite(options: PersonaOptions, persona: Persona, behind: bool, run: Run) -> PersonaOptions:
    """The options with what is seen of this `persona`, where they leave it open. That is the puppet, if it is to stand
    before a picture that is `behind` it. Warns `puppet_alone` where the persona cannot be a photograph."""
    if options.composite != "auto":
        return options
    if behind:
        return options.model_copy(update={"composite": "none"})
    if persona.portrait is None:
        run.warn(
            "puppet_alone",
            "None of the photos shows half of a head, so the puppet is seen alone. Add a photo from before with hair and neck to see the person.",
        )
    return options.model_copy(update={"composite": "none" if persona.portrait is None else "photo"})


def is_picture(driver: Path) -> bool:
    """Whether a driver is one picture, and no video."""
    return sniff(driver) in IMAGE_TYPES - VIDEO_TYPES or is_still_webp(driver)


def animate_persona(
    persona: Persona, inputs: Mapping[str, Given], options: PersonaOptions, out: Path, run: Run
) -> dict[str, object]:
    """Let the puppet play `inputs["driver"]`, a video or a picture, whose face at rest `inputs["driver_photos"]` tell, if there are any;
    what the report says of it."""
    driver, photos, behind = inputs["driver"], inputs.get("driver_photos", ()), inputs.get("background_picture")
    assert isinstance(driver, Path) and isinstance(photos, tuple) and (behind is None or isinstance(behind, Path))
    if behind is not None and options.composite == "photo":
        run.warn(
            "background_unused",
            "A photo that acts keeps its own background: choose composite `none` or `side_by_side` to see the picture behind the puppet.",
        )
    if options.composite == "photo" and not is_picture(driver):
        if photos:
            run.warn(
                "driver_photos_unused",
                "A photo that acts begins with what it shows: the driver's frame nearest to that counts, and its photos do not.",
            )
        return _film_photo(persona, driver, options, out, run)
    rest = run.stage("find_driver_at_rest", rest_of_photos, photos, run.limits, run.tick).face if photos else None
    if is_picture(driver):
        return play_picture(persona, driver, rest, behind, options, out, run)
    return _play_video(persona, driver, rest, behind, options, out, run)


def _play_video(
    persona: Persona,
    driver: Path,
    rest: NDArray[np.float64] | None,
    behind: Path | None,
    options: PersonaOptions,
    out: Path,
    run: Run,
) -> dict[str, object]:
    plate = backdrop(options.background, options.size, behind, run.limits)
    track = follow_driver(driver, options.fps, options.trim, options.driver_face_index, run).once()
    told: dict[str, object] = {"frames": len(track), "fps": track.fps, "driver_size": list(track.size)}
    if rest is None:
        choice = choose_neutral_frame(track, persona.neutral.astype(np.float32), None)
        warn_if_never_at_rest(choice, run.warn)
        rest, told["rest_frame"] = rest_of_frames(frontalise(track.meshes), choice.frame), choice.frame
    with run.timed("perform"):
        performance = perform(persona, track.meshes, rest, run.tick)
    with run.timed("animate"):
        frames = puppet_frames(persona, performance, plate)
        if options.composite == "none":
            _write_film(frames, track, driver, options, out, run)
        else:
            excerpt = Excerpt(driver, options.fps, options.trim, run.limits)
            filmed = read_video(excerpt.path, excerpt.fps, excerpt.trim, excerpt.limits)
            both = (beside(one.rgb, other, options.background) for one, other in zip(filmed, frames, strict=False))
            size = size_beside((track.size[0], track.size[1]), options.size)
            _write_film(both, track, driver, options.model_copy(update={"size": size}), out, run)
            told["size"] = list(size)
    return told


def _film_photo(persona: Persona, driver: Path, options: PersonaOptions, out: Path, run: Run) -> dict[str, object]:
    played = perform_photo(persona, driver, options, run)
    with run.timed("animate"):
        _write_film(played.frames, played.track, driver, options.model_copy(update={"size": played.size}), out, run)
    track = played.track
    told = {"frames": len(track), "fps": track.fps, "driver_size": list(track.size), "rest_frame": played.rest}
    return {**told, "size": list(played.size)}


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
