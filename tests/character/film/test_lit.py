"""The lit picture shows who is in the film's first frame, where they are there."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray
from template_character import still, template_character

from engine.character.film.lit import lit_picture
from engine.geometry.camera import Camera
from engine.render.scene.character import Actor, film_cast, prepare_character

SIZE = (300, 320)
CAMERA = Camera((0, 0.9, 4), 420, (160.0, 150.0), SIZE)


def covered(draw: Callable[[NDArray[np.uint8]], NDArray[np.uint8]]) -> NDArray[np.float64]:
    """How much of each pixel is drawn over, by what is left there of black and white."""
    black, white = (draw(np.full((*SIZE, 3), level, np.uint8)).astype(int) for level in (0, 255))
    return 1 - (white - black).mean(-1) / 255


def test_people_stand_where_they_do_in_the_film(opengl: None) -> None:
    """Two of them, one before the other: the nearer hides the farther."""
    mesh = template_character(texture_size=64)
    subject, clip = prepare_character(mesh), still(mesh.skeleton)
    cast = [Actor(subject, clip, (0.1, 0.0, -1.5)), Actor(subject, clip, (-0.3, 0.0, 0.0))]
    plate = np.zeros((*SIZE, 3), np.uint8)
    both = lit_picture(cast, CAMERA, plate)
    film = covered(lambda plate: next(film_cast(cast, lambda second: CAMERA, lambda camera: plate)))
    lit = covered(lambda plate: lit_picture(cast, CAMERA, plate))
    assert film.sum() > 5000
    assert np.minimum(lit, film).sum() / np.maximum(lit, film).sum() > 0.98
    nearer = covered(lambda plate: next(film_cast(cast[1:], lambda second: CAMERA, lambda camera: plate)))
    off = np.abs(lit_picture(cast[1:], CAMERA, plate)[nearer == 1].astype(int) - both[nearer == 1]).max(1)
    assert np.quantile(off, 0.95) == 0
