"""The head's cloud brought to the body's world."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from known_person import KnownPerson, sampled
from scipy.spatial import cKDTree
from scipy.spatial.transform import Rotation

from engine.avatar.landmarks.spatial import SpatialLandmarks
from engine.avatar.registration.head_cloud import CLOUD_RINGS, head_to_body, one_cloud
from engine.avatar.registration.models import HumanModels
from engine.avatar.registration.template_skin.skin import grown
from engine.geometry.registration.rigid import Similarity


def test_a_head_is_turned_as_the_body_s_cloud_has_it_and_not_as_a_template_that_leans(
    models: HumanModels, person: KnownPerson
) -> None:
    truth = person.vertices[models.skin.vertices]
    middle = truth[models.skin.regions["head"]].mean(0)
    lean = Rotation.from_rotvec([np.radians(9), 0, 0]).as_matrix()
    leaning = np.where(models.skin.regions["head"][:, None], (truth - middle) @ lean.T + middle, truth)
    body, head = sampled(models, truth, 200_000, 0.003), sampled(models, truth, 20_000, 0.001, part="head")
    moved = Rotation.from_rotvec(
        [0.02, 0.05, -0.02]
    ).as_matrix()  # by 3 degrees, and a centimetre: she looked elsewhere
    apart = Similarity(moved, middle - moved @ middle + np.array([0.006, -0.004, 0.007]))
    landmarks = SpatialLandmarks({}, apart(person.landmarks.face))
    found = head_to_body(models.skin, leaning, body, head.moved(apart), landmarks, sized=True)
    assert found is not None
    left = found.linear @ apart.linear
    assert np.degrees(np.arccos((np.trace(left) - 1) / 2)) < 1.0
    assert np.linalg.norm(found(apart(middle[None])) - middle) < 0.002


def test_the_head_is_the_head_clips_and_the_neck_below_it_is_both(models: HumanModels, person: KnownPerson) -> None:
    """Either clip shows all of the person here."""
    skin = models.skin
    fitted = person.vertices[skin.vertices]
    red, blue = (
        replace(cloud, colours=np.full(cloud.colours.shape, colour, np.uint8))
        for cloud, colour in (
            (sampled(models, fitted, 20_000, 0.001), (250, 0, 0)),
            (sampled(models, fitted, 20_000, 0.002), (0, 0, 250)),
        )
    )
    found = one_cloud(skin, fitted, red, blue)
    nearest = cKDTree(fitted).query(found.points)[1]
    of_body = found.colours[:, 0] > 0
    head = skin.regions["head"][nearest]
    below = grown(skin.regions["head"], skin.triangles, CLOUD_RINGS)[nearest] & ~head
    assert not of_body[head].any() and head.any()
    assert 0.2 < of_body[below].mean() < 0.8
    assert of_body[~head & ~below].all() and (~head & ~below).any()
