"""Out of the picture: the pictured pose first, the clip at the end, and no skating between."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from engine.geometry.rigging.skeleton import Skeleton
from engine.motion import rotation
from engine.motion.clip import Clip
from engine.motion.feet.foot_contact import sinking_depth, sole_places
from engine.motion.kinematics import joint_places
from engine.motion.library import CLIPS, built_in
from engine.motion.library.posture import Arm, Foot, Posture, embody
from engine.motion.step_out import step_out

LEGS_APART = Posture(
    1,
    root=(0.03, -0.01, 0.0),
    hips=(0.0, 18.0, 3.0),
    spine=(2.0, -10.0, -6.0),
    head=(5.0, 15.0, 4.0),
    arms={"Left": Arm(swing=20.0, lift=25.0, elbow=95.0, twist=-40.0), "Right": Arm(swing=-5.0, lift=15.0, elbow=25.0)},
    feet={"Left": Foot(aside=0.12, ahead=0.12, yaw=25.0), "Right": Foot(aside=-0.06, ahead=-0.08, yaw=10.0)},
)
STANDING = Posture(1, feet={"Left": Foot(aside=0.05), "Right": Foot(aside=-0.05, yaw=20.0)})


@pytest.fixture(params=[LEGS_APART, STANDING], ids=["legs apart", "standing"])
def pictured(request: pytest.FixtureRequest, skeleton: Skeleton) -> Clip:
    pose = embody(request.param, skeleton, "pictured", 30.0)
    return replace(pose, root=pose.root + np.float32([0.4, 0.0, -0.3]))


def turned(one: np.ndarray, other: np.ndarray) -> np.ndarray:
    return np.degrees(rotation.angle(rotation.multiply(rotation.inverse(one), other)))


@pytest.mark.parametrize("name", CLIPS)
def test_the_first_frame_is_the_picture_and_the_last_the_clip(skeleton: Skeleton, pictured: Clip, name: str) -> None:
    clip = built_in(name, skeleton)
    out = step_out(skeleton, pictured, clip)
    assert np.allclose(out.rotations[0], pictured.rotations[0], atol=1e-5)
    assert np.allclose(out.root[0], pictured.root[0], atol=1e-5)
    assert not out.loops
    if clip.loops:
        assert min(turned(out.rotations[-1], frame).max() for frame in clip.rotations) < 8
    else:
        assert turned(out.rotations[-1], clip.rotations[-1]).max() < 1
        assert out.seconds == pytest.approx(clip.seconds + 0.4, abs=0.05)


@pytest.mark.parametrize("name", CLIPS)
def test_feet_step_and_do_not_skate(skeleton: Skeleton, pictured: Clip, name: str) -> None:
    """A foot that lies on the ground in two frames on end is at one place in both: within half a centimetre, for a foot
    may leave or touch the ground between them."""
    out = step_out(skeleton, pictured, built_in(name, skeleton, 60.0))
    points = sole_places(skeleton, out)
    assert sinking_depth(points) < 0.05
    low = points[:, :, :2, 1].min(-1) < 0.004
    steps = np.linalg.norm(np.diff(points[:, :, :2][..., [0, 2]], axis=0), axis=-1).min(-1)
    assert steps[low[1:] & low[:-1]].max() < 0.005


@pytest.mark.parametrize("name", CLIPS)
def test_nothing_jumps(skeleton: Skeleton, pictured: Clip, name: str) -> None:
    clip = built_in(name, skeleton)
    out = step_out(skeleton, pictured, clip)
    fastest = [np.linalg.norm(np.diff(joint_places(skeleton, c), axis=0), axis=-1).max() * 30 for c in (clip, out)]
    assert fastest[1] < max(1.3 * fastest[0], 3.5)
    assert np.linalg.norm(np.diff(out.root[:3], axis=0), axis=-1).max() < 0.02  # from rest


def test_the_walk_goes_on_towards_us(skeleton: Skeleton, pictured: Clip) -> None:
    out = step_out(skeleton, pictured, built_in("walk", skeleton), length=4.0)
    assert out.seconds == pytest.approx(4.0, abs=0.02)
    way = out.root[-1] - out.root[0]
    assert way[2] > 3.0
    assert abs(way[0]) < 0.2
