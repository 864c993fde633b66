"""A photograph of a persona takes on the expression that one picture of a driver shows."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from engine.face_animation.animation import RegisteredDriver, RiggedTarget
from engine.face_animation.stages import prepare_target
from engine.media.film_strip import FilmStripWriter
from engine.perception.face_track.face_crop import crop_face
from engine.perception.face_track.track import FaceTrack
from engine.persona.composite.photo_performance import acted, acting_photo
from engine.persona.motion.performance import placings
from engine.persona.options import PersonaOptions
from engine.persona.persona import Persona
from engine.run import Run


def expression_of_photo(
    persona: Persona,
    driver: NDArray[np.uint8],
    mesh: NDArray[np.float32],
    rest: NDArray[np.floating],
    options: PersonaOptions,
    run: Run,
) -> NDArray[np.uint8]:
    """(h, w, 3) the persona's photograph, doing what the face at `mesh` (478, 3) of a picture `driver` (H, W, 3) does, which is `rest`
    (478, 3) when it does nothing, from the front, in eye distances. The head stays as the photograph has it.

    Raises
    ------
    InputError : `no_portrait_photo`.
    """
    target = acting_photo(persona, options.size, run)
    prepared = prepare_target(target, run)
    rigged = RiggedTarget(target, prepared.layers(), prepared.rig())
    with run.timed("perform"):
        track = from_rest(driver, mesh, rest)
        return list(acted(persona, rigged, RegisteredDriver(track, 0), 0.0, run))[1]


def from_rest(rgb: NDArray[np.uint8], mesh: NDArray[np.float32], rest: NDArray[np.floating]) -> FaceTrack:
    """A picture (H, W, 3) of a face at `mesh` (478, 3) as a film of two frames: before it, the same head at `rest` (478, 3), from the front,
    in eye distances. There is nothing around the face that moves."""
    linear, shift = placings(mesh[None].astype(np.float64))
    before = (np.asarray(rest, np.float64) @ linear[0].T + shift[0]).astype(np.float32)
    meshes = np.stack([before, mesh.astype(np.float32)])
    with FilmStripWriter() as writer:
        crops = [crop_face(rgb, one) for one in meshes]
        for crop in crops:
            writer.write(crop.crop)
        strip = writer.strip()
    low, high = mesh[:, :2].min(axis=0), mesh[:, :2].max(axis=0)
    return FaceTrack(
        size=(rgb.shape[1], rgb.shape[0]),
        fps=1.0,
        times=np.arange(3.0),
        has_sound=False,
        meshes=meshes,
        found=np.ones(2, np.bool_),
        periphery=np.zeros((2, 0, 2), np.float32),
        trust=np.zeros((2, 0), np.float32),
        crops=strip,
        crop_places=np.array([crop.place for crop in crops]),
        faces=np.array([[*low, *(high - low)]], np.float32),
    )
