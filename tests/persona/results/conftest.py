"""A small persona and its face units."""

from __future__ import annotations

import numpy as np
import pytest

from engine.persona.learning import learn_persona
from engine.persona.persona import Persona
from engine.persona.results.face_units import FaceUnits, face_units

Collection = tuple[np.ndarray, list[np.ndarray]]


@pytest.fixture(scope="package")
def persona(collection: Collection) -> Persona:
    meshes, photos = collection
    return learn_persona(meshes, lambda number: photos[number], (122, 97)).persona


@pytest.fixture(scope="package")
def units(persona: Persona) -> FaceUnits:
    return face_units(persona)
