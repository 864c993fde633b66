"""Feet that stand: found and held, where the truth is known because we spoiled it ourselves."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from humanoids import build_skeleton

from engine.geometry.rigging.skeleton import Skeleton
from engine.motion import rotation
from engine.motion.clip import Clip
from engine.motion.edit import loop_travel, repeat_loop
from engine.motion.feet.foot_contact import find_contacts, floor_height, sinking_depth, sliding_speed, sole_places
from engine.motion.feet.foot_hold import hold_feet
from engine.motion.feet.sole import soles
from engine.motion.kinematics import joint_places, local_rotations, world_rotations
from engine.motion.library import built_in


def spoiled(skeleton: Skeleton) -> tuple[Clip, Clip]:
    """A walk, and the same walk skating: the root slides by another 6 cm to and fro and sinks by 2 cm, legs as before,
    and the ground is 30 cm higher."""
    clip = built_in("walk", skeleton)
    clip = repeat_loop(clip, 3 * len(clip.root))
    time = np.arange(len(clip.root)) / clip.fps
    off = np.stack([0.03 * np.sin(5 * time), 0.3 - 0.01 + 0.01 * np.cos(9 * time), 0.05 * np.sin(7 * time)], 1)
    return clip, replace(clip, root=(clip.root + off).astype(np.float32))


def test_soles_lie_on_the_ground_at_rest(skeleton: Skeleton) -> None:
    clip = Clip("still", 30.0, rotation.identity(1, len(skeleton.names)).astype(np.float32), skeleton.heads[:1])
    points = sole_places(skeleton, clip)
    assert np.allclose(points[..., 1], 0, atol=1e-6)
    assert (np.diff(points[..., 2], axis=-1) > 0.04).all()  # heel, ball, tip from back to front
    ankle = skeleton.heads[skeleton.index("LeftFoot")]
    assert points[0, 0, 0, 2] < ankle[2] < points[0, 0, 1, 2]


def test_contacts_are_those_that_the_clip_was_made_with(skeleton: Skeleton) -> None:
    clip = built_in("walk", skeleton, 60.0)
    stands = find_contacts(sole_places(skeleton, repeat_loop(clip, 132)), 60.0)
    own = (np.arange(132) / 66 + np.array([[0.0], [0.5]])) % 1.0
    surely_stands, surely_swings = (own > 0.04) & (own < 0.58), (own > 0.72) & (own < 0.9)
    assert stands.T[surely_stands].mean() > 0.97
    assert stands.T[surely_swings].mean() < 0.03


def test_a_skating_walk_is_held(skeleton: Skeleton) -> None:
    clip, skating = spoiled(skeleton)
    held, report = hold_feet(skeleton, skating)
    assert report.sliding_before > 8
    assert report.sliding_after < 0.3
    assert sinking_depth(sole_places(skeleton, held)) < 0.01
    assert floor_height(sole_places(skeleton, held), held.fps) == pytest.approx(0, abs=0.01)
    # and it is still that walk: joints are where they were, but for what was spoiled
    apart = np.linalg.norm(joint_places(skeleton, held) - joint_places(skeleton, clip), axis=-1)
    assert np.median(apart) < 0.06


def test_holding_adds_no_jerks(skeleton: Skeleton) -> None:
    _, skating = spoiled(skeleton)
    held, _ = hold_feet(skeleton, skating)
    fastest = [np.linalg.norm(np.diff(joint_places(skeleton, c), n=2, axis=0), axis=-1).max() for c in (skating, held)]
    assert fastest[1] < 1.6 * fastest[0]


def test_feet_that_stand_well_are_left_alone(skeleton: Skeleton) -> None:
    for name in ("idle", "bow", "sit"):
        clip = built_in(name, skeleton)
        held, _ = hold_feet(skeleton, clip)
        assert np.linalg.norm(joint_places(skeleton, held) - joint_places(skeleton, clip), axis=-1).max() < 0.005


def test_a_walk_in_place_keeps_going_in_place(skeleton: Skeleton) -> None:
    """On a treadmill no foot stands, so none is held."""
    from engine.motion.edit import in_place

    clip = in_place(built_in("walk", skeleton))
    held, report = hold_feet(skeleton, clip)
    assert report.standing < 0.2
    assert np.linalg.norm(joint_places(skeleton, held) - joint_places(skeleton, clip), axis=-1).max() < 0.03


def test_a_loop_stays_a_loop(skeleton: Skeleton) -> None:
    clip = built_in("walk", skeleton)
    held, _ = hold_feet(skeleton, clip)
    assert held.loops
    assert len(held.root) == len(clip.root)
    assert np.allclose(loop_travel(held), loop_travel(clip), atol=0.002)
    places = joint_places(skeleton, repeat_loop(held, 2 * len(held.root)))
    steps = np.linalg.norm(np.diff(places, n=2, axis=0), axis=-1).max(-1)
    seam = len(held.root)
    assert steps[seam - 2 : seam + 1].max() <= 1.1 * steps[: seam - 2].max()


def test_a_tilted_foot_is_levelled(skeleton: Skeleton) -> None:
    """A rest pose that was wrong about the feet by twelve degrees shows in every frame: it is found and taken off."""
    clip = built_in("idle", skeleton)
    world = world_rotations(skeleton.parents, clip.rotations)
    for sole in soles(skeleton):
        tilted = rotation.multiply(world[:, sole.joints[2]], rotation.about("x", np.radians(-12)))
        world[:, sole.joints[2]] = tilted
    tilted_clip = replace(clip, rotations=local_rotations(skeleton.parents, world).astype(np.float32))
    held, _ = hold_feet(skeleton, tilted_clip)
    assert np.abs(sole_places(skeleton, held)[:, :, :2, 1]).max() < 0.002


def test_a_shuffling_foot_is_let_go_while_it_moves(skeleton: Skeleton) -> None:
    """It stands, glides aside by 20 cm in half a second without leaving the ground, and stands: two places, not one."""
    frames = 90
    still = rotation.identity(frames, len(skeleton.names)).astype(np.float32)
    way = np.clip((np.arange(frames) - 40) / 15, 0, 1)
    root = np.tile(skeleton.heads[:1], (frames, 1)) + np.outer(0.2 * way, [1, 0, 0])
    clip = Clip("shuffle", 30.0, still, root.astype(np.float32))
    points = sole_places(skeleton, clip)
    stands = find_contacts(points, 30.0)
    assert stands[:36].all()
    assert stands[60:].all()
    assert not stands[46:49].any()
    assert sliding_speed(points, stands, 30.0) < 5
    held, _ = hold_feet(skeleton, clip)
    assert np.linalg.norm(np.diff(sole_places(skeleton, held), axis=0), axis=-1).max() < 0.035


def test_one_frame_is_enough() -> None:
    skeleton = build_skeleton()
    clip = Clip(
        "still",
        30.0,
        rotation.identity(1, len(skeleton.names)).astype(np.float32),
        skeleton.heads[:1] + np.float32([0, 1, 0]),
    )
    held, report = hold_feet(skeleton, clip)
    assert np.allclose(held.root[0], skeleton.heads[0], atol=1e-3)
    assert report.sliding_after == 0
