"""Mouths that stay closed."""

from __future__ import annotations

import numpy as np
from known_person import KnownPerson, sampled

from engine.avatar.registration.fine import fit_head
from engine.avatar.registration.models import HumanModels
from engine.avatar.registration.template_skin.lip_contact import closed_mouth

MOUTH = slice(48, 68)
"""Face landmarks of the mouth."""


def test_the_line_of_contact_runs_from_corner_to_corner(models: HumanModels) -> None:
    contact = models.skin.lip_contact
    mean = models.space.mean[models.skin.vertices].astype(np.float64)
    touching = mean[np.unique(contact.indices[contact.data == 1])]
    assert np.abs(contact.sum(1)).max() < 1e-9  # each is a point minus another
    assert np.linalg.norm(contact @ mean, axis=1).max() < 0.001
    width = np.linalg.norm(mean[models.skin.face_points[48]] - mean[models.skin.face_points[54]])
    assert np.ptp(touching[:, 0]) > 0.9 * width
    assert np.diff(np.sort(touching[:, 0])).max() < 0.003
    assert not models.skin.regions["inner"][np.unique(contact.indices)].any()


def test_a_mouth_is_closed_by_as_much_as_it_was_open(models: HumanModels, person: KnownPerson) -> None:
    skin = models.skin
    places = person.vertices[skin.vertices]
    moved = skin.regions["lips"] | skin.regions["inner"]
    closed = closed_mouth(places, skin.triangles, skin.lip_contact, moved)
    assert np.linalg.norm(skin.lip_contact @ closed, axis=1).max() < 5e-5
    assert np.array_equal(closed[~moved], places[~moved])
    assert np.linalg.norm(closed - places, axis=1).max() < 0.002


def test_lips_touch_after_a_fit_to_landmarks_of_an_open_mouth(models: HumanModels, person: KnownPerson) -> None:
    skin = models.skin
    truth = person.vertices[skin.vertices]
    cloud = sampled(models, truth, 8000, 0.001, part="head")
    face = truth[skin.face_points] + np.random.default_rng(3).normal(0, 0.0015, (68, 3))
    face[61:64, 1] += 0.003
    face[65:68, 1] -= 0.003
    fitted = fit_head(skin, truth, cloud, face)
    assert np.linalg.norm(skin.lip_contact @ fitted, axis=1).max() < 1e-5
    assert np.linalg.norm(fitted - truth, axis=1)[skin.face_points[MOUTH]].max() < 0.004
