"""How rigged people stand in the pictures that are taken of them: poses told bone by bone, and moments of captured motions."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import numpy as np

from benchmarks.scan_studio.people.pictured_poses import POSES
from benchmarks.scan_studio.people.rigged_people import held_pose
from engine.geometry.rigging.skeleton import Skeleton
from engine.motion.clip import Clip
from engine.motion.files.reading import read_motion
from engine.motion.retargeting.retarget import retarget

PICTURED_MOMENTS: Mapping[str, tuple[str, float]] = {
    "walking": ("cmu_02_01_walk.bvh", 0.43),
    "mid step": ("cmu_02_01_walk.bvh", 0.09),
    "running": ("bandai_run_active.bvh", 0.52),
    "kicking": ("bandai_kick.bvh", 0.17),
    "dancing": ("cmu_05_06_dance.bvh", 0.43),
    "waving": ("fair_wave_hello.bvh", 0.6),
    "jumping jack": ("cmu_jumping_jacks.bvh", 0.26),
}
"""Files of captured motions, and the share of each at which the picture is taken."""

PICTURED_NAMES = (*POSES, *PICTURED_MOMENTS)
"""The names of all poses and pictured moments."""


def pictured(skeleton: Skeleton, how: str, mocap: Path) -> Clip:
    """A clip of one frame in which somebody of this T-pose `skeleton` stands as in `PICTURED_NAMES`; `mocap`: the folder of motions."""
    if how in POSES:
        return held_pose(skeleton, POSES[how])
    file, share = PICTURED_MOMENTS[how]
    clip = retarget(read_motion(mocap / file), skeleton).clip
    frame = int(share * (len(clip.rotations) - 1))
    return Clip("held", 1.0, clip.rotations[[frame]], clip.root[[frame]] * np.array([0, 1, 0], np.float32))
