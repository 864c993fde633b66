"""A photograph that is kept of a collection, with the face in it."""

from __future__ import annotations

from dataclasses import dataclass

from engine.face_animation.mouth.pictured.pictured_face import PicturedFace


@dataclass(frozen=True)
class FacePhoto(PicturedFace):
    """rgb : (h, w, 3) uint8. mesh : (478, 3) float32, pixels of it. number : which of the persona's photographs it is."""

    number: int
