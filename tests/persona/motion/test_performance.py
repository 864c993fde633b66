"""An actor's persona driven by the actor: what is drawn is what was filmed."""

from __future__ import annotations

import cv2
import numpy as np
import pytest

from engine.media.video import read_video
from engine.perception.expression.features import frontalise
from engine.perception.face.faces import FaceTracker
from engine.perception.face.landmarks import FACE_OVAL, mouth_opening
from engine.performances import video
from engine.persona.learning import learn_persona
from engine.persona.motion.performance import Performance, perform
from engine.persona.persona import Persona
from engine.persona.puppet import Puppet

Collection = tuple[np.ndarray, list[np.ndarray]]


@pytest.fixture(scope="module")
def persona(collection: Collection) -> Persona:
    meshes, photos = collection
    return learn_persona(meshes, lambda number: photos[number], (244, 194)).persona


@pytest.fixture(scope="module")
def driver() -> tuple[np.ndarray, list[np.ndarray]]:
    """Meshes and frames of a laugh, of which the collection has other frames."""
    frames = [frame.rgb for frame in read_video(video("happy-strong"))][3::12]
    with FaceTracker() as tracker:
        return np.array([tracker(frame)[0] for frame in frames]), frames


@pytest.fixture(scope="module")
def performance(persona: Persona, driver: tuple[np.ndarray, list[np.ndarray]]) -> Performance:
    return perform(persona, driver[0], frontalise(driver[0])[0])


def test_the_actors_own_motion_is_the_actors_face(
    performance: Performance, driver: tuple[np.ndarray, list[np.ndarray]]
) -> None:
    apart = np.linalg.norm(performance.faces - frontalise(driver[0]), axis=-1)
    assert apart.mean() < 0.04, "eye distances"
    opening = np.abs(mouth_opening(performance.faces) - mouth_opening(driver[0]))
    assert opening.mean() < 0.06


def test_drawn_where_it_was_filmed_it_looks_as_filmed(
    persona: Persona, performance: Performance, driver: tuple[np.ndarray, list[np.ndarray]]
) -> None:
    meshes, frames = driver
    textures = persona.synthesis(performance.weights)
    puppet = Puppet(persona)
    for number in range(0, len(frames), 3):
        placing = performance.linear[number], performance.shift[number]
        drawn = puppet.draw(performance.faces[number], textures[number], placing, frames[number])
        face = np.zeros(drawn.shape[:2], np.uint8)
        cv2.fillPoly(face, [np.rint(meshes[number][list(FACE_OVAL), :2]).astype(np.int32)], 1)
        inner = cv2.erode(face, np.ones((9, 9))) > 0
        assert (drawn[inner] != frames[number][inner]).mean() > 0.5, "it is drawn there"
        assert np.abs(drawn.astype(int) - frames[number])[inner].mean() < 12, "grey levels"


def test_weights_follow_the_expression(persona: Persona, performance: Performance) -> None:
    assert performance.weights.shape == (len(performance.faces), len(persona))
    openings = np.linalg.norm(performance.faces[:, 13, :2] - performance.faces[:, 14, :2], axis=1)
    upper, lower = (persona.points[:, 68 - 17 - 8 + place] for place in (2, 6))  # the middles of the inner lips
    shares = performance.weights / performance.weights.sum(axis=1, keepdims=True)
    shown = shares @ np.linalg.norm(upper - lower, axis=1)
    assert np.corrcoef(openings, shown)[0, 1] > 0.85, "wide where the mouth is wide"
    steps, alone = (
        np.abs(np.diff(one, axis=0)).mean() for one in (performance.weights, persona.weights(performance.faces))
    )
    assert steps < 0.7 * alone, "from one frame to the next"
