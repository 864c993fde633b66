"""Skeletons and skinning: rigid motions come back exactly, a bone moves what hangs on it."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from engine.body import Template
from engine.body.rig import FACE_JOINTS, HUMAN_RIG, RIG_NAMES, Rig
from engine.body.template import load_rig
from engine.geometry.rigging.skinning import bone_transforms, skin


@pytest.fixture(scope="module", params=[*RIG_NAMES, HUMAN_RIG])
def rig(request: pytest.FixtureRequest) -> Rig:
    return load_rig(request.param)


def turns(rig: Rig, **rotations: Rotation) -> np.ndarray:
    matrices = np.tile(np.eye(3), (len(rig.names), 1, 1))
    for name, rotation in rotations.items():
        matrices[rig.index(name.replace("__", "."))] = rotation.as_matrix()
    return matrices


def test_weights_sum_to_one_strongest_first(rig: Rig) -> None:
    np.testing.assert_allclose(rig.weights.sum(1), 1, atol=1e-5)
    assert (np.diff(rig.weights, axis=1) <= 0).all()


def test_parents_come_first(rig: Rig) -> None:
    assert (rig.parents < np.arange(len(rig.parents))).all()
    assert (rig.parents == -1).sum() == 1


def test_no_turn_leaves_the_rest_pose(rig: Rig, template: Template) -> None:
    heads, _ = rig.joints(template.vertices)
    posed = skin(template.vertices, rig.bones, rig.weights, bone_transforms(rig.parents, heads, turns(rig)))
    np.testing.assert_allclose(posed, template.vertices, atol=1e-6)


def test_turning_the_root_moves_everything_rigidly(rig: Rig, template: Template) -> None:
    heads, _ = rig.joints(template.vertices)
    turn = Rotation.from_euler("xyz", [0.3, -0.8, 0.2])
    offset = np.array([0.1, 0.2, -0.3])
    matrices = turns(rig)
    matrices[0] = turn.as_matrix()
    posed = skin(template.vertices, rig.bones, rig.weights, bone_transforms(rig.parents, heads, matrices, offset))
    np.testing.assert_allclose(posed, turn.apply(template.vertices - heads[0]) + heads[0] + offset, atol=1e-5)


def test_joints_lie_where_they_should(template: Template) -> None:
    rig = load_rig("mixamo")
    heads, tails = rig.joints(template.vertices)
    place = {name: heads[rig.index(name)] for name in rig.names}
    assert place["Head"][1] > place["Neck"][1] > place["Hips"][1] > place["LeftUpLeg"][1] > place["LeftFoot"][1]
    assert place["LeftHand"][0] > place["LeftForeArm"][0] > place["LeftArm"][0] > 0
    np.testing.assert_allclose(place["RightHand"], place["LeftHand"] * [-1, 1, 1], atol=2e-3)
    np.testing.assert_allclose(tails[rig.index("LeftArm")], place["LeftForeArm"], atol=1e-5)


def test_a_turned_head_carries_the_eyes_and_leaves_the_feet(template: Template) -> None:
    rig = load_rig("default")
    heads, _ = rig.joints(template.vertices)
    turn = Rotation.from_euler("y", 0.4)
    posed = skin(template.vertices, rig.bones, rig.weights, bone_transforms(rig.parents, heads, turns(rig, head=turn)))
    pivot = heads[rig.index("head")]
    eye = template.vertices_of("left_eye")
    np.testing.assert_allclose(posed[eye], turn.apply(template.vertices[eye] - pivot) + pivot, atol=1e-5)
    low = template.vertices[:, 1] < 0
    np.testing.assert_allclose(posed[low], template.vertices[low], atol=1e-6)


def test_the_face_takes_its_weights_from_the_head() -> None:
    human, mixamo = load_rig(HUMAN_RIG), load_rig("mixamo")
    assert human.names == (*mixamo.names, *FACE_JOINTS)
    assert {human.names[human.parents[human.index(joint)]] for joint in FACE_JOINTS} == {"Head"}
    for joint in mixamo.names:
        np.testing.assert_allclose(human.weights_below(joint), mixamo.weights_below(joint), atol=1e-5)


def test_the_jaw_carries_chin_teeth_and_tongue(template: Template) -> None:
    rig = load_rig(HUMAN_RIG)
    heads, _ = rig.joints(template.vertices)
    turn = Rotation.from_euler("x", 0.3)
    posed = skin(template.vertices, rig.bones, rig.weights, bone_transforms(rig.parents, heads, turns(rig, Jaw=turn)))
    moved = posed - template.vertices
    lower, pivot = template.vertices_of("lower_teeth"), heads[rig.index("Jaw")]
    np.testing.assert_allclose(posed[lower], turn.apply(template.vertices[lower] - pivot) + pivot, atol=1e-4)
    assert moved[lower, 1].max() < -0.005
    assert moved[template.vertices_of("tongue"), 1].mean() < -0.005
    assert np.abs(moved[template.vertices_of("upper_teeth")]).max() < 1e-4
    for part in ("left_eye", "right_eye", "left_upper_lashes"):
        assert np.abs(moved[template.vertices_of(part)]).max() < 1e-4


def test_eyes_turn_about_their_middle(template: Template) -> None:
    rig = load_rig(HUMAN_RIG)
    heads, _ = rig.joints(template.vertices)
    turn = Rotation.from_euler("y", 0.3)
    posed = skin(
        template.vertices, rig.bones, rig.weights, bone_transforms(rig.parents, heads, turns(rig, LeftEye=turn))
    )
    eye, pivot = template.vertices_of("left_eye"), heads[rig.index("LeftEye")]
    around = template.vertices[eye]
    assert np.ptp(np.linalg.norm(around - pivot, axis=1)) < 0.005, "the joint is the ball's middle"
    np.testing.assert_allclose(posed[eye], turn.apply(around - pivot) + pivot, atol=1e-3)
    other = template.vertices_of("right_eye")
    np.testing.assert_allclose(posed[other], template.vertices[other], atol=1e-6)
