"""A persona takes on the expression that one picture of a driver shows."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from engine.errors import InputError
from engine.export.still import write_still
from engine.media.image import over_grey, read_image
from engine.perception.expression.features import frontalise
from engine.perception.face.faces import find_faces
from engine.persona.backdrop import backdrop
from engine.persona.collection.photo_face import as_looked_at
from engine.persona.composite.photo_still import expression_of_photo
from engine.persona.film import beside, puppet_frames
from engine.persona.motion.estimated_rest import estimated_rest
from engine.persona.motion.performance import Performance, perform
from engine.persona.options import PersonaOptions
from engine.persona.persona import Persona
from engine.run import Run


def play_picture(
    persona: Persona,
    picture: Path,
    rest: NDArray[np.float64] | None,
    behind: Path | None,
    options: PersonaOptions,
    out: Path,
    run: Run,
) -> dict[str, object]:
    """Leave `still.png`, the puppet, or a photograph, with the expression of `picture`. `rest` (478, 3) is that face at rest, from the front, in eye
    distances; None has it estimated. `behind` is a picture to stand before. What the report says of it.

    Raises
    ------
    InputError : `no_face_in_driver`, `driver_face_out_of_range`, `no_portrait_photo`, and what reading a picture raises.
    """
    with run.timed("track_driver"):
        given = read_image(picture, run.limits)
        rgb = np.ascontiguousarray(as_looked_at(over_grey(given.rgb, given.alpha)))
        mesh = _face(rgb, options.driver_face_index)
    if rest is None:
        run.warn(
            "driver_rest_estimated",
            "One picture does not tell what the driver's face is like at rest: it was estimated. Give driver_photos, or a video.",
        )
        rest = estimated_rest(frontalise(mesh[None].astype(np.float64))[0])
    if options.composite == "photo":
        still = expression_of_photo(persona, rgb, mesh, rest, options, run)
    else:
        plate = backdrop(options.background, options.size, behind, run.limits)
        still = _puppet(persona, rgb, perform(persona, mesh[None], rest), plate, options)
    for name in ("still.png", "poster.jpg"):
        write_still(out / name, still, run.mark_synthetic)
    return {"driver_size": list(rgb.shape[1::-1])}


def _puppet(
    persona: Persona,
    rgb: NDArray[np.uint8],
    performance: Performance,
    plate: NDArray[np.uint8],
    options: PersonaOptions,
) -> NDArray[np.uint8]:
    """(h, w, 3) the puppet in the one frame of a `performance`, alone or beside the picture (H, W, 3), before the `plate` (h, w, 3)."""
    frame = next(iter(puppet_frames(persona, performance, plate)))
    return frame if options.composite == "none" else beside(rgb, frame, options.background)


def _face(rgb: NDArray[np.uint8], index: int) -> NDArray[np.float32]:
    """(478, 3) the mesh of the `index`-th largest face."""
    faces = find_faces(rgb, index + 1)
    if not faces:
        raise InputError(
            "no_face_in_driver",
            "No face was found in the driver's picture: use one that shows a face from the front.",
            ("driver",),
        )
    if index >= len(faces):
        raise InputError(
            "driver_face_out_of_range",
            f"The driver shows {len(faces)} face(s): driver_face_index counts from 0.",
            ("driver_face_index",),
        )
    return faces[index]
