"""A photograph of a persona follows a driver, from the driver's file to drawn frames."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from engine.errors import InputError
from engine.face_animation.acting_options import ActingOptions
from engine.face_animation.animation import FaceAnimation, Parts, RegisteredDriver, RiggedTarget
from engine.face_animation.driver_tracking.neutral import choose_neutral_frame, warn_if_never_at_rest
from engine.face_animation.skin_colour import is_grey
from engine.face_animation.stages import analyse_driver, follow_driver, prepare_target
from engine.face_animation.target_face import TargetFace
from engine.perception.face_track.track import FaceTrack
from engine.persona.composite.acting_mouth import acting_mouth
from engine.persona.composite.framing import framed
from engine.persona.composite.photo_film import act, photo_frames
from engine.persona.composite.portrait_selection import WHOLE_HEAD_SHARE, head_share
from engine.persona.composite.retouching import retouching_of
from engine.persona.options import PersonaOptions
from engine.persona.persona import Persona
from engine.persona.texture.expression_weights import SMOOTHING_FRAMES
from engine.run import Run

PHOTO_STAGES = {
    "register_driver": 3.0,
    "glance_at_driver": 0.5,
    "separate_layers": 1.0,
    "rig_target": 0.5,
    "look_again": 1.0,
}
"""The stages beside those of every persona, and their usual share of the time."""

STILL_STAGES = ("separate_layers", "rig_target")
"""Which of `PHOTO_STAGES` a driver's picture asks for."""

OWN_CREASES = Parts(details=False)
"""The driver's are not carried over: a strand of its hair on the forehead, or its brows' ridge, would be drawn on the person's."""


@dataclass(frozen=True)
class PhotoPerformance:
    """The driver's `track`, its frame at `rest`, and `frames` (h, w, 3) yet to be drawn, of `size` (width, height)."""

    track: FaceTrack
    rest: int
    size: tuple[int, int]
    frames: Iterator[NDArray[np.uint8]]


def perform_photo(persona: Persona, driver: Path, options: PersonaOptions, run: Run) -> PhotoPerformance:
    """The persona's photograph acting what the driver does.

    Raises
    ------
    InputError : `no_portrait_photo`, and what following a driver may raise.
    """
    target = acting_photo(persona, options.size, run)
    tracking = follow_driver(driver, options.fps, options.trim, options.driver_face_index, run)
    prepared = prepare_target(target, run)
    played = analyse_driver(
        tracking, lambda track: choose_neutral_frame(track, target.mesh, None), run, creases=OWN_CREASES.details
    )
    warn_if_never_at_rest(played.choice, run.warn)
    residuals = played.residuals_on(prepared, ActingOptions(), run)
    rigged = RiggedTarget(target, prepared.layers(), prepared.rig())
    with run.timed("perform"):
        frames = acted(
            persona, rigged, RegisteredDriver(played.track, played.neutral, residuals), SMOOTHING_FRAMES, run
        )
    return PhotoPerformance(played.track, played.neutral, target.size, frames)


def acted(
    persona: Persona, target: RiggedTarget, driver: RegisteredDriver, smoothing: float, run: Run
) -> Iterator[NDArray[np.uint8]]:
    """(h, w, 3) the persona's photograph following a driver, frame by frame; `smoothing` as `act` takes it."""
    follows = ActingOptions()
    acting = act(target, driver, follows, persona, smoothing)
    mouth = acting_mouth(persona, target.face, acting.faces, run)
    animation = FaceAnimation(target, driver, follows, OWN_CREASES, mouth=mouth)
    assert persona.portrait is not None
    base = persona.synthesis(acting.rest[None])[0]
    retouching = retouching_of(persona, persona.portrait, base, is_grey(target.face.rgb, target.face.mesh))
    return photo_frames(animation, retouching, persona, acting)


def acting_photo(persona: Persona, size: tuple[int, int], run: Run) -> TargetFace:
    """The photograph that acts, as large as `size` (width, height) has room for. Raises `InputError` `no_portrait_photo`; warns `head_cut`."""
    if persona.portrait is None:
        raise InputError(
            "no_portrait_photo",
            "None of the photos shows enough of the head to act: add one from before with hair and neck, name one as `photo`, or have the"
            " puppet alone.",
            ("photos", "photo", "composite"),
        )
    if head_share(persona.portrait) < WHOLE_HEAD_SHARE:
        run.warn(
            "head_cut",
            "The photo that acts cuts the head: what lies beyond its edge is not known, and cannot move in. Add a photo with hair and neck,"
            " or name one as `photo`.",
        )
    return framed(persona.portrait, size)
