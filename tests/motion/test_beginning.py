"""Long motions: their beginning is used, and nothing is worked out of the rest."""

from __future__ import annotations

import tracemalloc
from dataclasses import replace

import numpy as np
import pytest
from humanoids import told_by

from engine.geometry.rigging.skeleton import Skeleton
from engine.motion import rotation
from engine.motion.beginning import MAX_MOTION_SECONDS, beginning, duration, length_warning
from engine.motion.check import check_motion
from engine.motion.edit import repeat_loop
from engine.motion.files.source_motion import SourceMotion
from engine.motion.library import built_in
from engine.motion.retargeting.retarget import retarget


def walking(skeleton: Skeleton, rounds: int, fps: float = 30.0) -> SourceMotion:
    """A walk of some rounds, and the first pose again."""
    clip = built_in("walk", skeleton, fps)
    clip = repeat_loop(clip, rounds * len(clip.root) + 1)
    return told_by(skeleton, clip, rotation.identity(len(skeleton.names)), rotation.identity(), 0.01)


@pytest.mark.parametrize(("frames", "left"), [(1801, 1801), (1802, 1801), (72_000, 1801), (1, 1)])
def test_a_minute_is_kept_from_its_first_frame_to_its_last(skeleton: Skeleton, frames: int, left: int) -> None:
    one = walking(skeleton, 1)
    motion = replace(
        one,
        rotations=np.broadcast_to(one.rotations[:1], (frames, *one.rotations.shape[1:])),
        translations=np.broadcast_to(one.translations[:1], (frames, *one.translations.shape[1:])),
        loops=True,
    )
    used = beginning(motion)
    assert len(used.rotations) == len(used.translations) == left
    assert duration(used) <= MAX_MOTION_SECONDS
    assert (used is motion) == (left == frames) == (length_warning(motion) is None)
    assert used.loops is (left == frames), "a part of a loop is none"


def test_it_is_told_how_long_it_is_and_what_is_used(skeleton: Skeleton) -> None:
    motion = replace(walking(skeleton, 20), fps=4.0)
    told = length_warning(motion)
    assert told is not None and f"lasts {duration(motion):.1f} s" in told and "first 60" in told


def test_slow_frames_take_no_more_than_quick_ones(skeleton: Skeleton) -> None:
    """Thirty thousand frames of two seconds are sixteen hours, of which a minute is carried over."""
    motion = walking(skeleton, 1)
    hours = replace(
        motion,
        fps=0.5,
        rotations=np.broadcast_to(motion.rotations[:1], (30_000, *motion.rotations.shape[1:])),
        translations=np.broadcast_to(motion.translations[:1], (30_000, *motion.translations.shape[1:])),
    )
    tracemalloc.start()
    clip = retarget(beginning(hours), skeleton).clip
    assert check_motion(hours).seconds == duration(hours) == 59_998
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert clip.seconds == pytest.approx(MAX_MOTION_SECONDS)
    assert peak < 200e6


def test_a_loop_is_judged_whole_or_not_at_all(skeleton: Skeleton) -> None:
    """Thirty rounds that end in the first pose are a loop as one is; more than a minute of them is done once."""
    short, long = walking(skeleton, 30), walking(skeleton, 60)
    assert duration(short) < MAX_MOTION_SECONDS < duration(long)
    for motion, loops in ((short, True), (long, False)):
        assert check_motion(motion).loops is loops
        assert retarget(beginning(motion), skeleton).clip.loops is loops
