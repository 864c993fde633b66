"""Axes of joints as Mixamo's rigs have them: against such a rig, and by which way fingers and knees bend."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
import trimesh
from numpy.typing import NDArray
from template_character import template_character

from engine.geometry.rigging.joint_axes import mixamo_axes
from engine.geometry.rigging.skeleton import Skeleton
from engine.motion import rotation

MICHELLE = "scans3d/body_michelle/michelle.glb"
"""A character of Mixamo's, in T-pose."""


@pytest.fixture(scope="module")
def skeleton() -> Skeleton:
    return template_character(texture_size=16).skeleton


def turned(skeleton: Skeleton, joint: str, axis: str, radians: float, seen: str) -> NDArray[np.float64]:
    """How far `seen` moves, metres, when a joint turns about one of its own axes."""
    own = mixamo_axes(skeleton)[skeleton.index(joint)]
    turn = own @ rotation.to_matrix(rotation.about(axis, radians)) @ own.T
    away = skeleton.heads[skeleton.index(seen)] - skeleton.heads[skeleton.index(joint)]
    return np.asarray(turn @ away - away)


def test_they_are_right_handed_and_mirrored(skeleton: Skeleton) -> None:
    axes = mixamo_axes(skeleton)
    np.testing.assert_allclose(axes @ axes.transpose(0, 2, 1), np.tile(np.eye(3), (len(axes), 1, 1)), atol=1e-6)
    assert np.linalg.det(axes) == pytest.approx(1)
    for limb in ("Shoulder", "Arm", "ForeArm", "UpLeg", "Leg", "Foot", "ToeBase"):
        left, right = (axes[skeleton.index(side + limb)] for side in ("Left", "Right"))
        np.testing.assert_allclose(right[:, 1:], left[:, 1:] * [[-1], [1], [1]], atol=0.05)


def test_a_joint_leads_along_its_limb(skeleton: Skeleton) -> None:
    axes = mixamo_axes(skeleton)
    for joint, following in (("LeftArm", "LeftForeArm"), ("RightLeg", "RightFoot"), ("LeftHandRing1", "LeftHandRing2")):
        away = skeleton.heads[skeleton.index(following)] - skeleton.heads[skeleton.index(joint)]
        np.testing.assert_allclose(axes[skeleton.index(joint)][:, 1], away / np.linalg.norm(away), atol=1e-3)


@pytest.mark.parametrize("side", ["Left", "Right"])
def test_fingers_knees_and_elbows_bend_as_they_do_in_a_rig_of_mixamos(skeleton: Skeleton, side: str) -> None:
    finger = turned(skeleton, f"{side}HandIndex1", "x", 0.5, f"{side}HandIndex3")
    assert finger[1] < -0.015, "towards the palm, which looks down"
    assert turned(skeleton, f"{side}Leg", "x", -0.5, f"{side}Foot")[2] < -0.1, "backwards"
    elbow = turned(skeleton, f"{side}ForeArm", "z", 0.5 if side == "Left" else -0.5, f"{side}Hand")
    assert elbow[2] > 0.08 and abs(elbow[1]) < 0.01, "forwards"


def test_a_character_of_mixamos_has_the_axes_that_its_joints_are_said_to_have(media: Callable[[str], Path]) -> None:
    graph = trimesh.load(media(MICHELLE)).graph
    names = tuple(name for name in template_character(texture_size=16).skeleton.names if f"mixamorig:{name}" in graph)
    places = np.stack([graph.get(f"mixamorig:{name}")[0] for name in names])
    found = places[:, :3, :3] / np.linalg.norm(places[:, :3, :3], axis=1, keepdims=True)
    axes = mixamo_axes(Skeleton(names, np.full(len(names), -1, np.int32), places[:, :3, 3].astype(np.float32)))
    angles = np.degrees(rotation.angle(rotation.from_matrix(axes.transpose(0, 2, 1) @ found)))
    assert len(names) == 52
    assert np.median(angles) < 5, dict(zip(names, angles.round(), strict=True))
    assert angles.max() < 30, dict(zip(names, angles.round(), strict=True))
