"""Whether somebody is seen to be barefoot."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from known_person import KnownPerson, sampled

from engine.avatar.registration.footwear import seen_barefoot
from engine.avatar.registration.models import HumanModels
from engine.geometry.point_clouds.point_cloud import PointCloud, joined

SKIN, SHADED_SKIN, LEATHER, WHITE = (196, 150, 128), (150, 110, 92), (52, 38, 34), (235, 235, 232)


def of_colour(cloud: PointCloud, colour: tuple[int, int, int]) -> PointCloud:
    """The cloud in one colour, with noise."""
    noise = np.random.default_rng(2).normal(0, 6, (len(cloud), 3))
    return replace(cloud, colours=np.clip(np.array(colour) + noise, 0, 255).astype(np.uint8))


@pytest.mark.parametrize(
    ("colour", "bare"), [(SKIN, True), (SHADED_SKIN, True), (LEATHER, False), (WHITE, False)], ids=str
)
def test_feet_are_bare_where_they_have_the_face_s_colours(
    models: HumanModels, person: KnownPerson, colour: tuple[int, int, int], bare: bool
) -> None:
    skin = person.vertices[models.skin.vertices]
    face = of_colour(sampled(models, skin, 5000, 0.003, part="head"), SKIN)
    feet = of_colour(sampled(models, skin, 2000, 0.003, part="feet"), colour)
    # the coarse fit is a few millimetres off
    coarse = skin + np.array([0.003, 0, -0.004])
    assert seen_barefoot(models.feet, coarse, joined([face, feet]), person.landmarks.face) is bare


def test_the_floor_that_bare_feet_stand_on_is_none_of_them(models: HumanModels, person: KnownPerson) -> None:
    skin = person.vertices[models.skin.vertices]
    face, feet = (of_colour(sampled(models, skin, 5000, 0.003, part=part), SKIN) for part in ("head", "feet"))
    own = skin[models.feet.masks[0] | models.feet.masks[1]]
    places = np.random.default_rng(4).uniform(own.min(0) - 0.015, own.max(0) + 0.015, (40_000, 3))
    places[:, 1] = own[:, 1].min() + 0.004
    up = np.tile(np.array([0, 1, 0], np.float32), (len(places), 1))
    floor = of_colour(PointCloud(places.astype(np.float32), up, np.zeros(places.shape, np.uint8)), WHITE)
    assert seen_barefoot(models.feet, skin, joined([face, feet, floor]), person.landmarks.face)


def test_who_is_not_seen_wears_shoes(models: HumanModels, person: KnownPerson) -> None:
    skin = person.vertices[models.skin.vertices]
    face, feet = (of_colour(sampled(models, skin, 5000, 0.003, part=part), SKIN) for part in ("head", "feet"))
    unknown = np.full((68, 3), np.nan)
    assert not seen_barefoot(models.feet, skin, face, person.landmarks.face)  # no feet
    assert not seen_barefoot(models.feet, skin, feet, person.landmarks.face)  # no face
    assert not seen_barefoot(models.feet, skin, joined([face, feet]), unknown)
