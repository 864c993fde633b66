"""Clips changed."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from engine.geometry.rigging.skeleton import Skeleton
from engine.motion.clip import Clip
from engine.motion.edit import KEPT_PART_JOINTS, in_place, keep_pictured_parts, loop_travel, repeat_loop
from engine.motion.feet.foot_contact import sole_places
from engine.motion.feet.sole import leg_length
from engine.motion.kinematics import joint_places
from engine.motion.library import built_in


def first(clip: Clip) -> Clip:
    return replace(clip, rotations=clip.rotations[:1], root=clip.root[:1], loops=False)


def test_in_place_takes_the_way_and_leaves_the_sway(skeleton: Skeleton) -> None:
    clip = built_in("walk", skeleton)
    still = in_place(clip)
    assert np.allclose(loop_travel(still), 0, atol=1e-5)
    assert np.ptp(still.root[:, 2]) < 0.05
    assert np.array_equal(still.root[:, 1], clip.root[:, 1])
    assert np.ptp(still.root[:, 0]) == pytest.approx(np.ptp(clip.root[:, 0]), abs=0.005)
    once = in_place(repeat_loop(clip, 99))
    assert np.ptp(once.root[:, 2]) < 0.6  # of 3.7 m


def test_rounds_of_a_loop_follow_each_other_evenly(skeleton: Skeleton) -> None:
    clip = built_in("run", skeleton)
    frames = len(clip.root)
    twice = repeat_loop(clip, 2 * frames + 1, start=5)
    assert not twice.loops
    assert np.allclose(twice.root[frames] - twice.root[0], loop_travel(clip), atol=1e-4)
    assert np.array_equal(twice.rotations[frames], twice.rotations[0])
    bow = built_in("bow", skeleton)
    assert np.array_equal(repeat_loop(bow, 200).root[-1], bow.root[-1])


@pytest.mark.parametrize("parts", [("left_arm",), ("head", "torso"), ("arms",), ("legs",)])
def test_what_is_kept_is_as_pictured_and_the_rest_is_not_touched(skeleton: Skeleton, parts: tuple[str, ...]) -> None:
    clip, pictured = built_in("dance", skeleton), first(built_in("sit", skeleton))
    kept = keep_pictured_parts(skeleton, clip, pictured, parts)
    names = {"arms": ("left_arm", "right_arm"), "legs": ("left_leg", "right_leg")}
    held = {joint for part in parts for one in names.get(part, (part,)) for joint in KEPT_PART_JOINTS[one]}
    for index, name in enumerate(skeleton.names):
        finger = any(f"{side}Hand" in held and name.startswith(f"{side}Hand") for side in ("Left", "Right"))
        if name in held or finger:
            assert np.array_equal(kept.rotations[:, index], np.tile(pictured.rotations[0, index], (len(clip.root), 1)))
        elif name != "Hips":
            assert np.array_equal(kept.rotations[:, index], clip.rotations[:, index])
    if parts == ("legs",):
        places = joint_places(skeleton, kept)[:, skeleton.index("LeftFoot")]
        assert np.ptp(places, axis=0).max() < 1e-5
    with pytest.raises(ValueError, match="tail"):
        keep_pictured_parts(skeleton, clip, pictured, ("tail",))


@pytest.mark.parametrize("name", ["walk", "jump"])
@pytest.mark.parametrize("pose", [0, -1])
def test_with_one_leg_kept_straight_or_bent_the_lowest_sole_is_as_high_as_before(
    skeleton: Skeleton, name: str, pose: int
) -> None:
    """The other foot stays in its place where the body rises, unless its leg is stretched out."""
    clip, sit = built_in(name, skeleton), built_in("sit", skeleton)
    pictured = replace(sit, rotations=sit.rotations[pose][None], root=sit.root[pose][None])
    kept = keep_pictured_parts(skeleton, clip, pictured, ["left_leg"])
    left = [skeleton.index(joint) for joint in KEPT_PART_JOINTS["left_leg"]]
    assert (kept.rotations[:, left] == pictured.rotations[:, left]).all()
    before, after = (sole_places(skeleton, one)[..., 1].min((1, 2)) for one in (clip, kept))
    assert np.allclose(after, before, atol=1e-5)
    hip, foot = skeleton.index("RightUpLeg"), skeleton.index("RightFoot")
    was, now = joint_places(skeleton, clip), joint_places(skeleton, kept)
    rises = kept.root[:, 1] > clip.root[:, 1]
    stretched = np.linalg.norm(now[:, foot] - now[:, hip], axis=1) > 0.999 * leg_length(skeleton)
    assert (rises & ~stretched).any() if pose == 0 else (~rises).any()
    assert np.allclose(was[rises & ~stretched, foot], now[rises & ~stretched, foot], atol=1e-4)
