"""The project's own clips: they loop, stand, and move as people do."""

from __future__ import annotations

import numpy as np
import pytest
from humanoids import build_skeleton

from engine.geometry.rigging.skeleton import Skeleton
from engine.motion import rotation
from engine.motion.catalogue import CATALOGUE
from engine.motion.edit import loop_travel, repeat_loop
from engine.motion.feet.foot_contact import find_contacts, sinking_depth, sliding_speed, sole_places
from engine.motion.feet.sole import leg_length
from engine.motion.kinematics import joint_places, world_rotations
from engine.motion.library import CLIPS, built_in

LOOPS = {"idle", "walk", "run", "dance"}


@pytest.mark.parametrize("name", CLIPS)
def test_every_clip_is_whole_at_any_rate(skeleton: Skeleton, name: str) -> None:
    for fps in (24.0, 30.0, 60.0):
        clip = built_in(name, skeleton, fps)
        assert clip.rotations.shape == (len(clip.root), len(skeleton.names), 4)
        assert clip.rotations.dtype == clip.root.dtype == np.float32
        assert np.allclose(np.linalg.norm(clip.rotations, axis=-1), 1, atol=1e-5)
        assert (clip.loops, clip.fps, clip.name) == (name in LOOPS, fps, name)
        assert clip.seconds == pytest.approx(built_in(name, skeleton, 120.0).seconds, abs=1 / fps)


def test_the_catalogue_tells_the_truth(skeleton: Skeleton) -> None:
    assert [one.name for one in CATALOGUE] == list(CLIPS)
    for one in CATALOGUE:
        clip = built_in(one.name, skeleton)
        assert (clip.seconds, clip.loops) == (pytest.approx(one.seconds, abs=0.05), one.loops)


@pytest.mark.parametrize("name", CLIPS)
def test_soles_neither_sink_nor_slide(skeleton: Skeleton, name: str) -> None:
    clip = built_in(name, skeleton)
    clip = repeat_loop(clip, 2 * len(clip.root)) if clip.loops else clip
    points = sole_places(skeleton, clip)
    assert sinking_depth(points) < 0.01
    # while they lie on the ground; that they begin and end to stand between two frames is allowed for
    low = points[:, :, :2, 1].min(-1) < 0.002
    steps = np.linalg.norm(np.diff(points[:, :, :2][..., [0, 2]], axis=0), axis=-1).min(-1)
    inside = low[1:-2] & low[2:-1] & low[:-3] & low[3:]
    assert steps[1:-1][inside].max(initial=0) < 0.001


@pytest.mark.parametrize("name", sorted(LOOPS))
def test_loops_close_exactly(skeleton: Skeleton, name: str) -> None:
    """Across the end, joints go on as smoothly as anywhere: no frame is there twice, none is missing."""
    clip = built_in(name, skeleton)
    frames = len(clip.root)
    places = joint_places(skeleton, repeat_loop(clip, 3 * frames))
    jerk = np.linalg.norm(np.diff(places, n=3, axis=0), axis=-1).max(-1)
    assert jerk[frames - 3 : frames + 1].max() <= 1.05 * jerk[:frames].max()
    speed = np.linalg.norm(np.diff(places, axis=0), axis=-1).max(-1)
    assert speed[frames - 1] == pytest.approx(speed[2 * frames - 1], rel=1e-3)


@pytest.mark.parametrize("name", ["walk", "run"])
def test_gaits_are_the_same_on_both_sides(skeleton: Skeleton, name: str) -> None:
    """Half a cycle later, everything is mirrored."""
    fps = 40.0 / 1.1 if name == "walk" else 40.0 / 0.7
    clip = built_in(name, skeleton, fps)
    half = len(clip.root) // 2
    partner = [skeleton.names.index(_other_side(joint)) for joint in skeleton.names]
    mirrored = rotation.mirrored(np.roll(clip.rotations, -half, axis=0))[:, partner]
    off = rotation.angle(rotation.multiply(rotation.inverse(mirrored), clip.rotations))
    assert np.degrees(off.max()) < 1


def _other_side(name: str) -> str:
    if name.startswith("Left"):
        return name.replace("Left", "Right")
    return name.replace("Right", "Left")


def test_walking_keeps_a_foot_on_the_ground_and_running_does_not(skeleton: Skeleton) -> None:
    lowest = {
        name: sole_places(skeleton, built_in(name, skeleton, 60.0))[..., 1].min((1, 2)) for name in ("walk", "run")
    }
    assert lowest["walk"].max() < 0.01
    assert 0.2 < (lowest["run"] > 0.02).mean() < 0.5


def test_a_runner_in_the_air_falls(skeleton: Skeleton) -> None:
    clip = built_in("run", skeleton, 120.0)
    flying = sole_places(skeleton, clip)[..., 1].min((1, 2)) > 0.01
    inside = flying[1:-1] & flying[2:] & flying[:-2]
    fall = np.diff(clip.root[:, 1].astype(np.float64), n=2)[inside] * 120**2
    assert np.median(fall) == pytest.approx(-9.8, abs=2.5)


def test_walking_speed_and_stride_are_a_grown_ups(skeleton: Skeleton) -> None:
    for name, speed in (("walk", 1.15), ("run", 3.1)):
        clip = built_in(name, skeleton)
        assert loop_travel(clip)[2] / clip.seconds == pytest.approx(speed, rel=0.05)
        assert abs(loop_travel(clip)[0]) < 1e-3


def test_arms_swing_against_legs_and_shoulders_against_hips(skeleton: Skeleton) -> None:
    clip = built_in("walk", skeleton)
    places = joint_places(skeleton, clip) - clip.root[:, None]
    foot = places[:, skeleton.index("LeftFoot"), 2] - places[:, skeleton.index("RightFoot"), 2]
    hand = places[:, skeleton.index("LeftHand"), 2] - places[:, skeleton.index("RightHand"), 2]
    assert np.corrcoef(foot, hand)[0, 1] < -0.8
    forward = rotation.rotate(world_rotations(skeleton.parents, clip.rotations), (0.0, 0.0, 1.0))[..., 0]
    hips, chest = forward[:, skeleton.index("Hips")], forward[:, skeleton.index("Spine2")]
    assert np.corrcoef(hips, chest)[0, 1] < -0.8


@pytest.mark.parametrize("name", CLIPS)
def test_knees_and_elbows_bend_one_way_only(skeleton: Skeleton, name: str) -> None:
    clip = built_in(name, skeleton)
    places = joint_places(skeleton, clip)
    world = world_rotations(skeleton.parents, clip.rotations)
    for side in ("Left", "Right"):
        hip, knee, ankle = (skeleton.index(side + part) for part in ("UpLeg", "Leg", "Foot"))
        bend = np.cross(places[:, knee] - places[:, hip], places[:, ankle] - places[:, knee])
        hinge = rotation.rotate(world[:, hip], (1.0, 0.0, 0.0))
        lengths = np.linalg.norm(places[:, knee] - places[:, hip], axis=-1) * np.linalg.norm(
            places[:, ankle] - places[:, knee], axis=-1
        )
        assert (np.sum(bend * hinge, -1) / lengths).min() > -0.12  # at rest our knees are bent by a few degrees
    twist = rotation.to_vector(clip.rotations[:, skeleton.index("LeftForeArm")])
    assert (twist[:, 1] < 0.05).all()


@pytest.mark.parametrize("name", CLIPS)
def test_a_child_moves_as_a_grown_up_of_its_size(skeleton: Skeleton, name: str) -> None:
    child = build_skeleton(scale=0.55)
    ours, theirs = built_in(name, skeleton), built_in(name, child)
    off = rotation.angle(rotation.multiply(rotation.inverse(ours.rotations), theirs.rotations))
    assert np.degrees(off.max()) < 0.3
    assert np.allclose(theirs.root, 0.55 * ours.root, atol=1e-3)


@pytest.mark.parametrize("name", CLIPS)
def test_fingers_and_toes_may_be_missing(name: str) -> None:
    skeleton = build_skeleton(fingers=False, toes=False)
    clip = built_in(name, skeleton)
    assert np.isfinite(clip.rotations).all()
    assert sinking_depth(sole_places(skeleton, clip)) < 0.01


def test_the_jump_leaves_the_ground_and_lands(skeleton: Skeleton) -> None:
    clip = built_in("jump", skeleton)
    lowest = sole_places(skeleton, clip)[..., 1].min((1, 2))
    assert 0.15 < lowest.max() < 0.4
    assert max(lowest[0], lowest[-1]) < 0.001
    assert np.allclose(clip.rotations[0], clip.rotations[-1], atol=1e-3)


def test_who_sits_down_sits_at_knee_height_with_hands_on_the_thighs(skeleton: Skeleton) -> None:
    places = joint_places(skeleton, built_in("sit", skeleton))[-1]
    hip, knee, hand = (places[skeleton.index(f"Left{part}")] for part in ("UpLeg", "Leg", "Hand"))
    assert abs(hip[1] - knee[1]) < 0.06 * leg_length(skeleton)
    along = (hand - hip) @ (knee - hip) / ((knee - hip) @ (knee - hip))
    assert 0.4 < along < 0.8
    assert 0.04 < hand[1] - (hip + along * (knee - hip))[1] < 0.15


def test_who_waves_lifts_a_hand_over_the_shoulder_and_who_bows_lowers_the_head(skeleton: Skeleton) -> None:
    waving = joint_places(skeleton, built_in("wave", skeleton))
    middle = len(waving) // 2
    assert waving[middle, skeleton.index("RightHand"), 1] > waving[middle, skeleton.index("Head"), 1]
    turns = np.diff(np.sign(np.diff(waving[20:75, skeleton.index("RightHand"), 0])))
    assert np.count_nonzero(turns) >= 4
    bowing = joint_places(skeleton, built_in("bow", skeleton))
    assert bowing[45, skeleton.index("Head"), 1] < bowing[0, skeleton.index("Head"), 1] - 0.2


@pytest.mark.parametrize("name", ["wave", "bow", "jump", "sit"])
def test_who_stands_first_stands_like_who_idles(skeleton: Skeleton, name: str) -> None:
    off = rotation.angle(
        rotation.multiply(
            rotation.inverse(built_in("idle", skeleton).rotations[0]), built_in(name, skeleton).rotations[0]
        )
    )
    assert np.degrees(off.max()) < 10


def test_feet_that_stand_are_found_in_a_walk(skeleton: Skeleton) -> None:
    clip = built_in("walk", skeleton, 60.0)
    whole = repeat_loop(clip, 2 * len(clip.root))
    stands = find_contacts(sole_places(skeleton, whole), 60.0, leg_length(skeleton))
    assert stands.any(1).all()
    assert 0.55 < stands.mean() < 0.75
    assert sliding_speed(sole_places(skeleton, whole), stands, 60.0) < 2
