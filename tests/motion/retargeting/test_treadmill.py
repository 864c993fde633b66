"""Walks in place that get on; everything else stays where it is."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from humanoids import build_skeleton, on_feet, treadmill_walk

from engine.geometry.rigging.skeleton import Skeleton
from engine.motion import rotation
from engine.motion.clip import Clip
from engine.motion.edit import in_place, loop_travel, repeat_loop
from engine.motion.feet.foot_contact import find_contacts, sliding_speed, sole_places
from engine.motion.files.bvh import read_bvh
from engine.motion.files.gltf_motion import read_gltf_motion
from engine.motion.library import CLIPS, built_in
from engine.motion.retargeting.retarget import retarget
from engine.motion.retargeting.treadmill import travel_as_walked

Media = Callable[[str], Path]


@pytest.mark.parametrize("speed", [0.5, 1.0, -0.8])
def test_a_walk_gets_as_far_as_its_feet_go_back(skeleton: Skeleton, speed: float) -> None:
    clip = travel_as_walked(skeleton, treadmill_walk(skeleton, speed))
    assert np.allclose(loop_travel(clip), [0, 0, speed], atol=0.02)  # in a round of one second
    points = sole_places(skeleton, repeat_loop(clip, 90))
    assert sliding_speed(points, find_contacts(points, 30.0), 30.0) < 3


def test_it_walks_where_it_looks(skeleton: Skeleton) -> None:
    clip = treadmill_walk(skeleton, 1.0)
    turn = rotation.about("y", np.radians(60))
    rotations = clip.rotations.copy()
    rotations[:, 0] = rotation.multiply(turn, rotations[:, 0])
    aside = replace(clip, rotations=rotations, root=rotation.rotate(turn, clip.root).astype(np.float32))
    assert np.allclose(loop_travel(travel_as_walked(skeleton, aside)), [np.sin(np.radians(60)), 0, 0.5], atol=0.02)


def test_the_way_is_as_long_as_the_legs(skeleton: Skeleton) -> None:
    child = build_skeleton(scale=0.6)
    assert loop_travel(travel_as_walked(child, treadmill_walk(child, 0.6)))[2] == pytest.approx(0.6, abs=0.02)


@pytest.mark.parametrize(("name", "off"), [("walk", 0.02), ("run", 0.08)])
@pytest.mark.parametrize("loops", [True, False])
def test_our_own_gaits_in_place_travel_again(skeleton: Skeleton, name: str, off: float, loops: bool) -> None:
    clip = built_in(name, skeleton)
    still = in_place(clip)
    if not loops:
        clip, still = repeat_loop(clip, 70), repeat_loop(still, 70)
    again = travel_as_walked(skeleton, still)
    assert again.root[-1, 2] - again.root[0, 2] == pytest.approx(clip.root[-1, 2] - clip.root[0, 2], rel=off)


@pytest.mark.parametrize("name", CLIPS)
def test_what_travels_or_stands_is_left_alone(skeleton: Skeleton, name: str) -> None:
    clip = built_in(name, skeleton)
    assert travel_as_walked(skeleton, clip) is clip


def test_marching_on_the_spot_is_left_alone(skeleton: Skeleton) -> None:
    clip = treadmill_walk(skeleton, 0.0)
    assert travel_as_walked(skeleton, clip) is clip


def test_who_pushes_with_one_foot_only_is_left_alone(skeleton: Skeleton) -> None:
    """The right leg as it stands in the first frame, with the ground under the left alone."""
    clip = treadmill_walk(skeleton, 1.0)
    rotations = clip.rotations.copy()
    for part in ("UpLeg", "Leg", "Foot"):
        rotations[:, skeleton.index(f"Right{part}")] = rotations[24, skeleton.index(f"Right{part}")]
    scooter = replace(clip, rotations=rotations)
    assert travel_as_walked(skeleton, scooter) is scooter


@pytest.mark.parametrize("way", [1, -1])
def test_a_cyclist_is_left_alone(skeleton: Skeleton, way: int) -> None:
    """Pedals go round, the lower one back with the road."""
    turn = 2 * np.pi * (np.arange(30)[:, None] / 30 + [0.0, 0.5])
    cyclist = on_feet(skeleton, 0.1 + 0.17 * way * np.cos(turn), 0.17 * (1 + np.sin(turn)), 0.15)
    assert travel_as_walked(skeleton, cyclist) is cyclist


def test_a_skater_is_left_alone(skeleton: Skeleton) -> None:
    """Feet that glide over the ground with the body."""
    clip = built_in("idle", skeleton)
    glide = np.arange(len(clip.root))[:, None] * [0, 0, 0.05]
    skater = replace(clip, root=(clip.root + glide).astype(np.float32))
    assert travel_as_walked(skeleton, skater) is skater


def test_a_clip_of_a_frame_or_two_is_left_alone(skeleton: Skeleton) -> None:
    for frames in (1, 2):
        clip = Clip(
            "still",
            30.0,
            rotation.identity(frames, len(skeleton.names)).astype(np.float32),
            np.repeat(skeleton.heads[:1], frames, 0),
        )
        assert travel_as_walked(skeleton, clip) is clip


def speed(clip: Clip) -> float:
    return float(loop_travel(clip)[2] / clip.seconds)


def test_real_clips_in_place_go_ahead_and_do_not_slide(media: Media, skeleton: Skeleton) -> None:
    soldier = media("scans3d/body_soldier/soldier.glb")
    walk, run = (read_gltf_motion(soldier, name) for name in ("Walk", "Run"))
    brisk = read_bvh(media("mocap/makehuman_walk_cycle.bvh"))
    for motion, slowest, fastest in ((walk, 1.4, 1.7), (run, 3.5, 4.3), (brisk, 2.6, 3.1)):
        for fps in (24.0, 30.0, 60.0):
            carried = retarget(motion, skeleton, fps=fps)
            assert slowest < speed(carried.clip) < fastest
            assert abs(loop_travel(carried.clip)[0]) < 0.03 * loop_travel(carried.clip)[2]
            assert carried.feet.sliding_after < 0.1
            points = sole_places(skeleton, repeat_loop(carried.clip, 3 * len(carried.clip.root)))
            assert sliding_speed(points, find_contacts(points, fps), fps) < 0.3
            assert find_contacts(points, fps).any(1).mean() > 0.5
