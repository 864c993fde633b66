"""Shoulders in T-pose of people who were filmed with their arms lowered."""

from __future__ import annotations

import numpy as np
import pytest
from known_person import KnownPerson

from engine.avatar.registration.models import HumanModels
from engine.avatar.registration.resting_shoulders import with_resting_shoulders
from engine.avatar.registration.rigging import Pose, rest_joints, unposed
from engine.geometry.mesh.surface import vertex_normals


def arm_share(models: HumanModels) -> np.ndarray:
    """(S,) what the arms move of the skin."""
    both = sum(models.rig.weights_below(f"{side}Arm") for side in ("Left", "Right"))
    return np.asarray(both)[models.skin.vertices]


def test_volume_that_blending_lost_makes_no_point_above_the_shoulder(models: HumanModels, person: KnownPerson) -> None:
    """Somebody whose shoulders have 1.5 cm more than the blend gives them, where arm and trunk share the skin half and half."""
    skin, rig = models.skin, models.rig
    share = arm_share(models)
    more = np.zeros_like(person.vertices)
    normals = vertex_normals(person.vertices[skin.vertices], skin.triangles)
    more[skin.vertices] = 0.015 * (4 * share * (1 - share))[:, None] * normals
    posed = models.body.poser(person.parameters[None])
    pose = Pose(posed.joints[0], posed.world_rotations[0])
    at_rest = rest_joints(pose, rig.parents)
    flat = unposed(person.vertices + more, rig.bones, rig.weights, pose, at_rest)
    flat += posed.rest[0, 0] - at_rest[0]
    coefficients = person.parameters[-models.body.coefficients :]
    mended = with_resting_shoulders(models, flat, coefficients)[skin.vertices]
    known = models.space.vertices(coefficients)[skin.vertices]
    shoulder = (share > 0.2) & (share < 0.8)
    assert np.linalg.norm(flat[skin.vertices] - known, axis=1)[shoulder].max() > 0.015
    assert np.linalg.norm(mended - known, axis=1)[shoulder].max() < 0.003


def test_shoulders_go_with_what_is_around_them_and_all_else_stays(models: HumanModels) -> None:
    coefficients = np.zeros(models.body.coefficients)
    flat = models.space.vertices(coefficients) + np.array([0.02, -0.01, 0.03])
    assert with_resting_shoulders(models, flat, coefficients) == pytest.approx(flat, abs=1e-6)
    rough = flat + np.random.default_rng(1).normal(0, 0.002, flat.shape)
    mended = with_resting_shoulders(models, rough, coefficients)
    changed = (mended != rough).any(1)[models.skin.vertices]
    share = arm_share(models)
    assert changed[(share > 0.01) & (share < 0.99)].all()
    assert changed.mean() < 0.1
