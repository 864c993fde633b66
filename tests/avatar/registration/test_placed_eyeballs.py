"""Eyeballs between lids."""

from __future__ import annotations

import numpy as np
import pytest
from known_person import KnownPerson

from engine.avatar.registration.eyeballs import lids_on_eyes, placed_eyeball, sphere
from engine.avatar.registration.face_parts import head_change
from engine.avatar.registration.fitted_template import FittedTemplate
from engine.avatar.registration.models import HumanModels
from engine.avatar.registration.skin import EYE_PARTS
from engine.geometry.registration.rigid import Similarity


@pytest.mark.parametrize("part", EYE_PARTS)
def test_a_ball_goes_where_the_rims_of_its_lids_go(models: HumanModels, person: KnownPerson, part: str) -> None:
    skin = models.skin
    fitted = person.vertices[skin.vertices].copy()
    fitted[skin.regions["lids"]] += [0, 0, 0.003]
    still = Similarity(np.eye(3), np.zeros(3))
    ball = placed_eyeball(models.template, skin, part, person.vertices, fitted, still)
    forward = (ball - person.vertices[models.template.vertices_of(part)]).mean(0)
    assert 0.001 < forward[2] < 0.003
    assert np.abs(forward[:2]).max() < 0.001


def test_lids_end_before_the_eyeball(models: HumanModels, person: KnownPerson) -> None:
    template, skin = models.template, models.skin
    vertices = person.vertices.copy()
    eye = template.vertices_of("left_eye")
    vertices[eye] += [0, 0, 0.004]
    middle, radius = sphere(vertices[eye])
    fitted = lids_on_eyes(template, skin, person.vertices, vertices, Similarity(np.eye(3), np.zeros(3)))
    rim, lids = skin.regions["left_eye_rim"], skin.regions["lids"] & ~skin.regions["inner"]
    own = sphere(person.vertices[eye])[0]
    before = np.linalg.norm(person.vertices[skin.vertices][rim] - own, axis=1)
    after = np.linalg.norm(fitted[rim] - middle, axis=1)
    assert np.linalg.norm(fitted[lids] - middle, axis=1).min() > radius
    assert np.allclose(after, np.maximum(before, radius + 0.0004), atol=5e-4)


def test_an_iris_is_in_the_middle_between_the_lids_and_looks_ahead(models: HumanModels, fitted: FittedTemplate) -> None:
    template, skin = models.template, models.skin
    rest = fitted.rest.astype(np.float64)
    for part in EYE_PARTS:
        ball = rest[template.vertices_of(part)]
        middle, _ = sphere(ball)
        rim = rest[skin.vertices][skin.regions[f"{part}_rim"]]
        iris = ball[np.argmax(ball[:, 2])]
        assert abs(iris[0] - (rim[:, 0].min() + rim[:, 0].max()) / 2) < 0.004
        assert rim[:, 1].min() < middle[1] < rim[:, 1].max()


def test_the_sphere_through_points() -> None:
    random = np.random.default_rng(2).normal(size=(40, 3))
    points = [0.1, 0.2, 0.3] + 0.012 * random / np.linalg.norm(random, axis=1, keepdims=True)
    middle, radius = sphere(points)
    assert np.allclose(middle, [0.1, 0.2, 0.3])
    assert radius == pytest.approx(0.012)


def test_a_head_that_is_larger_is_told_so(models: HumanModels, person: KnownPerson) -> None:
    own = person.vertices[models.skin.vertices]
    assert head_change(models.skin, own, 1.1 * own).scale == pytest.approx(1.1)
