"""Whether a cloud is of shoes."""

from __future__ import annotations

import numpy as np
import pytest
from known_person import KnownPerson, sampled

from engine.avatar.registration.footwear import in_shoes, wears_shoes
from engine.avatar.registration.models import HumanModels


@pytest.mark.parametrize("shoes", [False, True])
def test_clouds_of_feet_and_of_shoes_are_told_apart(models: HumanModels, person: KnownPerson, shoes: bool) -> None:
    bare = person.vertices[models.skin.vertices]
    truth = in_shoes(models.skin, models.feet, bare) if shoes else bare
    cloud = sampled(models, truth, 20000, 0.003, part="feet")
    # the coarse fit is a few millimetres off
    assert wears_shoes(models.skin, models.feet, bare + np.array([0.003, 0, -0.004]), cloud) is shoes


def test_without_points_feet_are_bare(models: HumanModels, person: KnownPerson) -> None:
    bare = person.vertices[models.skin.vertices]
    cloud = sampled(models, bare, 500, 0.003, part="head")
    assert not wears_shoes(models.skin, models.feet, bare, cloud)
