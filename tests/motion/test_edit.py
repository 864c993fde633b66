"""Clips changed and joined."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from engine.motion import rotation
from engine.motion.clip import Clip
from engine.motion.edit import BODY_PARTS, closed, concatenate, in_place, keep, moved, repeated, travel, travelling
from engine.motion.foot_contact import find_contacts, sinking, sliding, sole_places
from engine.motion.kinematics import joint_places
from engine.motion.library import CLIPS, built_in
from engine.motion.resampling import resample
from engine.motion.skeleton import Skeleton
from engine.motion.sole import leg_length


def first(clip: Clip) -> Clip:
    return replace(clip, rotations=clip.rotations[:1], root=clip.root[:1], loops=False)


def apart(one: np.ndarray, other: np.ndarray) -> float:
    return float(np.degrees(rotation.angle(rotation.multiply(rotation.inverse(one), other)).max()))


def test_in_place_takes_the_way_and_leaves_the_sway(skeleton: Skeleton) -> None:
    clip = built_in("walk", skeleton)
    still = in_place(clip)
    assert np.allclose(travel(still), 0, atol=1e-5)
    assert np.ptp(still.root[:, 2]) < 0.05
    assert np.array_equal(still.root[:, 1], clip.root[:, 1])
    assert np.ptp(still.root[:, 0]) == pytest.approx(np.ptp(clip.root[:, 0]), abs=0.005)
    once = in_place(repeated(clip, 99))
    assert np.ptp(once.root[:, 2]) < 0.6  # of 3.7 m


def test_a_walk_in_place_walks_again(skeleton: Skeleton) -> None:
    clip = built_in("walk", skeleton)
    again = travelling(skeleton, in_place(clip))
    assert np.allclose(travel(again), travel(clip), rtol=0.05, atol=0.02)
    whole = repeated(again, 66)
    points = sole_places(skeleton, whole)
    assert sliding(points, find_contacts(points, 30.0), 30.0) < 2


def test_rounds_of_a_loop_follow_each_other_evenly(skeleton: Skeleton) -> None:
    clip = built_in("run", skeleton)
    frames = len(clip.root)
    twice = repeated(clip, 2 * frames + 1, start=5)
    assert not twice.loops
    assert np.allclose(twice.root[frames] - twice.root[0], travel(clip), atol=1e-4)
    assert np.array_equal(twice.rotations[frames], twice.rotations[0])
    bow = built_in("bow", skeleton)
    assert np.array_equal(repeated(bow, 200).root[-1], bow.root[-1])


@pytest.mark.parametrize("parts", [("left_arm",), ("head", "torso"), ("arms",), ("legs",)])
def test_what_is_kept_is_as_pictured_and_the_rest_is_not_touched(skeleton: Skeleton, parts: tuple[str, ...]) -> None:
    clip, pictured = built_in("dance", skeleton), first(built_in("sit", skeleton))
    kept = keep(skeleton, clip, pictured, parts)
    names = {"arms": ("left_arm", "right_arm"), "legs": ("left_leg", "right_leg")}
    held = {joint for part in parts for one in names.get(part, (part,)) for joint in BODY_PARTS[one]}
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
        keep(skeleton, clip, pictured, ("tail",))


@pytest.mark.parametrize("name", ["walk", "jump"])
@pytest.mark.parametrize("pose", [0, -1])
def test_with_one_leg_kept_straight_or_bent_the_lowest_sole_is_as_high_as_before(
    skeleton: Skeleton, name: str, pose: int
) -> None:
    """The other foot stays in its place where the body rises, unless its leg is stretched out."""
    clip, sit = built_in(name, skeleton), built_in("sit", skeleton)
    pictured = replace(sit, rotations=sit.rotations[pose][None], root=sit.root[pose][None])
    kept = keep(skeleton, clip, pictured, ["left_leg"])
    left = [skeleton.index(joint) for joint in BODY_PARTS["left_leg"]]
    assert (kept.rotations[:, left] == pictured.rotations[:, left]).all()
    before, after = (sole_places(skeleton, one)[..., 1].min((1, 2)) for one in (clip, kept))
    assert np.allclose(after, before, atol=1e-5)
    hip, foot = skeleton.index("RightUpLeg"), skeleton.index("RightFoot")
    was, now = joint_places(skeleton, clip), joint_places(skeleton, kept)
    rises = kept.root[:, 1] > clip.root[:, 1]
    stretched = np.linalg.norm(now[:, foot] - now[:, hip], axis=1) > 0.999 * leg_length(skeleton)
    assert (rises & ~stretched).any() if pose == 0 else (~rises).any()
    assert np.allclose(was[rises & ~stretched, foot], now[rises & ~stretched, foot], atol=1e-4)


def test_a_moved_clip_begins_where_it_is_told(skeleton: Skeleton) -> None:
    clip = built_in("walk", skeleton)
    turned = moved(clip, np.pi / 2, np.array([1.0, 0.0, 2.0]))
    assert np.allclose(turned.root[0], [1, clip.root[0, 1], 2])
    assert np.allclose(travel(turned), [travel(clip)[2], 0, -travel(clip)[0]], atol=1e-5)


def test_clips_follow_one_another_where_they_end(skeleton: Skeleton) -> None:
    walk = repeated(built_in("walk", skeleton), 70)
    whole = concatenate(skeleton, [walk, built_in("wave", skeleton), built_in("bow", skeleton)])
    assert whole.seconds == pytest.approx(walk.seconds + 3.2 + 3.0 - 0.8, abs=0.1)
    assert np.linalg.norm(np.diff(whole.root, axis=0), axis=-1).max() * 30 < 2.5
    assert whole.root[-1, 2] > walk.root[-1, 2] - 0.6
    points = sole_places(skeleton, whole)
    assert sliding(points, find_contacts(points, 30.0), 30.0) < 2
    assert sinking(points) < 0.01
    turns = rotation.angle(rotation.multiply(rotation.inverse(whole.rotations[:-1]), whole.rotations[1:]))
    assert np.degrees(turns.max()) < 40
    assert apart(whole.rotations[-1], built_in("bow", skeleton).rotations[-1]) < 5


@pytest.mark.parametrize("name", CLIPS)
def test_resampling_there_and_back_changes_little(skeleton: Skeleton, name: str) -> None:
    clip = built_in(name, skeleton)
    back = resample(resample(clip, 120.0), 30.0)
    assert len(back.root) == len(clip.root)
    assert back.loops == clip.loops
    assert apart(back.rotations, clip.rotations) < 0.2
    assert np.allclose(back.root, clip.root, atol=1e-4)


def test_a_clip_that_ends_as_it_begins_is_a_loop(skeleton: Skeleton) -> None:
    walk = built_in("walk", skeleton)
    once = repeated(walk, len(walk.root) + 1)
    loop = closed(once)
    assert loop.loops
    assert np.array_equal(loop.rotations, walk.rotations)
    assert not closed(built_in("sit", skeleton)).loops
