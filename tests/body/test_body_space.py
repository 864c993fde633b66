"""The space of bodies: what it holds of people it has not seen, and a T-pose that is one."""

from __future__ import annotations

import numpy as np
import pytest

from engine.body import Template
from engine.body.body_space import BodySpace, load_body_space, sample_bodies
from engine.body.rest_pose import shortest_rotation, t_pose
from engine.body.rig import HUMAN_RIG
from engine.body.template import load_rig


@pytest.fixture(scope="module")
def space() -> BodySpace:
    return load_body_space()


def test_it_has_thirty_directions_and_more_that_hold_nearly_everything(space: BodySpace) -> None:
    assert len(space.basis) >= 30
    assert space.variance_held[-1] > 0.999
    assert (np.diff(space.variance_held) > 0).all()


def test_people_it_has_not_seen_are_found_in_it(space: BodySpace, template: Template) -> None:
    """Within half a centimetre, in the mean over the skin."""
    skin = template.vertices_of("body")
    bodies, joints = sample_bodies(6, seed=99)
    basis = space.basis[:, skin].reshape(len(space.basis), -1)
    for body, joint in zip(bodies, joints, strict=True):
        found = np.linalg.lstsq(basis.T, (body - space.mean)[skin].ravel(), rcond=None)[0]
        assert np.linalg.norm((space.vertices(found) - body)[skin], axis=1).mean() < 0.005
        assert np.linalg.norm(space.joints(found) - joint, axis=1).max() < 0.02


def test_arms_lie_along_x_and_legs_hang_down(space: BodySpace) -> None:
    skeleton = space.skeleton(np.zeros(1))
    place = dict(zip(skeleton.names, skeleton.heads, strict=True))
    for side, sign in (("Left", 1), ("Right", -1)):
        for a, b in (("Arm", "ForeArm"), ("ForeArm", "Hand")):
            bone = place[f"{side}{b}"] - place[f"{side}{a}"]
            assert sign * bone[0] > 0.999 * np.linalg.norm(bone)
        for a, b in (("UpLeg", "Leg"), ("Leg", "Foot")):
            bone = place[f"{side}{b}"] - place[f"{side}{a}"]
            assert -bone[1] > 0.999 * np.linalg.norm(bone)


def test_feet_stand_on_the_ground(space: BodySpace, template: Template) -> None:
    skin = space.mean[template.vertices_of("body")]
    assert abs(skin[:, 1].min()) < 0.003
    assert 1.4 < np.ptp(skin[:, 1]) < 1.9


def test_bones_keep_their_length_on_the_way_to_the_t_pose(template: Template) -> None:
    rig = load_rig(HUMAN_RIG)
    skeleton, _, _ = t_pose(rig, template.vertices, template.vertices_of("body"))
    before, _ = rig.joints(template.vertices)
    linked = np.flatnonzero(rig.parents >= 0)
    lengths = [np.linalg.norm(heads[linked] - heads[rig.parents[linked]], axis=1) for heads in (skeleton.heads, before)]
    np.testing.assert_allclose(*lengths, atol=1e-5)


def test_in_t_pose_the_skin_stands_on_the_ground_with_the_hips_above_the_origin(template: Template) -> None:
    """Wherever the template was; the cages about the skin, which go lower, do not count."""
    skin = template.vertices_of("body")
    elsewhere = template.vertices + np.array([0.3, -0.7, 0.2], np.float32)
    skeleton, _, posed = t_pose(load_rig(HUMAN_RIG), elsewhere, skin)
    assert posed[:, 1].min() < -0.001
    assert abs(posed[skin, 1].min()) < 1e-6
    np.testing.assert_allclose(skeleton.heads[0, [0, 2]], 0, atol=1e-6)


@pytest.mark.parametrize("end", [(0, 0, 1), (1, 0, 0), (-1, 0, 0), (0.6, -0.8, 0)])
def test_the_shortest_turn_brings_one_direction_to_another(end: tuple[float, float, float]) -> None:
    turn = shortest_rotation(np.array([2.0, 0, 0]), np.array(end))
    np.testing.assert_allclose(turn @ [1, 0, 0], end, atol=1e-12)
    np.testing.assert_allclose(turn @ turn.T, np.eye(3), atol=1e-12)
    assert np.isclose(np.linalg.det(turn), 1)
