"""Feet laid on their points as a whole."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from known_person import KnownPerson, sampled
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from engine.avatar.landmarks.spatial import SpatialLandmarks
from engine.avatar.registration.feet.standing_feet import with_feet
from engine.avatar.registration.hand_pose import CoarseBody, with_hands
from engine.avatar.registration.models import HumanModels
from engine.avatar.registration.part_outlines import Silhouette
from engine.geometry.camera import Camera
from engine.geometry.point_clouds.point_cloud import PointCloud
from engine.render.rasterisation.rasteriser import rasterise

NOBODY = SpatialLandmarks({})


@pytest.fixture(scope="module")
def body(models: HumanModels, person: KnownPerson) -> CoarseBody:
    return with_hands(models, person.parameters, NOBODY)


def standing(
    models: HumanModels,
    person: KnownPerson,
    body: CoarseBody,
    cloud: PointCloud,
    shoes: bool = True,
    silhouettes: tuple[Silhouette, ...] = (),
) -> CoarseBody:
    coefficients = person.parameters[-models.body.coefficients :]
    return with_feet(models, body, coefficients, NOBODY, cloud, shoes, silhouettes)


def affine(before: NDArray[np.float64], after: NDArray[np.float64]) -> tuple[float, NDArray[np.float64]]:
    """Metres by which places (N, 3) are off the best affine image of what they were, and by how much that stretches, (3,)."""
    bordered = np.column_stack([before, np.ones(len(before))])
    found = np.linalg.lstsq(bordered, after, rcond=None)[0]
    return float(np.abs(bordered @ found - after).max()), np.linalg.svd(found[:3])[1]


@pytest.mark.parametrize("shoes", [True, False], ids=["shoes", "bare"])
def test_a_longer_foot_that_is_turned_is_found(
    models: HumanModels, person: KnownPerson, body: CoarseBody, shoes: bool
) -> None:
    nothing = sampled(models, body.vertices, 500, 0.0, part="head")
    stood = standing(models, person, body, nothing, shoes)
    left = models.feet.masks[0] & models.skin.regions["lower_feet"]
    ankle = stood.joints[models.space.names.index("LeftFoot")] * [1, 0, 1]
    turn = Rotation.from_rotvec([0, 0.2, 0]).as_matrix()
    truth = body.vertices.copy()
    truth[left] = 1.06 * (stood.vertices[left] - ankle) @ turn.T + ankle + [0.01, 0, -0.012]
    numbers = np.zeros(len(truth), np.bool_)
    numbers[left] = True
    cloud = sampled(models, truth, 30000, 0.002, part="lower_feet")
    cloud = cloud[cloud.points[:, 0] > truth[:, 0].mean()]
    found = standing(models, person, body, cloud, shoes)
    off = np.linalg.norm(found.vertices[left] - truth[left], axis=1)
    assert off.mean() < 0.005 < 0.015 < np.linalg.norm(stood.vertices[left] - truth[left], axis=1).mean()
    by = found.rotations[models.rig.index("LeftFoot")] @ stood.rotations[models.rig.index("LeftFoot")].T
    assert Rotation.from_matrix(by).magnitude() == pytest.approx(0.2, abs=0.03)


def test_silhouettes_alone_tell_where_a_shoe_ends(models: HumanModels, person: KnownPerson, body: CoarseBody) -> None:
    nothing = sampled(models, body.vertices, 500, 0.0, part="head")
    stood = standing(models, person, body, nothing)
    left = models.feet.masks[0] & models.skin.regions["lower_feet"]
    ankle = stood.joints[models.space.names.index("LeftFoot")] * [1, 0, 1]
    turn = Rotation.from_rotvec([0, 0.15, 0]).as_matrix()
    truth = stood.vertices.copy()
    truth[left] = [1.06, 1, 1.05] * (stood.vertices[left] - ankle) @ turn.T + ankle + [0.012, 0, -0.015]
    silhouettes = []
    for angle in np.arange(12) * np.pi / 6:
        lens = Camera((0.0, 0.0, 0.0), 420.0, (134.5, 239.5), (480, 270))
        camera = lens.aimed((2.2 * np.sin(angle), 1.4, 2.2 * np.cos(angle)), (0.0, 0.7, 0.0))
        raster = rasterise(camera.project(truth), models.skin.triangles, camera.size, perspective=True)
        silhouettes.append(Silhouette(raster.triangle >= 0, camera))
    found = standing(models, person, body, nothing, True, tuple(silhouettes))
    off = np.linalg.norm(found.vertices[left] - truth[left], axis=1)
    assert off.mean() < 0.004 < 0.012 < np.linalg.norm(stood.vertices[left] - truth[left], axis=1).mean()
    assert abs(found.vertices[left, 1].min()) < 0.003


def test_whatever_the_points_are_a_foot_keeps_its_shape(
    models: HumanModels, person: KnownPerson, body: CoarseBody
) -> None:
    random = np.random.default_rng(0)
    feet = models.skin.regions["lower_feet"]
    place = body.vertices[feet][random.integers(0, feet.sum(), 4000)]
    normals = random.normal(size=place.shape)
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    points = (place + random.normal(0, 0.02, place.shape)).astype(np.float32)
    rubbish = PointCloud(points, normals.astype(np.float32), np.full(points.shape, 128, np.uint8))
    nothing = sampled(models, body.vertices, 500, 0.0, part="head")
    one, other = (standing(models, person, body, cloud) for cloud in (nothing, rubbish))
    for mask in models.feet.masks:
        own = mask & feet
        error, stretches = affine(one.vertices[own], other.vertices[own])
        assert error < 1e-9
        assert stretches.min() > 0.7 and stretches.max() < 1.3


def test_soles_are_on_the_ground_and_legs_hang_together(
    models: HumanModels, person: KnownPerson, body: CoarseBody
) -> None:
    lifted = replace(body, vertices=body.vertices + np.array([0, 0.03, 0]), joints=body.joints + np.array([0, 0.03, 0]))
    nothing = sampled(models, body.vertices, 500, 0.0, part="head")
    found = standing(models, person, lifted, nothing)
    for mask in models.feet.masks:
        assert found.vertices[mask, 1].min() == pytest.approx(0, abs=0.002)
    above = models.space.mean[models.skin.vertices][:, 1] > 0.5
    np.testing.assert_allclose(found.vertices[above], lifted.vertices[above], atol=1e-9)
    edge = models.skin.triangles[~models.skin.regions["lower_feet"][models.skin.triangles].any(1)][:, :2]
    before, after = (
        np.linalg.norm(of[edge[:, 0]] - of[edge[:, 1]], axis=1) for of in (lifted.vertices, found.vertices)
    )
    assert (after < 2 * before + 0.004).all()
