"""Pose and shape from landmarks and points."""

from __future__ import annotations

import numpy as np
import pytest
from known_person import KnownPerson, sampled

from engine.avatar.landmarks.spatial import SpatialLandmarks
from engine.avatar.registration.coarse import COARSE_ROUNDS, fit_to_landmarks, fit_to_points
from engine.avatar.registration.models import HumanModels
from engine.errors import InputError


def test_skin_moves_as_its_derivatives_say(models: HumanModels, person: KnownPerson) -> None:
    chosen = np.arange(0, len(models.skin.vertices), 900)
    slopes = models.body.derivatives(person.parameters, chosen)
    step = 0.01
    for k in (1, 4, 30, 50, len(person.parameters) - 2):
        ends = [
            models.body.vertices(person.parameters + sign * step * np.eye(len(person.parameters))[k])
            for sign in (1, -1)
        ]
        assert np.allclose((ends[0] - ends[1])[chosen] / (2 * step), slopes[:, :, k], atol=1e-3)


def test_landmarks_and_points_find_pose_and_shape(models: HumanModels, person: KnownPerson) -> None:
    truth = person.vertices[models.skin.vertices]
    by_landmarks = fit_to_landmarks(models.body, models.landmarks, person.landmarks)
    assert not by_landmarks.dropped
    assert max(by_landmarks.residuals.values()) < 0.04
    cloud = sampled(models, truth, 8000, 0.003)
    found = fit_to_points(
        models.body, models.landmarks, person.landmarks, cloud, by_landmarks.parameters, COARSE_ROUNDS[::2]
    )
    off = [np.linalg.norm(models.body.vertices(p) - truth, axis=1).mean() for p in (by_landmarks.parameters, found)]
    assert off[0] < 0.05
    assert off[1] < 0.012
    assert off[1] < off[0]


def test_a_landmark_of_another_limb_is_dropped(models: HumanModels, person: KnownPerson) -> None:
    wrong = dict(person.landmarks.body)
    wrong["LeftWrist"] = wrong["LeftWrist"] + [0.3, 0.2, 0]
    found = fit_to_landmarks(models.body, models.landmarks, SpatialLandmarks(wrong))
    assert found.dropped == {"LeftWrist"}
    assert found.residuals["RightWrist"] < 0.05


@pytest.mark.parametrize("count", [0, 5])
def test_too_few_landmarks_ask_for_them(models: HumanModels, person: KnownPerson, count: int) -> None:
    few = SpatialLandmarks(dict(list(person.landmarks.body.items())[:count]))
    with pytest.raises(InputError) as raised:
        fit_to_landmarks(models.body, models.landmarks, few)
    assert raised.value.code == "landmarks_needed"
    assert raised.value.correctable == ("landmarks",)
