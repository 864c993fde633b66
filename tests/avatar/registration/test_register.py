"""From clouds to a person."""

from __future__ import annotations

import numpy as np
import pytest
from known_person import TO_HEAD, KnownPerson

from engine.avatar.registration.fitted_template import FittedTemplate
from engine.avatar.registration.models import HumanModels
from engine.avatar.registration.register import Scan, register
from engine.errors import InputError
from engine.geometry.point_clouds.point_cloud import PointCloud


def test_the_surface_and_its_vertices_are_found(
    models: HumanModels, person: KnownPerson, fitted: FittedTemplate
) -> None:
    off = np.linalg.norm(fitted.vertices - person.vertices, axis=1)
    skin = models.skin
    regions = {name: off[skin.vertices][mask] for name, mask in skin.regions.items()}
    print({name: round(float(np.median(values)) * 1000, 1) for name, values in regions.items()})
    assert np.median(regions["face"]) < 0.0025
    assert np.median(off[skin.vertices]) < 0.006
    assert off[models.template.vertices_of("left_eye")].mean() < 0.003
    for part in (
        "upper_teeth",
        "lower_teeth",
    ):  # placed by the lips, not as the space of bodies that the person is of has them
        assert off[models.template.vertices_of(part)].mean() < 0.008


def test_the_head_s_world_is_found(fitted: FittedTemplate) -> None:
    assert fitted.head_to_body is not None
    assert np.allclose(fitted.head_to_body.linear @ TO_HEAD.linear, np.eye(3), atol=0.02)


def test_joints_and_t_pose_follow(models: HumanModels, person: KnownPerson, fitted: FittedTemplate) -> None:
    posed = models.body.poser(person.parameters[None])
    assert np.median(np.linalg.norm(fitted.joints - posed.joints[0], axis=1)) < 0.006
    assert fitted.rest[models.skin.vertices][:, 1].min() == pytest.approx(0, abs=1e-6)
    arms = [fitted.skeleton.heads[fitted.skeleton.index(f"Left{name}")] for name in ("Arm", "ForeArm", "Hand")]
    assert np.ptp([at[1] for at in arms]) < 0.05  # level
    assert arms[2][0] - arms[0][0] > 0.4


def test_expressions_are_the_person_s(models: HumanModels, fitted: FittedTemplate) -> None:
    assert len(fitted.expressions) == 52 + 15
    chin = models.skin.vertices[models.skin.face_points[8]]
    assert fitted.expressions["jawOpen"][chin, 1] < -0.01
    assert np.linalg.norm(fitted.expressions["eyeBlinkLeft"][chin]) < 1e-3


def test_hands_that_no_landmarks_tell_of_are_named(fitted: FittedTemplate) -> None:
    (notice,) = [notice for notice in fitted.notices if notice.code == "hand_not_measured"]
    assert "left and the right hand" in notice.message


def test_eyes_that_no_frame_shows_are_said_to_be_guessed(fitted: FittedTemplate) -> None:
    assert "eyes_not_measured" in [notice.code for notice in fitted.notices]


def test_hands_in_t_pose_are_those_of_the_body_s_space(models: HumanModels, fitted: FittedTemplate) -> None:
    hands = models.skin.vertices[models.skin.regions["whole_hands"]]
    flat = models.space.vertices(fitted.coefficients)
    for side in (-1, 1):
        own = hands[flat[hands, 0] * side > 0]
        found, known = (one[own] - one[own].mean(0) for one in (fitted.rest, flat))
        assert np.linalg.norm(found - known, axis=1).max() < 0.003


def test_too_few_points_are_refused(models: HumanModels, person: KnownPerson) -> None:
    none = np.zeros((10, 3), np.float32)
    with pytest.raises(InputError) as raised:
        register(models, Scan(PointCloud(none, none, none.astype(np.uint8)), person.landmarks))
    assert raised.value.code == "cloud_too_thin"
