"""Forward kinematics."""

from __future__ import annotations

import numpy as np

from engine.geometry.rigging.skeleton import Skeleton
from engine.motion import rotation
from engine.motion.clip import Clip
from engine.motion.kinematics import joint_places, local_rotations, world_rotations, world_transforms


def still(skeleton: Skeleton, frames: int = 1) -> Clip:
    rotations = rotation.identity(frames, len(skeleton.names)).astype(np.float32)
    return Clip("still", 30.0, rotations, np.tile(skeleton.heads[:1], (frames, 1)))


def test_nothing_turned_is_the_t_pose(skeleton: Skeleton) -> None:
    matrices = world_transforms(skeleton, still(skeleton, 3))
    assert matrices.shape == (3, len(skeleton.names), 4, 4)
    assert np.allclose(matrices[..., :3, 3], skeleton.heads, atol=1e-6)
    assert np.allclose(matrices[..., :3, :3], np.eye(3))


def test_an_elbow_bent_by_a_right_angle_brings_the_hand_before_the_elbow(skeleton: Skeleton) -> None:
    clip = still(skeleton)
    clip.rotations[0, skeleton.index("LeftForeArm")] = rotation.about("y", -np.pi / 2)
    places = joint_places(skeleton, clip)[0]
    elbow, hand = places[skeleton.index("LeftForeArm")], places[skeleton.index("LeftHand")]
    assert np.allclose(hand - elbow, [0, 0, 0.24], atol=1e-6)


def test_a_turned_root_turns_everything_about_itself(skeleton: Skeleton) -> None:
    clip = still(skeleton)
    clip.root[0] = (1, 2, 3)
    clip.rotations[0, 0] = rotation.about("y", np.pi / 2)
    arm = skeleton.heads[skeleton.index("LeftHand")] - skeleton.heads[0]
    hand = joint_places(skeleton, clip)[0, skeleton.index("LeftHand")]
    assert np.allclose(hand, [1 + arm[2], 2 + arm[1], 3 - arm[0]], atol=1e-6)


def test_local_and_world_turns_are_each_others_inverse(skeleton: Skeleton) -> None:
    turns = rotation.normalize(np.random.default_rng(1).normal(size=(5, len(skeleton.names), 4)))
    back = local_rotations(skeleton.parents, world_rotations(skeleton.parents, turns))
    assert np.allclose(np.abs(np.sum(back * turns, -1)), 1)
