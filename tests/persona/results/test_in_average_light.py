"""A photograph of the collection in its average light."""

from __future__ import annotations

import cv2
import numpy as np

from engine.perception.face.landmarks import FACE_OVAL, LIPS_INNER, mouth_opening
from engine.persona.collection.face_photo import FacePhoto
from engine.persona.persona import Persona
from engine.persona.results.in_average_light import in_average_light

Collection = tuple[np.ndarray, list[np.ndarray]]
NUMBER = 4


def cheeks(photo: np.ndarray, mesh: np.ndarray) -> tuple[float, float]:
    """How bright the cheek at the picture's left is, and the one at its right."""
    low, high = np.rint(mesh[[50, 280], :2]).astype(int)
    return tuple(float(photo[y - 5 : y + 6, x - 5 : x + 6].mean()) for x, y in (low, high))  # type: ignore[return-value]


def test_a_light_from_the_side_goes_and_the_picture_stays(persona: Persona, collection: Collection) -> None:
    meshes, photos = collection
    mesh = meshes[NUMBER].astype(np.float32)
    shade = np.linspace(0.45, 1.3, photos[NUMBER].shape[1])[None, :, None]
    lit = np.clip(photos[NUMBER] * shade, 0, 255).astype(np.uint8)
    made = in_average_light(persona, FacePhoto(lit, mesh, NUMBER))
    assert made.shape == lit.shape and made.dtype == np.uint8
    before, after, even = (cheeks(one, mesh) for one in (lit, made, photos[NUMBER]))
    off, left = (abs(np.log(one[0] / one[1]) - np.log(even[0] / even[1])) for one in (before, after))
    assert left < 0.4 * off, "both cheeks are lit as in the mean"


def test_what_a_mouth_shows_stays(persona: Persona, collection: Collection) -> None:
    """Of the one that is opened widest: a mixture of photographs has no teeth."""
    meshes, photos = collection
    number = int(np.argmax([mouth_opening(mesh) for mesh in meshes]))
    mesh, photo = meshes[number].astype(np.float32), photos[number].copy()
    inside = np.zeros(photo.shape[:2], np.uint8)
    cv2.fillPoly(inside, [np.rint(mesh[list(LIPS_INNER), :2]).astype(np.int32)], 1)
    photo[inside > 0] = (0, 220, 0)
    made = in_average_light(persona, FacePhoto(photo, mesh, number)).astype(int)
    middle = cv2.distanceTransform(inside, cv2.DIST_L2, 3) > 0.6 * cv2.distanceTransform(inside, cv2.DIST_L2, 3).max()
    assert (made[middle][:, 1] - made[middle][:, [0, 2]].max(1) > 110).all()


def test_what_is_in_its_own_light_keeps_it(persona: Persona, collection: Collection) -> None:
    meshes, photos = collection
    mesh, photo = meshes[NUMBER].astype(np.float32), photos[NUMBER]
    made = in_average_light(persona, FacePhoto(photo, mesh, NUMBER))
    face = np.zeros(photo.shape[:2], np.uint8)
    cv2.fillConvexPoly(face, np.rint(mesh[list(FACE_OVAL), :2]).astype(np.int32), 1)
    apart = np.abs(made.astype(int) - photo).mean(axis=-1)
    assert apart[face > 0].mean() < 12 and apart[face == 0].mean() < 12, "the collection has one light"
    away = photo.copy()
    cv2.fillPoly(away, [np.rint(mesh[list(LIPS_INNER), :2]).astype(np.int32)], (0, 255, 0))
    assert in_average_light(persona, FacePhoto(away, mesh + 1e4, NUMBER)) is away, (
        "no face in the picture: nothing to do"
    )
