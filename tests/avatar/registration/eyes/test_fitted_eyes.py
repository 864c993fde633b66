"""Eyeballs behind irises, and lids on them."""

from __future__ import annotations

import numpy as np
import pytest
from known_person import KnownPerson
from numpy.typing import NDArray

from engine.avatar.landmarks.spatial import LID_POINT_COUNT
from engine.avatar.registration.eyes.eye_outline import outline_of_rim
from engine.avatar.registration.eyes.eyeballs import LID_GAP_METRES, sphere
from engine.avatar.registration.eyes.fitted_eyes import (
    INNER_CORNER_LANDMARKS,
    IRIS_RADIUS_METRES,
    OUTWARD_SIGNS,
    FittedEyes,
    with_eyes,
    with_sockets,
)
from engine.avatar.registration.face.face_parts import head_change
from engine.avatar.registration.models import HumanModels
from engine.avatar.registration.template_skin.lid_rims import lid_rim
from engine.avatar.registration.template_skin.skin import EYE_PARTS
from engine.geometry.registration.rigid import Similarity

STILL = Similarity(np.eye(3), np.zeros(3))
UNSEEN = np.full((2, 21, 3), np.nan)


@pytest.fixture(scope="module")
def before(models: HumanModels) -> NDArray[np.float64]:
    """The template, which looks along z."""
    return models.template.vertices.astype(np.float64)


def landmarks(models: HumanModels, vertices: NDArray[np.float64]) -> NDArray[np.float64]:
    """(2, 21, 3) as frames would have them: lids on the rims, irises 6 mm large before the eyeballs."""
    found = []
    for part in EYE_PARTS:
        mirrored = np.array([OUTWARD_SIGNS[part], 1, 1])
        rim = vertices[lid_rim(models.template, part)] * mirrored
        corner = vertices[models.skin.vertices[models.skin.face_points[INNER_CORNER_LANDMARKS[part]]]] * mirrored
        outline = outline_of_rim(rim[:, :2], corner[:2])
        share = np.linspace(0, 1, 9)
        low, high = outline.lids(share)
        x = outline.outer[0] - share * outline.width
        across = np.concatenate([np.stack([x, high], 1), np.stack([x, low], 1)[7:0:-1]])
        middle, radius = sphere(vertices[models.template.vertices_of(part)] * mirrored)
        depth = middle[2] + np.sqrt(radius**2 - np.minimum(((across - middle[:2]) ** 2).sum(1), 0.8 * radius**2))
        pole = middle + np.array([0, 0, radius])
        iris = [pole, *(pole + 0.006 * np.array([np.cos(t), np.sin(t), 0]) for t in np.pi / 2 * np.arange(4))]
        found.append(np.concatenate([np.column_stack([across, depth]), iris]) * mirrored)
    return np.stack(found)


def made(models: HumanModels, before: NDArray[np.float64], seen: NDArray[np.float64]) -> FittedEyes:
    return with_eyes(models.template, models.skin, before, before, STILL, seen)


def rims(models: HumanModels, vertices: NDArray[np.float64]) -> NDArray[np.float64]:
    return vertices[np.concatenate([lid_rim(models.template, part) for part in EYE_PARTS])]


def middles(models: HumanModels, vertices: NDArray[np.float64]) -> NDArray[np.float64]:
    return np.stack([sphere(vertices[models.template.vertices_of(part)])[0] for part in EYE_PARTS])


def test_the_template_s_own_eyes_are_left_as_they_are(models: HumanModels, before: NDArray[np.float64]) -> None:
    for seen in (UNSEEN, landmarks(models, before)):
        found = made(models, before, seen)
        assert np.abs(rims(models, found.vertices) - rims(models, before))[:, :2].max() < 5e-4
        assert np.abs(middles(models, found.vertices) - middles(models, before)).max() < 1.5e-3
    assert found.measured
    assert found.iris == pytest.approx(0.006)


def test_lids_lie_on_the_ball_however_it_was_fitted(models: HumanModels, person: KnownPerson) -> None:
    vertices = person.vertices.copy()
    skin = models.skin
    lids = skin.vertices[skin.regions["lids"]]
    vertices[lids] += 0.002 * np.random.default_rng(3).normal(size=(len(lids), 3))
    head = head_change(skin, person.vertices[skin.vertices], vertices[skin.vertices])
    found = with_eyes(models.template, skin, person.vertices, vertices, head, UNSEEN)
    assert not found.measured
    assert found.iris == IRIS_RADIUS_METRES
    shown = found.vertices[skin.vertices[skin.regions["face"] & ~skin.regions["inner"]]]
    for part in EYE_PARTS:
        middle, radius = sphere(found.vertices[models.template.vertices_of(part)])
        away = np.linalg.norm(found.vertices[lid_rim(models.template, part)] - middle, axis=1)
        assert away.min() > radius
        assert np.median(away) == pytest.approx(radius + LID_GAP_METRES, abs=2e-4)
        assert np.linalg.norm(shown - middle, axis=1).min() > radius


def test_lids_open_as_far_as_frames_show(models: HumanModels, before: NDArray[np.float64]) -> None:
    seen = landmarks(models, before)
    seen[:, 1 : LID_POINT_COUNT // 2, 1] += 0.0015 * np.sin(np.pi * np.arange(1, 8) / 8)
    found = rims(models, made(models, before, seen).vertices) - rims(models, before)
    assert found[:, 1].max() == pytest.approx(0.0015, abs=4e-4)
    assert found[:, 1].min() > -4e-4


def test_a_gaze_is_no_place_of_an_eyeball(models: HumanModels, before: NDArray[np.float64]) -> None:
    aside, apart = landmarks(models, before), landmarks(models, before)
    aside[:, LID_POINT_COUNT:, 0] += 0.002
    apart[0, LID_POINT_COUNT:, 0] += 0.002
    apart[1, LID_POINT_COUNT:, 0] -= 0.002
    straight, looking, wide = (
        middles(models, made(models, before, seen).vertices) for seen in (landmarks(models, before), aside, apart)
    )
    assert np.allclose(looking, straight, atol=1e-6)
    assert np.allclose((wide - straight)[:, 0], [0.002, -0.002], atol=1e-4)


def test_sockets_are_within_the_eyeballs(models: HumanModels, person: KnownPerson) -> None:
    found = with_sockets(models.template, models.skin, person.vertices)
    moved = np.linalg.norm(found - person.vertices, axis=1) > 0
    inner = models.skin.vertices[models.skin.regions["inner"]]
    assert moved.sum() > 200
    assert np.isin(np.flatnonzero(moved), inner).all()
    balls = [sphere(found[models.template.vertices_of(part)]) for part in EYE_PARTS]
    away = np.min([np.linalg.norm(found[moved] - middle, axis=1) / radius for middle, radius in balls], axis=0)
    assert away.max() < 0.97
