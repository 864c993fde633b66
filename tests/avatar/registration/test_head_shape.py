"""A head in the space of heads, from points of it: bare, and under hair that no head of the space has."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from known_person import sampled
from numpy.typing import NDArray

from engine.avatar.registration.head_shape import head_shape
from engine.avatar.registration.models import HumanModels
from engine.body.template import vertex_mask
from engine.geometry.point_clouds.point_cloud import PointCloud
from engine.geometry.registration.rigid import fit_similarity

HAIR_METRES = 0.012
EAR_MASK = 0.5


@pytest.fixture(scope="module")
def own_head(models: HumanModels) -> NDArray[np.float64]:
    """The mean body's skin (S, 3) with a head of the space, less far from the mean than most."""
    skin, space = models.skin, models.heads
    vertices = models.space.mean[skin.vertices].astype(np.float64)
    coefficients = np.random.default_rng(3).normal(size=len(space.basis))
    coefficients *= 3 / np.linalg.norm(coefficients)
    vertices[skin.index_of(space.vertices)] = space.mean + np.einsum("k,khc->hc", coefficients, space.basis)
    return vertices


def found(models: HumanModels, truth: NDArray[np.float64], cloud: PointCloud) -> NDArray[np.float64]:
    mean = models.space.mean[models.skin.vertices].astype(np.float64)
    return head_shape(models.skin, models.heads, mean, cloud, truth[models.skin.face_points])


def haired(models: HumanModels, cloud: PointCloud, truth: NDArray[np.float64]) -> PointCloud:
    """The cloud of a head whose hair covers it from the brows up, and its sides from the ears back."""
    face = truth[models.skin.face_points]
    over = (cloud.points[:, 1] > face[17:27, 1].mean()) | (cloud.points[:, 2] < face[36, 2] - 0.03)
    return replace(cloud, points=(cloud.points + HAIR_METRES * over[:, None] * cloud.normals).astype(np.float32))


def heights_of_ears(models: HumanModels, vertices: NDArray[np.float64]) -> list[float]:
    ears = vertex_mask(models.template, "ears")[models.skin.vertices] > EAR_MASK
    own = vertices[ears]
    return [float(np.ptp(own[side * own[:, 0] > 0, 1])) for side in (1, -1)]


def test_a_bare_head_of_the_space_is_found(models: HumanModels, own_head: NDArray[np.float64]) -> None:
    head = found(models, own_head, sampled(models, own_head, 20000, 0.0005, "head"))
    own = models.skin.index_of(models.heads.vertices)
    assert np.linalg.norm(head[own] - own_head[own], axis=1).mean() < 0.001


def test_a_head_under_hair_stays_one_among_people_s(models: HumanModels, own_head: NDArray[np.float64]) -> None:
    cloud = haired(models, sampled(models, own_head, 20000, 0.0005, "head"), own_head)
    head = found(models, own_head, cloud)
    for height, true in zip(heights_of_ears(models, head), heights_of_ears(models, own_head), strict=True):
        assert 0.75 < height / true < 1.35
    bare = found(models, own_head, sampled(models, own_head, 20000, 0.0005, "head"))
    face = models.skin.face_points
    assert np.linalg.norm(head[face] - bare[face], axis=1).mean() < 0.004
    assert deviations(models, head) < 6, "as most people"


def deviations(models: HumanModels, head: NDArray[np.float64]) -> float:
    """How far a skin's head (S, 3) is from the mean of heads, in standard deviations over all coefficients together."""
    space = models.heads
    own = models.skin.index_of(space.vertices)
    shape = fit_similarity(head[own], space.mean.astype(np.float64))
    away = (shape(head[own]) - space.mean).ravel()
    coefficients = np.linalg.lstsq(space.basis.reshape(len(space.basis), -1).T.astype(np.float64), away, rcond=None)[0]
    return float(np.linalg.norm(coefficients))


def test_a_head_that_is_nobody_s_becomes_one_at_the_edge_of_people_s(
    models: HumanModels, own_head: NDArray[np.float64]
) -> None:
    """A head twice as far from the mean as any among thousands."""
    space, skin = models.heads, models.skin
    nobody = models.space.mean[skin.vertices].astype(np.float64)
    coefficients = np.random.default_rng(3).normal(size=len(space.basis))
    coefficients *= 12 / np.linalg.norm(coefficients)
    nobody[skin.index_of(space.vertices)] = space.mean + np.einsum("k,khc->hc", coefficients, space.basis)
    head = found(models, nobody, sampled(models, nobody, 20000, 0.0005, "head"))
    assert deviations(models, head) < 8, "and what its graft onto the neck adds"
