"""Joints between joints: a round sleeve about two bones, of which it is known how thick it is where it bends."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from engine.export.animation_tracks import tracks
from engine.geometry.rigging.half_joints import BACK_SUFFIX, HALF_SUFFIX, is_half_joint, whole_joints, with_half_joints
from engine.geometry.rigging.skeleton import Skeleton
from engine.geometry.rigging.skinned_mesh import SkinnedMesh
from engine.geometry.rigging.skinning import skin
from engine.motion import rotation
from engine.motion.clip import Clip
from engine.motion.half_turns import half_twist, swing
from engine.motion.kinematics import pose_transforms

BEND = rotation.about("z", np.radians(120))


def sleeve() -> SkinnedMesh:
    """Rings of radius 0.1 about the x axis, ten to a bone 1 long; the elbow is at the origin, and moves what it moves in proportion
    to the place from 0.2 before to 0.2 behind it."""
    skeleton = Skeleton(
        ("LeftArm", "LeftForeArm", "LeftHand"),
        np.array([-1, 0, 1], np.int32),
        np.array([[-1, 0, 0], [0, 0, 0], [1, 0, 0]], np.float32),
    )
    x, turn = np.meshgrid(np.linspace(-1, 1, 21), np.arange(16) * np.pi / 8, indexing="ij")
    vertices = np.stack([x, 0.1 * np.cos(turn), 0.1 * np.sin(turn)], -1).reshape(-1, 3)
    lower = np.clip(0.5 + vertices[:, 0] / 0.4, 0, 1)
    bones = np.zeros((len(vertices), 4), np.uint8)
    bones[:, 1] = 1
    weights = np.zeros((len(vertices), 4), np.float32)
    weights[:, 0], weights[:, 1] = 1 - lower, lower
    none = np.zeros((0, 3), np.int32)
    return SkinnedMesh(
        skeleton,
        vertices.astype(np.float32),
        none,
        np.zeros((len(vertices), 2), np.float32),
        bones,
        weights,
        np.zeros((2, 2, 3), np.uint8),
    )


def bent(mesh: SkinnedMesh, elbow: NDArray[np.float64]) -> NDArray[np.float64]:
    """(21, 16, 3) the rings where the elbow turns so."""
    turns = rotation.identity(1, len(mesh.skeleton.names))
    turns[0, 1] = elbow
    transforms = pose_transforms(mesh.skeleton, turns, mesh.skeleton.heads[:1])[0]
    return skin(mesh.vertices, mesh.bones, mesh.weights, transforms).reshape(21, 16, 3).astype(np.float64)


def thickness(ring: NDArray[np.float64]) -> float:
    """Between its outermost points, of 0.2 at rest, in the plane in which the elbow bends."""
    return float(np.linalg.norm(ring[0] - ring[8]) / 0.2)


def test_a_bent_elbow_is_as_thick_as_the_cosine_of_a_quarter_of_its_angle() -> None:
    """And not of a half of it."""
    assert thickness(bent(sleeve(), BEND)[10]) == pytest.approx(np.cos(np.radians(60)), abs=1e-5)
    assert thickness(bent(with_half_joints(sleeve()), BEND)[10]) == pytest.approx(1, abs=1e-5)
    beside = [thickness(ring) for ring in bent(with_half_joints(sleeve()), BEND)]
    assert min(beside) == pytest.approx(np.cos(np.radians(30)), abs=1e-5)


def test_nothing_moves_at_rest() -> None:
    mesh = with_half_joints(sleeve())
    assert np.allclose(bent(mesh, rotation.identity()), mesh.vertices.reshape(21, 16, 3), atol=1e-6)
    assert np.array_equal(mesh.vertices, sleeve().vertices)


def test_where_half_joints_are_left_at_rest_the_skin_moves_as_without_them() -> None:
    mesh = with_half_joints(sleeve())
    turns = rotation.identity(1, 3)
    turns[0, 1] = BEND
    plain = pose_transforms(sleeve().skeleton, turns, mesh.skeleton.heads[:1])[0]
    moved = skin(mesh.vertices, whole_joints(mesh.skeleton)[mesh.bones], mesh.weights, plain)
    assert np.allclose(moved, bent(sleeve(), BEND).reshape(-1, 3), atol=1e-6)


def test_a_turn_about_the_bone_is_spread_along_it() -> None:
    """Nothing of it at the elbow, half of it in the middle, all at the wrist; a quarter in, halfway between half joints."""
    rings = bent(with_half_joints(sleeve()), rotation.about("x", np.radians(80)))
    top = rings[:, 0]
    degrees = np.degrees(np.arctan2(top[:, 2], top[:, 1]))
    assert degrees[[0, 10, 15, 20]] == pytest.approx([0, 0, 40, 80], abs=1e-3)
    assert thickness(rings[15]) == pytest.approx(1, abs=1e-5)


def test_halves_of_half_a_turn_either_way_are_the_same() -> None:
    bone = (0.0, 2.0, 0.0)
    either = half_twist(rotation.about("y", np.radians([179.99, -179.99])), bone)
    assert rotation.angle(rotation.multiply(rotation.inverse(either[0]), either[1])) < 1e-3
    quarter = half_twist(rotation.about("y", np.radians([90.0, -120.0])), bone)
    assert np.allclose(quarter, rotation.about("y", np.radians([45.0, -60.0])))


def test_a_swing_points_where_the_whole_points_and_turns_nothing_about_the_bone() -> None:
    whole = rotation.normalize(np.random.default_rng(0).normal(size=(20, 4)))
    bone = np.array([0.0, 0.0, 3.0])
    swung = swing(whole, bone)
    assert np.allclose(rotation.rotate(swung, bone), rotation.rotate(whole, bone))
    assert np.allclose(swung[:, 2], 0)  # its axis is square to the bone


def test_files_hold_how_half_joints_turn_whatever_the_clip_says() -> None:
    skeleton = with_half_joints(sleeve()).skeleton
    turns = rotation.identity(2, len(skeleton.names))
    turns[1, 1] = BEND
    turns[:, skeleton.index("LeftForeArm" + HALF_SUFFIX)] = rotation.about("x", 1.0)
    kept = tracks(Clip("bend", 30.0, turns, np.zeros((2, 3))), skeleton)
    half, back = (kept.rotations[:, skeleton.index("LeftForeArm" + suffix)] for suffix in (HALF_SUFFIX, BACK_SUFFIX))
    assert np.allclose(half[1], rotation.about("z", np.radians(60)), atol=1e-6)
    assert np.allclose(half[0], rotation.identity())
    assert np.allclose(rotation.multiply(kept.rotations[1, 1], back[1]), half[1], atol=1e-6)


def test_half_joints_are_known_by_their_names() -> None:
    assert is_half_joint("LeftArmHalf") and is_half_joint("RightLegHalfTwist")
    assert not is_half_joint("LeftArm") and not is_half_joint("HipsHalf")
