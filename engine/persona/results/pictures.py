"""Pictures of a persona: its expressions, from several angles, and its photographs in their average light."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from engine.persona.light.relighting import regenerated
from engine.persona.persona import Persona
from engine.persona.puppet import Puppet
from engine.persona.results.face_units import FaceUnits
from engine.persona.results.shown_expressions import ShownExpression, fitted_face

VIEW_YAWS_DEGREES = (-45.0, -20.0, 0.0, 20.0, 45.0)
"""Degrees from which the face is shown, figure 9: below zero it looks to the picture's left."""
PICTURE_EXTENT_RATIO = 1.2
"""Of the neutral face's extent, that a picture of it has."""
MAX_REGENERATED = 24
"""Photographs of which the sheet of the average light shows both."""


@dataclass(frozen=True)
class Studio:
    """Where a persona has its picture taken: pictures of `size` (width, height), `background` behind it."""

    persona: Persona
    size: tuple[int, int]
    background: tuple[int, int, int]

    def picture(self, face: NDArray[np.floating], texture: NDArray[np.uint8], yaw: float = 0.0) -> NDArray[np.uint8]:
        """(h, w, 3) a `face` (478, 3) with a `texture` (H, W, 3) of the persona's frame, turned by `yaw` degrees to the
        picture's right."""
        angle = -np.radians(yaw)
        turn = np.array([[np.cos(angle), 0, np.sin(angle)], [0, 1, 0], [-np.sin(angle), 0, np.cos(angle)]])
        middle, scale = self._framing
        places = turn @ middle * scale
        shift = np.array([(self.size[0] - 1) / 2, (self.size[1] - 1) / 2, 0]) - places
        return self._puppet.draw(face, texture, (turn * scale, shift), self._plain)

    @cached_property
    def _puppet(self) -> Puppet:
        return Puppet(self.persona)

    @cached_property
    def _plain(self) -> NDArray[np.uint8]:
        return np.full((self.size[1], self.size[0], 3), self.background, np.uint8)

    @cached_property
    def _framing(self) -> tuple[NDArray[np.float64], float]:
        low, high = self.persona.neutral.min(axis=0), self.persona.neutral.max(axis=0)
        scale = float((np.array(self.size) / (PICTURE_EXTENT_RATIO * (high - low)[:2])).min())
        return np.asarray((low + high) / 2, np.float64), scale


def gallery(studio: Studio, shown: Sequence[ShownExpression]) -> list[NDArray[np.uint8]]:
    """The face at rest, and as it does each of the expressions."""
    persona = studio.persona
    faces = [persona.neutral, *(one.face for one in shown)]
    textures = persona.synthesis(
        np.concatenate([persona.weights(persona.neutral[None]), *(one.weights[None] for one in shown)])
    )
    return [studio.picture(face, texture) for face, texture in zip(faces, textures, strict=True)]


def angles(studio: Studio, shown: Sequence[ShownExpression]) -> NDArray[np.uint8]:
    """Figure 9: the face at rest and as it does each of the expressions, a row each, from all of `VIEW_YAWS_DEGREES`."""
    persona = studio.persona
    faces = [persona.neutral, *(one.face for one in shown)]
    weights = [persona.weights(persona.neutral[None]), *(one.weights[None] for one in shown)]
    textures = persona.synthesis(np.concatenate(weights))
    return sheet(
        [
            studio.picture(face, texture, yaw)
            for face, texture in zip(faces, textures, strict=True)
            for yaw in VIEW_YAWS_DEGREES
        ],
        len(VIEW_YAWS_DEGREES),
    )


def average_light(studio: Studio, units: FaceUnits) -> NDArray[np.uint8]:
    """Photographs from all over the collection as they are, each beside what `regenerated` makes of it; both on the face that the
    photograph shows."""
    persona = studio.persona
    chosen = np.unique(np.linspace(0, len(persona) - 1, MAX_REGENERATED).round().astype(int))
    pictures = []
    for number in chosen:
        face = fitted_face(persona, units, persona.points[number].astype(np.float64))
        pictures += [studio.picture(face, persona.colours[number]), studio.picture(face, regenerated(persona, number))]
    return sheet(pictures, 8)


def sheet(pictures: Sequence[NDArray[np.uint8]], columns: int) -> NDArray[np.uint8]:
    """Pictures (h, w, 3) of one size in rows; the last row is filled with the first picture's corner."""
    rows = -(-len(pictures) // columns)
    height, width = pictures[0].shape[:2]
    out = np.empty((rows * height, columns * width, 3), np.uint8)
    out[:] = pictures[0][0, 0]
    for number, picture in enumerate(pictures):
        row, column = divmod(number, columns)
        out[row * height : (row + 1) * height, column * width : (column + 1) * width] = picture
    return out
