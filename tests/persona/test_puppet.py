"""A persona drawn as a head that turns."""

from __future__ import annotations

import cv2
import numpy as np
import pytest

from engine.face_animation.mouth.lip_contours import LOWER_INNER_LIP, UPPER_INNER_LIP
from engine.persona.learning import learn_persona
from engine.persona.persona import Persona
from engine.persona.puppet import Puppet

SIZE = (244, 194)
Collection = tuple[np.ndarray, list[np.ndarray]]


@pytest.fixture(scope="module")
def persona(collection: Collection) -> Persona:
    meshes, photos = collection
    return learn_persona(meshes[::2], lambda number: photos[2 * number], SIZE).persona


def turned(degrees: float) -> np.ndarray:
    angle = np.radians(degrees)
    return np.array([[np.cos(angle), 0, np.sin(angle)], [0, 1, 0], [-np.sin(angle), 0, np.cos(angle)]])


def test_from_before_its_frame_is_what_is_drawn(persona: Persona) -> None:
    random = np.random.default_rng(0)
    noise = cv2.GaussianBlur(random.normal(size=(*SIZE, 3)), (0, 0), 4)
    texture = np.clip(128 + 40 * noise / noise.std(), 0, 255).astype(np.uint8)
    frame = persona.frame
    shift = frame.places[0] - persona.mesh[0] * frame.scale
    picture = np.full((*SIZE, 3), 7, np.uint8)
    found = Puppet(persona).draw(persona.mesh, texture, (np.eye(3) * frame.scale, shift), picture)
    inner = cv2.erode(frame.face.astype(np.uint8), np.ones((7, 7))) > 0
    lips = np.rint(frame.places[[*UPPER_INNER_LIP, *LOWER_INNER_LIP[::-1]], :2]).astype(np.int32)
    mouth = cv2.dilate(cv2.fillPoly(np.zeros(SIZE, np.uint8), [lips], (1,)), np.ones((5, 5))) > 0
    assert np.abs(found.astype(int) - texture)[inner & ~mouth].mean() < 0.5, "grey levels"
    outside = cv2.dilate(frame.face.astype(np.uint8), np.ones((5, 5))) == 0
    assert (found[outside] == 7).all()


@pytest.mark.parametrize("degrees", [-40, 40, 70])
def test_from_the_side_it_has_an_even_rim(persona: Persona, degrees: float) -> None:
    white = np.full((*SIZE, 3), 255, np.uint8)
    black = np.zeros((300, 300, 3), np.uint8)
    found = Puppet(persona).draw(persona.mesh, white, (turned(degrees) * 70, np.array([150, 120, 0])), black)[..., 0]
    mask = (found > 127).astype(np.uint8)
    contours, _ = cv2.findContours(mask, cv2.RETR_EXTERNAL, cv2.CHAIN_APPROX_NONE)
    largest = max(contours, key=cv2.contourArea)
    assert cv2.contourArea(largest) > 0.97 * mask.sum() > 5000, "one piece without holes"
    smooth = cv2.approxPolyDP(largest, 1.5, True)
    assert len(smooth) < 60, "no teeth along the rim"
    assert {*np.unique(found)} > {0, 255}, "its edge is antialiased"
