"""What is told of a motion before it moves anybody."""

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
from engine.motion.files.reading import motion_clips, read_motion
from engine.motion.files.source_motion import SourceMotion
from engine.motion.library import built_in


@pytest.fixture
def motion(skeleton: Skeleton) -> SourceMotion:
    """A wave as our own skeleton tells it."""
    count = len(skeleton.names)
    return told_by(skeleton, built_in("wave", skeleton), rotation.identity(count), rotation.identity(), 1.0, prefix="")


def test_a_motion_with_our_names_moves_joint_by_joint(motion: SourceMotion) -> None:
    checked = check_motion(motion)
    assert checked.mapping == {name: name for name in motion.names}
    assert (checked.missing, checked.refused) == ((), None)
    assert checked.joints[:2] == ("Hips", "Spine") and checked.parents[:2] == (None, "Hips")
    assert checked.frames == len(motion.rotations)
    assert checked.seconds == pytest.approx((checked.frames - 1) / motion.fps)
    assert checked.loops is False
    assert check_motion(replace(motion, loops=True)).loops is True


def test_overrides_say_otherwise(motion: SourceMotion) -> None:
    checked = check_motion(motion, {"LeftHand": None, "Neck": "Spine2"})
    assert "LeftHand" not in checked.mapping and checked.mapping["Neck"] == "Spine2"
    with pytest.raises(InputError, match="tail") as error:
        check_motion(motion, {"LeftHand": "tail"})
    assert error.value.code == "motion_joint_unknown" and error.value.correctable == ("motion_joints",)


def test_what_is_nobody_is_told_of_with_what_was_found() -> None:
    """Three bones in a row, of which one is called a leg."""
    whip = SourceMotion(
        name="whip",
        fps=30.0,
        names=("Hips", "LeftUpLeg", "tip"),
        parents=np.array([-1, 0, 1], np.int32),
        rest_rotations=rotation.identity(3),
        rest_offsets=np.array([[0, 1, 0], [0, -0.1, 0], [0, -0.5, 0]], float),
        ends=np.full((3, 3), np.nan),
        rotations=rotation.identity(2, 3),
        translations=np.tile(np.array([[0, 1, 0], [0, -0.1, 0], [0, -0.5, 0]], float), (2, 1, 1)),
    )
    checked = check_motion(whip)
    assert checked.refused is not None and checked.refused.code == "motion_not_humanoid"
    assert checked.mapping == {"Hips": "Hips", "LeftUpLeg": "LeftUpLeg"}
    assert "LeftFoot" in checked.missing and "Hips" not in checked.missing
    # even so the joints are there to choose among
    assert checked.joints == whip.names and checked.parents == (None, "Hips", "LeftUpLeg")


def test_files_are_told_apart_by_how_they_begin(media: Callable[[str], Path], tmp_path: Path) -> None:
    motion = read_motion(media("mocap/cmu_jumping_jacks.bvh"))
    assert len(motion.names) == 31
    (tmp_path / "a.bvh").write_bytes(b"glTF")
    with pytest.raises(InputError) as error:
        read_motion(tmp_path / "a.bvh")
    assert error.value.code == "motion_unreadable"


def test_a_bvh_file_has_no_animations_to_choose_among(media: Callable[[str], Path]) -> None:
    jumping = media("mocap/cmu_jumping_jacks.bvh")
    assert motion_clips(jumping) == ()
    with pytest.raises(InputError) as error:
        read_motion(jumping, "Jump")
    assert (error.value.code, error.value.found) == ("motion_clip_unknown", {"clips": []})


def test_renamed_joints_need_overrides_where_their_shape_says_nothing() -> None:
    """A skeleton whose left and right cannot be told from names is found by shape; overrides put it right."""
    skeleton = build_skeleton(fingers=False)
    count = len(skeleton.names)
    wave = told_by(skeleton, built_in("wave", skeleton), rotation.identity(count), rotation.identity(), 1.0, prefix="")
    bones = tuple(f"bone{index}" for index in range(count))
    checked = check_motion(replace(wave, names=bones), dict(zip(skeleton.names, bones, strict=True)))
    assert checked.mapping == dict(zip(skeleton.names, bones, strict=True)) and checked.refused is None
