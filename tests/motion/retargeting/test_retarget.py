"""Motions carried over: from our own skeleton in disguise the answer is known; from real recordings, the feet tell."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from humanoids import build_skeleton, told_by

from engine.errors import InputError
from engine.geometry.rigging.skeleton import Skeleton
from engine.motion import rotation
from engine.motion.check import check_motion
from engine.motion.clip import Clip
from engine.motion.feet.foot_contact import find_contacts, sinking_depth, sliding_speed, sole_places
from engine.motion.feet.sole import leg_length
from engine.motion.files.bvh import read_bvh
from engine.motion.kinematics import joint_places, world_rotations
from engine.motion.library import built_in
from engine.motion.retargeting.glitches import without_flips
from engine.motion.retargeting.retarget import retarget

Media = Callable[[str], Path]

RNG = np.random.default_rng(5)
Z_UP = rotation.about("x", np.pi / 2)


def apart(first: Clip, second: Clip, skeleton: Skeleton) -> float:
    """Degrees between the joints' world turns, at most."""
    turns = (world_rotations(skeleton.parents, clip.rotations) for clip in (first, second))
    return float(np.degrees(rotation.angle(rotation.multiply(rotation.inverse(next(turns)), next(turns))).max()))


def no_turns(skeleton: Skeleton) -> np.ndarray:
    return rotation.identity(len(skeleton.names))


@pytest.mark.parametrize("name", ["walk", "dance", "bow", "jump", "sit"])
@pytest.mark.parametrize(("world", "unit"), [(rotation.identity(), 0.01), (Z_UP, 0.0254)])
def test_our_own_motion_in_other_axes_and_units_comes_back(
    skeleton: Skeleton, name: str, world: np.ndarray, unit: float
) -> None:
    clip = built_in(name, skeleton)
    turns = rotation.normalize(RNG.normal(size=(len(skeleton.names), 4)))
    back = retarget(told_by(skeleton, clip, turns, world, unit), skeleton, facing="keep", feet=False).clip
    assert apart(back, clip, skeleton) < 0.1
    assert np.abs((back.root - back.root[0]) - (clip.root - clip.root[0])).max() < 1e-4


def test_a_motion_that_looks_elsewhere_is_turned_to_us(skeleton: Skeleton) -> None:
    clip = built_in("idle", skeleton)
    world = rotation.about("y", 2.0)
    back = retarget(told_by(skeleton, clip, no_turns(skeleton), world, 1.0), skeleton, feet=False).clip
    assert apart(back, clip, skeleton) < 2  # the hips of who stands idle sway by one degree


def test_another_pose_at_rest_is_brought_to_the_t_pose(skeleton: Skeleton) -> None:
    """Arms hanging by 45 degrees (A-pose), legs astride by 20 (CMU): the same motion comes back."""
    clip = built_in("dance", skeleton)
    rest = no_turns(skeleton)
    for index, name in enumerate(skeleton.names):
        sign = -1 if name.startswith("Left") else 1
        if any(part in name for part in ("Arm", "Hand")):
            rest[index] = rotation.about("z", sign * np.radians(45))
        elif any(part in name for part in ("Leg", "Foot", "Toe")):
            rest[index] = rotation.about("z", -sign * np.radians(20))
    motion = told_by(skeleton, clip, no_turns(skeleton), rotation.identity(), 0.01, rest)
    back = retarget(motion, skeleton, facing="keep", feet=False).clip
    assert apart(back, clip, skeleton) < 0.5


def test_a_pose_at_rest_that_is_none_is_guessed_from_the_motion(skeleton: Skeleton) -> None:
    """Bones at rest in any direction: what a bone turns about itself can only be guessed; where it points, not much."""
    clip = built_in("walk", skeleton)
    rest = rotation.normalize(RNG.normal(size=(len(skeleton.names), 4)))
    motion = told_by(skeleton, clip, no_turns(skeleton), rotation.identity(), 0.01, rest)
    back = retarget(motion, skeleton, facing="keep", feet=False).clip
    places = [joint_places(skeleton, c) - c.root[:, None] for c in (back, clip)]
    limbs = [skeleton.index(side + part) for side in ("Left", "Right") for part in ("Hand", "ForeArm", "Foot", "Leg")]
    assert np.linalg.norm(places[0] - places[1], axis=-1)[:, limbs].max() < 0.08


def test_the_way_is_scaled_by_the_legs(skeleton: Skeleton) -> None:
    clip = built_in("walk", skeleton)
    motion = told_by(skeleton, clip, no_turns(skeleton), rotation.identity(), 0.01)
    child = build_skeleton(scale=0.6)
    result = retarget(motion, child, facing="keep").clip
    assert leg_length(child) == pytest.approx(0.6 * leg_length(skeleton))
    assert result.root[-1, 2] - result.root[0, 2] == pytest.approx(0.6 * (clip.root[-1, 2] - clip.root[0, 2]), rel=0.02)


def test_another_frame_rate_plays_as_long(media: Media, skeleton: Skeleton) -> None:
    motion = read_bvh(media("mocap/cmu_02_01_walk.bvh"))
    for fps in (24.0, 30.0, 60.0):
        clip = retarget(motion, skeleton, fps=fps).clip
        assert clip.fps == fps
        assert clip.seconds == pytest.approx(342 / 120, abs=1 / fps)


def test_the_character_faces_us(media: Media, skeleton: Skeleton) -> None:
    for name in ("cmu_02_01_walk", "bandai_run_active", "fair_jumping", "makehuman_walk_cycle"):
        clip = retarget(read_bvh(media(f"mocap/{name}.bvh")), skeleton, facing="main").clip
        forward = rotation.rotate(clip.rotations[:, 0], (0, 0, 1)).mean(0)
        assert np.degrees(np.arctan2(abs(forward[0]), forward[2])) < 2
        way = clip.root[-1] - clip.root[0]
        if np.linalg.norm(way) > 1:
            assert way[2] > 0.9 * np.linalg.norm(way)


def test_heads_are_up_and_hands_on_their_sides(media: Media, skeleton: Skeleton) -> None:
    """Left and right, up and down are not mixed up, whatever the file's axes."""
    for name in ("cmu_02_01_walk", "bandai_kick", "fair_wave_hello", "makehuman_walk_cycle", "cmu_131_03_hop"):
        clip = retarget(read_bvh(media(f"mocap/{name}.bvh")), skeleton, facing="main").clip
        places = joint_places(skeleton, clip)
        assert (places[:, skeleton.index("Head"), 1] > 1.3).mean() > 0.95
        across = places[:, skeleton.index("LeftArm")] - places[:, skeleton.index("RightArm")]
        hips = world_rotations(skeleton.parents, clip.rotations)[:, 0]
        assert (np.sum(across * rotation.rotate(hips, (1, 0, 0)), -1) > 0.1).mean() > 0.95


SLIDING = {
    "bandai_kick": 0.3, "bandai_run_active": 0.3, "cmu_02_01_walk": 0.3, "cmu_05_06_dance": 0.6, "cmu_131_03_hop": 0.5,
    "cmu_jumping_jacks": 0.3, "fair_jumping": 0.3, "fair_wave_hello": 0.1, "makehuman_walk_cycle": 0.1,
}  # fmt: skip
"""Centimetres a second over the ground while a foot stands; carried over without holding feet, 1 to 12."""


@pytest.mark.parametrize("name", SLIDING)
def test_feet_neither_slide_nor_sink(media: Media, skeleton: Skeleton, name: str) -> None:
    motion = read_bvh(media(f"mocap/{name}.bvh"))
    result = retarget(motion, skeleton)
    assert result.feet.sliding_after <= SLIDING[name]
    assert result.feet.sinking_after < 0.01
    points = sole_places(skeleton, result.clip)
    assert sinking_depth(points) < 0.01
    # measured anew on what came out: feet that stand in it, also in the frames in which they begin and end to stand
    again = sliding_speed(points, find_contacts(points, result.clip.fps, leg_length(skeleton)), result.clip.fps)
    assert again < 2.5


@pytest.mark.parametrize("fingers", [True, False])
@pytest.mark.parametrize("toes", [True, False])
def test_skeletons_may_lack_fingers_and_toes(media: Media, fingers: bool, toes: bool) -> None:
    skeleton = build_skeleton(fingers, toes)
    result = retarget(read_bvh(media("mocap/makehuman_walk_cycle.bvh")), skeleton)
    assert result.clip.rotations.shape[1] == len(skeleton.names)
    assert np.isfinite(result.clip.rotations).all()
    assert sinking_depth(sole_places(skeleton, result.clip)) < 0.01


def test_a_joint_that_flips_over_and_back_is_bridged(skeleton: Skeleton) -> None:
    clip = built_in("walk", skeleton, fps=120.0)
    motion = told_by(skeleton, clip, no_turns(skeleton), rotation.identity(), 0.01)
    broken = motion.rotations.copy()
    knee = skeleton.index("LeftLeg")
    broken[40:52, knee] = rotation.multiply(broken[40:52, knee], rotation.about("y", np.pi))
    mended = without_flips(replace(motion, rotations=broken))
    off = rotation.angle(rotation.multiply(rotation.inverse(motion.rotations), mended.rotations))
    assert np.degrees(off.max()) < 12  # a straight line through a knee that bends meanwhile
    assert without_flips(motion) is motion


@pytest.mark.parametrize("part", ["everything", "legs", "all of the legs but a hundredth"])
def test_legs_without_length_are_refused(skeleton: Skeleton, part: str) -> None:
    """By them the root's way would be scaled beyond all measure."""
    motion = told_by(skeleton, built_in("walk", skeleton), no_turns(skeleton), rotation.identity(), 0.01)
    below = [index for index, name in enumerate(skeleton.names) if name.endswith(("Leg", "Foot")) and "Up" not in name]
    joints = list(range(1, len(skeleton.names))) if part == "everything" else below
    motion.translations[:, joints] *= 0.01 if "but" in part else 0
    with pytest.raises(InputError) as error:
        retarget(motion, skeleton)
    assert (error.value.code, error.value.correctable) == ("motion_not_humanoid", ("motion_joints", "motion"))
    checked = check_motion(motion)
    assert checked.refused is not None and checked.refused.detail == error.value.detail
    assert checked.mapping == error.value.found["mapping"] and checked.missing == () and checked.loops is None


def test_short_legs_are_legs(skeleton: Skeleton) -> None:
    """A drawn figure's, a fifth as long as a person's."""
    motion = told_by(skeleton, built_in("walk", skeleton), no_turns(skeleton), rotation.identity(), 0.01)
    below = [index for index, name in enumerate(skeleton.names) if name.endswith(("Leg", "Foot")) and "Up" not in name]
    motion.translations[:, below] *= 0.2
    assert retarget(motion, skeleton).clip.loops is False
