"""People of known shape."""

from __future__ import annotations

import numpy as np
import pytest
from known_person import TO_HEAD, KnownPerson, sampled

from engine.avatar.landmarks.spatial import SpatialLandmarks
from engine.avatar.registration.fitted_template import FittedTemplate
from engine.avatar.registration.hand_pose import with_hands
from engine.avatar.registration.models import HumanModels, load_models
from engine.avatar.registration.register import Scan, register
from engine.body.fitting.posing import FITTED_JOINTS


@pytest.fixture(scope="session")
def models() -> HumanModels:
    return load_models()


@pytest.fixture(scope="session")
def person(models: HumanModels) -> KnownPerson:
    """Somebody with a shape of their own, arms half lowered, turned a little, feet on the ground."""
    random = np.random.default_rng(7)
    turns = random.normal(0, 0.02, (len(FITTED_JOINTS), 3))
    turns[0] = [0, 0.3, 0]
    for side, sign in (("Left", -1), ("Right", 1)):
        turns[FITTED_JOINTS.index(f"{side}Arm"), 2] = sign * 0.9
        turns[FITTED_JOINTS.index(f"{side}UpLeg"), 2] = -sign * 0.12
    parameters = np.concatenate([np.zeros(3), turns.ravel(), random.normal(0, 0.8, models.body.coefficients)])
    parameters[1] -= models.body.vertices(parameters)[:, 1].min()
    carried = models.body.poser(parameters[None]).carry(models.landmarks)[0]
    vertices = with_hands(models, parameters, SpatialLandmarks({})).whole
    face = vertices[models.skin.vertices][models.skin.face_points]
    named = {name: at + random.normal(0, 0.005, 3) for name, at in zip(models.landmarks.names, carried, strict=True)}
    return KnownPerson(parameters, vertices, SpatialLandmarks(named, face + random.normal(0, 0.001, face.shape)))


@pytest.fixture(scope="session")
def fitted(models: HumanModels, person: KnownPerson) -> FittedTemplate:
    """The person again, from 20,000 points of the body and as many of the head, each in its own world."""
    truth = person.vertices[models.skin.vertices]
    body = Scan(sampled(models, truth, 20000, 0.003), person.landmarks)
    head = sampled(models, TO_HEAD(truth), 20000, 0.001, part="head")
    return register(models, body, Scan(head, SpatialLandmarks({}, TO_HEAD(person.landmarks.face))))
