"""Skinning undone."""

from __future__ import annotations

import numpy as np
from known_person import KnownPerson
from scipy.spatial.transform import Rotation

from engine.avatar.registration.models import HumanModels
from engine.avatar.registration.rigging import Pose, rest_joints, unposed


def test_a_posed_body_comes_back_to_t_pose(models: HumanModels, person: KnownPerson) -> None:
    posed = models.body.poser(person.parameters[None])
    pose = Pose(posed.joints[0], posed.world_rotations[0])
    rest = rest_joints(pose, models.rig.parents)
    shift = posed.rest[0, 0] - rest[0]
    assert np.allclose(rest + shift, posed.rest[0], atol=1e-6)
    skin = models.skin
    back = unposed(person.vertices[skin.vertices], skin.bones, skin.weights, pose, rest)
    off = np.linalg.norm(back + shift - models.body.rest(person.parameters), axis=1)
    assert np.percentile(off, 99) < 1e-4  # but for where the blend is nearly flat


def test_flat_blends_do_not_explode() -> None:
    """Half of one turn and half of its opposite leave no extent along one direction: the inverse is bounded."""
    turns = Rotation.from_rotvec([[0, 0, 0], [0, 0, np.pi - 1e-3]]).as_matrix()
    pose = Pose(np.zeros((2, 3)), turns)
    found = unposed(np.array([[0.0, 0.1, 0.1]]), np.array([[0, 1]]), np.array([[0.5, 0.5]]), pose, np.zeros((2, 3)))
    assert np.linalg.norm(found) < 0.3
