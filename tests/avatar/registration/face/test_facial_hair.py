"""Hair on a face of known shape comes out as high as it is, and nothing else does."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from known_person import KnownPerson, sampled
from scipy.spatial import cKDTree

from engine.avatar.registration.face.facial_hair import facial_hair, with_facial_hair
from engine.avatar.registration.fitted_template import FittedTemplate
from engine.avatar.registration.models import HumanModels
from engine.geometry.point_clouds.point_cloud import PointCloud

HAIR_METRES = 0.007
"""By which the moustache stands off the skin."""
HAIR_WIDTH_METRES = 0.012
"""From the middle between nose and lip to its end."""


def bearded(models: HumanModels, skin: np.ndarray, height: float, colour: int, at: int = 33) -> PointCloud:
    """A cloud of a skin (S, 3), which about a face landmark is of a `colour` and lies by a `height` before it."""
    cloud = sampled(models, skin, 60000, 0.0003, part="head")
    marks = skin[models.skin.face_points]
    middle = marks[at] if at != 33 else (marks[33] + marks[51]) / 2
    own = np.linalg.norm(cloud.points - middle, axis=1) < HAIR_WIDTH_METRES
    points, colours = cloud.points.copy(), cloud.colours.copy()
    points[own] += height * cloud.normals[own]
    colours[own] = colour
    return PointCloud(points, cloud.normals, colours)


def test_a_moustache_is_as_high_as_it_is(models: HumanModels, person: KnownPerson) -> None:
    skin = person.vertices[models.skin.vertices]
    relief = facial_hair(models.skin, skin, bearded(models, skin, HAIR_METRES, 30))
    marks = skin[models.skin.face_points]
    away = np.linalg.norm(skin - (marks[33] + marks[51]) / 2, axis=1)
    below_nose = skin[:, 1] < marks[33, 1] - 0.002
    lips = cKDTree(skin[np.unique(models.skin.lip_contact.indices)]).query(skin)[0] < 0.008
    inner = (away < HAIR_WIDTH_METRES - 0.004) & below_nose & ~lips & ~models.skin.regions["inner"]
    assert inner.sum() > 20
    assert abs(np.median(relief[inner]) - HAIR_METRES) < 0.001
    assert not relief[away > HAIR_WIDTH_METRES + 0.004].any()


@pytest.mark.parametrize(("height", "colour"), [(HAIR_METRES, 128), (0.0, 30)])
def test_what_is_not_dark_or_does_not_stand_off_is_no_hair(
    models: HumanModels, person: KnownPerson, height: float, colour: int
) -> None:
    skin = person.vertices[models.skin.vertices]
    assert not facial_hair(models.skin, skin, bearded(models, skin, height, colour)).any()


def test_dark_brows_are_no_beard(models: HumanModels, person: KnownPerson) -> None:
    skin = person.vertices[models.skin.vertices]
    assert not facial_hair(models.skin, skin, bearded(models, skin, HAIR_METRES, 30, at=19)).any()


def test_both_poses_have_the_relief_and_a_face_that_moves_as_one_moves_as_one(
    models: HumanModels, fitted: FittedTemplate
) -> None:
    skin = models.skin
    relief = np.zeros(len(skin.vertices))
    relief[skin.face_points[48:55]] = HAIR_METRES
    shift = np.tile(np.array([0.001, -0.002, 0.003], np.float32), (len(fitted.vertices), 1))
    found = with_facial_hair(skin, replace(fitted, expressions={"all": shift}), relief)
    for after, before in ((found.vertices, fitted.vertices), (found.rest, fitted.rest)):
        moved = np.linalg.norm(after - before, axis=1)
        np.testing.assert_allclose(moved[skin.vertices], relief, atol=2e-4)
        assert not np.delete(moved, skin.vertices).any()
    np.testing.assert_allclose(found.expressions["all"], shift, atol=1e-7)
