"""Motions that lead into themselves, and those that do not."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from humanoids import told_by, treadmill_walk

from engine.geometry.rigging.skeleton import Skeleton
from engine.motion import rotation
from engine.motion.clip import Clip
from engine.motion.edit import loop_travel, repeat_loop
from engine.motion.feet.foot_contact import find_contacts, sole_places, true_runs
from engine.motion.files.bvh import read_bvh
from engine.motion.files.gltf_motion import read_gltf_motion
from engine.motion.files.source_motion import SourceMotion
from engine.motion.kinematics import joint_places
from engine.motion.library import built_in
from engine.motion.retargeting.retarget import retarget

Media = Callable[[str], Path]


def told(skeleton: Skeleton, clip: Clip) -> SourceMotion:
    return told_by(skeleton, clip, rotation.identity(len(skeleton.names)), rotation.identity(), 0.01)


@pytest.mark.parametrize("name", ["idle", "walk", "run", "dance"])
@pytest.mark.parametrize("fps", [24.0, 30.0, 60.0])
def test_what_shows_its_first_pose_again_is_a_loop(skeleton: Skeleton, name: str, fps: float) -> None:
    clip = built_in(name, skeleton, fps)
    motion = told(skeleton, repeat_loop(clip, len(clip.root) + 1))
    back = retarget(motion, skeleton, fps=fps, facing="keep", feet=False).clip
    assert back.loops
    assert np.allclose(back.rotations, clip.rotations, atol=1e-3)
    assert np.allclose(loop_travel(back), loop_travel(clip), atol=1e-3)


def test_what_leads_into_its_first_pose_is_a_loop(skeleton: Skeleton) -> None:
    """As most game engines keep them: the first frame is not there twice."""
    clip = built_in("dance", skeleton, 60.0)
    back = retarget(told(skeleton, clip), skeleton, fps=60.0, facing="keep", feet=False).clip
    assert back.loops
    assert np.allclose(back.rotations, clip.rotations, atol=1e-3)


def test_a_loop_cut_between_two_frames_closes_evenly(skeleton: Skeleton) -> None:
    """Every fifth frame of 168: the round is over six tenths of a step after the last."""
    fine = built_in("run", skeleton, 240.0)
    coarse = replace(fine, fps=48.0, rotations=fine.rotations[::5], root=fine.root[::5], loops=False)
    back = retarget(told(skeleton, coarse), skeleton, fps=48.0, facing="keep", feet=False).clip
    assert back.loops
    assert len(back.root) == 34
    assert loop_travel(back)[2] == pytest.approx(loop_travel(fine)[2], rel=0.02)
    places = joint_places(skeleton, repeat_loop(back, 3 * 34))
    steps = np.linalg.norm(np.diff(places, axis=0), axis=-1).max(-1)
    assert steps[30:37] == pytest.approx(steps[64:71], rel=1e-3)
    assert steps[33] == pytest.approx((steps[32] + steps[34]) / 2, rel=0.1)


@pytest.mark.parametrize("missing", [3, 6, 12])
def test_an_open_walk_is_no_loop(skeleton: Skeleton, missing: int) -> None:
    clip = built_in("walk", skeleton)
    part = repeat_loop(clip, 2 * len(clip.root) - missing)
    back = retarget(told(skeleton, part), skeleton, facing="keep", feet=False).clip
    assert not back.loops
    assert len(back.root) == len(part.root)
    assert np.allclose(back.rotations, part.rotations, atol=1e-3)


@pytest.mark.parametrize("name", ["jump", "wave", "bow"])
def test_what_comes_back_to_rest_is_done_once(skeleton: Skeleton, name: str) -> None:
    clip = built_in(name, skeleton)
    assert np.array_equal(clip.rotations[0], clip.rotations[-1])
    assert not retarget(told(skeleton, clip), skeleton).clip.loops


def test_who_climbs_comes_nowhere_twice(skeleton: Skeleton) -> None:
    clip = built_in("walk", skeleton)
    motion = told(skeleton, repeat_loop(clip, len(clip.root) + 1))
    motion.translations[:, 0, 1] += np.linspace(0, 17, len(motion.translations))  # a stair, centimetres
    assert not retarget(motion, skeleton).clip.loops


def test_a_files_word_is_taken(skeleton: Skeleton) -> None:
    bow, walk = built_in("bow", skeleton), built_in("walk", skeleton)
    marked = retarget(replace(told(skeleton, bow), loops=True), skeleton).clip
    assert marked.loops
    assert len(marked.root) == len(bow.root) - 1
    once = told(skeleton, repeat_loop(walk, len(walk.root) + 1))
    assert not retarget(replace(once, loops=False), skeleton).clip.loops


@pytest.mark.parametrize("name", ["bandai_kick", "bandai_run_active", "cmu_02_01_walk", "cmu_05_06_dance", "cmu_131_03_hop",
                                  "cmu_jumping_jacks", "fair_jumping", "fair_wave_hello"])  # fmt: skip
def test_recordings_play_once(media: Media, skeleton: Skeleton, name: str) -> None:
    assert not retarget(read_bvh(media(f"mocap/{name}.bvh")), skeleton).clip.loops


@pytest.mark.parametrize("name", ["Idle", "Walk", "Run"])
def test_clips_for_games_are_loops(media: Media, skeleton: Skeleton, name: str) -> None:
    motion = read_gltf_motion(media("scans3d/body_soldier/soldier.glb"), name)
    clip = retarget(motion, skeleton).clip
    assert clip.loops
    assert len(clip.root) == len(motion.rotations) - 1


def test_the_foot_that_stands_at_the_seam_stays_on_its_spot(media: Media, skeleton: Skeleton) -> None:
    by_hand = treadmill_walk(skeleton, 1.0)
    for motion in (
        told(skeleton, repeat_loop(by_hand, len(by_hand.root) + 1, start=8)),
        read_bvh(media("mocap/makehuman_walk_cycle.bvh")),
    ):
        clip = retarget(motion, skeleton).clip
        frames = len(clip.root)
        points = sole_places(skeleton, repeat_loop(clip, 4 * frames))
        stands = find_contacts(points, clip.fps)
        for seam in (2 * frames, 3 * frames):
            across = [
                np.ptp(points[first : last + 1, side, 1, ::2], axis=0).max()
                for side in range(2)
                for first, last in true_runs(stands[:, side])
                if first < seam <= last
            ]
            assert across
            assert max(across) < 0.01
