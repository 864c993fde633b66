"""ARKit's units on a person's own face."""

from __future__ import annotations

import numpy as np

from engine.body.template import FACE_UNITS
from engine.perception.face.landmarks import LEFT_EYE, LIPS_INNER, RIGHT_EYE
from engine.persona.persona import Persona
from engine.persona.results.face_units import EXPRESSION_UNITS, FaceUnits
from engine.persona.texture.expression_weights import expression_points


def test_units_have_arkits_names_but_for_what_a_face_mesh_does_not_show(units: FaceUnits) -> None:
    left_out = set(FACE_UNITS) - set(units.names)
    assert left_out == {"tongueOut", *(f"eyeLook{to}{side}" for to in ("In", "Out") for side in ("Left", "Right"))}
    assert {unit for mixture in EXPRESSION_UNITS.values() for unit in mixture} <= set(units.names)


def test_this_persons_lids_meet(persona: Persona, units: FaceUnits) -> None:
    shut = persona.neutral + units.doing({"eyeBlinkLeft": 1, "eyeBlinkRight": 1})
    for contour in (LEFT_EYE, RIGHT_EYE):
        upper, lower = list(contour[1:8]), list(contour[:8:-1])
        assert (persona.neutral[lower] - persona.neutral[upper])[3, 1] > 0.1
        np.testing.assert_allclose(shut[upper], shut[lower], atol=1e-9)


def test_this_persons_lips_close_over_an_open_jaw(persona: Persona, units: FaceUnits) -> None:
    upper, lower = list(LIPS_INNER[1:10]), list(LIPS_INNER[:10:-1])

    def gaps(face: np.ndarray) -> np.ndarray:
        return np.asarray((face[lower] - face[upper])[:, 1])

    rest = gaps(persona.neutral)
    assert gaps(persona.neutral + units.doing({"jawOpen": 1}))[4] > 0.4
    assert np.abs(gaps(persona.neutral + units.doing({"jawOpen": 1, "mouthClose": 1})) - rest).max() < 0.06


def test_expressions_are_unlike_each_other(persona: Persona, units: FaceUnits) -> None:
    rest = expression_points(persona.neutral[None])[0]
    faces = np.array([persona.neutral + units.doing(mixture) for mixture in EXPRESSION_UNITS.values()])
    done = (expression_points(faces) - rest).reshape(len(faces), -1)
    done /= np.linalg.norm(done, axis=1, keepdims=True)
    alike = done @ done.T - np.eye(len(done))
    assert alike.max() < 0.95
