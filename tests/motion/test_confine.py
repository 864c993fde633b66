"""Motions kept within a room: they end in it, begin as they were, and what stands goes on standing."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from engine.geometry.rigging.skeleton import Skeleton
from engine.motion.clip import Clip
from engine.motion.confine import MovementRoom, confine_clip
from engine.motion.edit import repeat_loop
from engine.motion.feet.foot_contact import sinking_depth, sole_places
from engine.motion.kinematics import joint_places
from engine.motion.library import CLIPS, built_in
from engine.motion.library.posture import Foot, Posture, embody
from engine.motion.step_out import step_out

LUNGE = Posture(1, feet={"Left": Foot(aside=0.08, ahead=0.25), "Right": Foot(aside=-0.08, ahead=-0.15, yaw=20.0)})
WIDE = MovementRoom(100.0, 100.0, 100.0, 100.0)
ROOMS = [MovementRoom(0.5, 1.0, 0.3, 0.3), MovementRoom(0.0, 1.0, 0.0, 0.0), MovementRoom(-0.3, 1.0, 0.1, 0.1)]


@pytest.fixture(scope="module")
def pictured(skeleton: Skeleton) -> Clip:
    return embody(LUNGE, skeleton, "pictured", 60.0)


def film(skeleton: Skeleton, pictured: Clip, name: str, back: float = 0.0) -> Clip:
    clip = built_in(name, skeleton, 60.0)
    return step_out(skeleton, pictured, clip, length=4.0 if clip.loops else None, back=back)


def skates(skeleton: Skeleton, clip: Clip) -> float:
    """Metres from one frame to the next by which a foot that lies on the ground in both moves, at most."""
    points = sole_places(skeleton, clip)
    low = points[:, :, :2, 1].min(-1) < 0.004
    steps = np.linalg.norm(np.diff(points[:, :, :2][..., [0, 2]], axis=0), axis=-1).min(-1)
    return float(steps[low[1:] & low[:-1]].max())


@pytest.mark.parametrize("name", CLIPS)
@pytest.mark.parametrize("room", ROOMS, ids=["some room", "no room", "back"])
def test_who_has_no_room_treads_on_the_spot_and_does_not_skate(
    skeleton: Skeleton, pictured: Clip, name: str, room: MovementRoom
) -> None:
    before = film(skeleton, pictured, name)
    after = confine_clip(skeleton, before, room)
    assert np.array_equal(after.rotations[0], before.rotations[0]) and np.array_equal(after.root[0], before.root[0])
    way = after.root - after.root[0]
    assert way[:, 2].max() <= max(room.ahead, 0) + 1e-6 and np.abs(way[:, 0]).max() <= room.left + 1e-6
    assert skates(skeleton, after) < 0.005
    assert sinking_depth(sole_places(skeleton, after)) < 0.2
    fastest = [np.linalg.norm(np.diff(joint_places(skeleton, c), axis=0), axis=-1).max() for c in (before, after)]
    assert fastest[1] < 1.4 * fastest[0], "nothing jumps"


def test_a_walk_comes_to_the_end_of_its_room_and_goes_on_treading(skeleton: Skeleton, pictured: Clip) -> None:
    after = confine_clip(skeleton, film(skeleton, pictured, "walk"), MovementRoom(0.5, 1.0, 0.3, 0.3))
    deep = after.root[:, 2] - after.root[0, 2]
    assert 0.45 < deep[-1] <= 0.5 and (np.diff(deep) > -0.002).all()
    feet = sole_places(skeleton, after)[-90:, :, 1]
    assert np.ptp(feet[..., 1], axis=0).min() > 0.04, "both feet are lifted"
    assert np.ptp(feet[..., 2], axis=0).max() < 0.1, "on the spot"


def test_without_room_ahead_the_steps_lead_back(skeleton: Skeleton, pictured: Clip) -> None:
    after = confine_clip(skeleton, film(skeleton, pictured, "walk"), MovementRoom(-0.3, 1.0, 0.1, 0.1))
    assert after.root[-1, 2] - after.root[0, 2] == pytest.approx(-0.3, abs=0.02)


@pytest.mark.parametrize("name", CLIPS)
def test_in_a_wide_room_nothing_changes(skeleton: Skeleton, pictured: Clip, name: str) -> None:
    before = film(skeleton, pictured, name)
    assert np.array_equal(confine_clip(skeleton, before, WIDE).rotations, before.rotations)


def test_who_runs_far_to_all_sides_stays_in_the_room(skeleton: Skeleton, pictured: Clip) -> None:
    run = repeat_loop(built_in("run", skeleton, 60.0), 600)
    for turn in range(4):
        x, y, z = run.root.T - run.root[:1].T
        c, s = np.cos(turn * np.pi / 2), np.sin(turn * np.pi / 2)
        gone = replace(run, root=(run.root[0] + np.stack([c * x + s * z, y, c * z - s * x], 1)).astype(np.float32))
        way = confine_clip(skeleton, gone, MovementRoom(0.4, 0.9, 0.2, 0.3)).root - gone.root[0]
        assert way[:, 2].min() >= -0.9 and way[:, 2].max() <= 0.4
        assert way[:, 0].min() >= -0.3 and way[:, 0].max() <= 0.2


def test_lower_leaps_leave_what_is_on_the_ground(skeleton: Skeleton) -> None:
    jump = built_in("jump", skeleton)
    heights = [
        sole_places(skeleton, confine_clip(skeleton, jump, WIDE, leap))[..., 1].min((1, 2)) for leap in (1.0, 0.25)
    ]
    assert heights[0].max() > 0.1
    np.testing.assert_allclose(heights[1], heights[0] * 0.25, atol=0.01)


@pytest.mark.parametrize("name", CLIPS)
def test_a_step_back_is_a_step_of_each_foot(skeleton: Skeleton, pictured: Clip, name: str) -> None:
    there, back = (film(skeleton, pictured, name, step) for step in (0.0, 0.4))
    assert np.array_equal(back.root[0], there.root[0])
    np.testing.assert_allclose(back.root[-1] - there.root[-1], [0, 0, -0.4], atol=0.02)
    assert skates(skeleton, back) < 0.005
