"""What a collection shows: the photographs of a laugh show a laugh."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from engine.persona.collection.coverage import MIN_PHOTOS_OF_EXPRESSION
from engine.persona.persona import Persona
from engine.persona.results.face_units import EXPRESSION_UNITS, FaceUnits
from engine.persona.results.shown_expressions import fitted_face, fitted_units, photos_near, shown_expressions
from engine.persona.texture.expression_weights import expression_points


def doing(persona: Persona, units: FaceUnits, names: list[str]) -> Persona:
    """The persona with points as if its photographs showed these expressions."""
    faces = [persona.neutral + (units.doing(EXPRESSION_UNITS[name]) if name else 0) for name in names]
    count = len(names)
    points = expression_points(np.array(faces)).astype(np.float32)
    return replace(persona, colours=persona.colours[:count], belief=persona.belief[:count], points=points)


def test_a_mixture_of_units_is_found_again(persona: Persona, units: FaceUnits) -> None:
    face = persona.neutral + units.doing({"jawOpen": 0.5, "browInnerUp": 0.8})
    found = fitted_units(persona, units, expression_points(face[None])[0])
    assert found["jawOpen"] == pytest.approx(0.5, abs=0.1) and found["browInnerUp"] == pytest.approx(0.8, abs=0.2)
    points = expression_points(face[None])[0]
    again = expression_points(fitted_face(persona, units, points)[None])[0]
    assert np.abs(again - points).max() < 0.03, "eye distances"


def test_enough_photographs_of_an_expression_show_it_and_fewer_do_not(persona: Persona, units: FaceUnits) -> None:
    enough, few = MIN_PHOTOS_OF_EXPRESSION, MIN_PHOTOS_OF_EXPRESSION - 1
    known = doing(persona, units, ["surprise"] * enough + ["anger"] * few + [""] * 5)
    near = photos_near(known, units)
    assert set(near["surprise"]) == set(range(enough)) and set(near["anger"]) == set(range(enough, enough + few))
    shown = shown_expressions(known, units)
    assert shown[0].name == "surprise" and "anger" not in {one.name for one in shown}
    brow = 105
    assert (shown[0].face - known.neutral)[brow, 1] < -0.03, "its brows are raised"
    assert shown[0].weights[:enough].min() > shown[0].weights[enough:].max()


def test_frowns_in_smiling_photographs_are_no_anger(persona: Persona, units: FaceUnits) -> None:
    squinting = {**EXPRESSION_UNITS["smile"], "browDownLeft": 0.6, "browDownRight": 0.6}
    faces = np.repeat((persona.neutral + units.doing(squinting))[None], len(persona), axis=0)
    known = replace(persona, points=expression_points(faces).astype(np.float32))
    assert "anger" not in {one.name for one in shown_expressions(known, units)}
