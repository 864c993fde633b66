"""A head without a face, laid on the outlines of the person."""

from __future__ import annotations

import numpy as np
import pytest
from known_person import KnownPerson
from numpy.typing import NDArray

from engine.avatar.landmarks.spatial import SpatialLandmarks
from engine.avatar.registration.hand_pose import CoarseBody, with_hands
from engine.avatar.registration.head_in_outlines import LOWERED_NECK_RINGS, with_head_in_outlines
from engine.avatar.registration.models import HumanModels
from engine.avatar.registration.part_outlines import Silhouette
from engine.avatar.registration.template_skin.skin import grown
from engine.geometry.camera import Camera
from engine.render.rasterisation.rasteriser import rasterise

SHIFT, SIZE = np.array([0.01, -0.07, 0.04]), 1.1
"""Metres, and times as large: where the head is and how large, against the coarse fit."""


@pytest.fixture(scope="module")
def body(models: HumanModels, person: KnownPerson) -> CoarseBody:
    return with_hands(models, person.parameters, SpatialLandmarks({}))


def silhouettes(models: HumanModels, vertices: NDArray[np.float64]) -> list[Silhouette]:
    """From all around, two metres away, a little from above and from below."""
    lens = Camera((0.0, 0.0, 1.0), 700.0, (179.5, 239.5), (480, 360))
    middle = vertices[models.skin.regions["head"]].mean(0)
    found = []
    for k, turn in enumerate(np.arange(12) * np.pi / 6):
        away = np.array([2 * np.sin(turn), 0.5 * (-1) ** k, 2 * np.cos(turn)])
        camera = lens.aimed(middle + away, middle - [0, 0.1, 0])
        seen = rasterise(camera.project(vertices), models.skin.triangles, camera.size, perspective=True)
        found.append(Silhouette(seen.triangle >= 0, camera))
    return found


def moved_head(models: HumanModels, body: CoarseBody) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """The skin (S, 3) with its head elsewhere and larger, and where the joint of the head is then, metres."""
    joint = body.joints[models.rig.index("Head")]
    share = (models.skin.weights * np.isin(models.skin.bones, _head_joints(models))).sum(1)[:, None]
    away = SIZE * (body.vertices - joint) + joint + SHIFT
    return body.vertices + share * (away - body.vertices), joint + SHIFT


def _head_joints(models: HumanModels) -> list[int]:
    return [models.rig.index(name) for name in ("Head", "Jaw", "LeftEye", "RightEye")]


def test_a_head_is_found_where_outlines_have_it(models: HumanModels, body: CoarseBody) -> None:
    truth, joint = moved_head(models, body)
    found = with_head_in_outlines(models, body, silhouettes(models, truth))
    head = models.skin.regions["head"]
    off = np.linalg.norm(found.vertices - truth, axis=1)[head]
    before = np.linalg.norm(body.vertices - truth, axis=1)[head]
    assert np.median(before) > 0.07
    assert np.median(off) < 0.006
    assert np.linalg.norm(found.joints[models.rig.index("Head")] - joint) < 0.015


def test_the_rest_of_the_body_stays(models: HumanModels, body: CoarseBody) -> None:
    truth, _ = moved_head(models, body)
    found = with_head_in_outlines(models, body, silhouettes(models, truth))
    names = np.array(models.rig.names)[models.skin.bones[:, 0]]
    about = np.isin(names, ["Neck", "Head", "Jaw", "LeftEye", "RightEye"])
    kept = ~grown(about, models.skin.triangles, LOWERED_NECK_RINGS)
    assert kept.sum() > len(kept) / 2
    np.testing.assert_allclose(found.vertices[kept], body.vertices[kept], atol=1e-9)
    own = _head_joints(models)
    others = np.setdiff1d(np.arange(len(body.joints)), own)
    np.testing.assert_array_equal(found.joints[others], body.joints[others])


def test_without_silhouettes_a_head_stays(models: HumanModels, body: CoarseBody) -> None:
    found = with_head_in_outlines(models, body, [])
    np.testing.assert_allclose(found.vertices, body.vertices, atol=1e-6)
