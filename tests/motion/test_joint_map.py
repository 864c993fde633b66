"""Which joint is which."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from humanoids import build_skeleton, told_by

from engine.errors import InputError
from engine.motion import rotation
from engine.motion.bvh import read_bvh
from engine.motion.clip import Clip
from engine.motion.joint_map import map_joints
from engine.motion.joint_names import match_names, read_name
from engine.motion.library import built_in
from engine.motion.skeleton import Skeleton

Media = Callable[[str], Path]

FILES = {
    "bandai_kick": {"Spine2": "Chest", "LeftArm": "UpperArm_L", "RightToeBase": "Toes_R", "LeftShoulder": "Shoulder_L"},
    "cmu_02_01_walk": {"Spine": "LowerBack", "Spine2": "Spine1", "LeftArm": "LeftArm", "LeftShoulder": "LeftShoulder"},
    "cmu_131_03_hop": {"LeftArm": "LeftShoulder", "LeftShoulder": "LeftCollar", "LeftLeg": "LeftKnee", "Hips": "Hips"},
    "fair_jumping": {"Spine2": "Spine3", "RightForeArm": "RightForeArm", "LeftToeBase": "LeftToeBase"},
    "makehuman_walk_cycle": {"Hips": "Hips", "Spine2": "Spine3", "LeftArm": "UpArm_L", "RightHandPinky2": "Pinky2_R"},
}

LIMBS = ("UpLeg", "Leg", "Foot", "Arm", "ForeArm", "Hand")


@pytest.mark.parametrize("name", FILES)
def test_names_of_many_habits_are_understood(media: Media, name: str) -> None:
    mapping = map_joints(read_bvh(media(f"mocap/{name}.bvh")))
    assert FILES[name].items() <= mapping.items()
    assert all(f"{side}{part}" in mapping for side in ("Left", "Right") for part in LIMBS)


@pytest.mark.parametrize(
    "name", [*FILES, "cmu_05_06_dance", "cmu_jumping_jacks", "bandai_run_active", "fair_wave_hello"]
)
def test_without_names_the_shape_of_the_tree_says_the_same(media: Media, name: str) -> None:
    motion = read_bvh(media(f"mocap/{name}.bvh"))
    nameless = map_joints(replace(motion, names=tuple(f"bone{i:03}" for i in range(len(motion.names)))))
    told = {ours: motion.names[int(joint[4:])] for ours, joint in nameless.items()}
    expected = {
        ours: joint for ours, joint in map_joints(motion).items() if "Hand" not in ours or ours.endswith("Hand")
    }
    assert told == expected


@pytest.mark.parametrize(
    ("names", "expected"),
    [
        ("mixamorig:LeftUpLeg mixamorig1:RightHandIndex2", "LeftUpLeg RightHandIndex2"),
        ("Character1_LeftForeArm Character1_Hips", "LeftForeArm Hips"),
        ("thigh.L shin.R upper_arm.L forearm.R hand.L foot.R toe.L", "LeftUpLeg RightLeg LeftArm RightForeArm LeftHand RightFoot LeftToeBase"),
        ("pelvis thigh_l calf_r ball_l clavicle_r upperarm_l lowerarm_r", "Hips LeftUpLeg RightLeg LeftToeBase RightShoulder LeftArm RightForeArm"),
        ("Bip01_L_Thigh Bip01_R_Calf Bip01_L_UpperArm Bip01_Head", "LeftUpLeg RightLeg LeftArm Head"),
        ("J_Bip_L_UpperLeg J_Bip_R_LowerArm J_Bip_C_Head", "LeftUpLeg RightForeArm Head"),
        ("lThigh rShin lShldr rForeArm lHand", "LeftUpLeg RightLeg LeftArm RightForeArm LeftHand"),
        ("leftThumbProximal rightLittleDistal", "LeftHandThumb1 RightHandPinky3"),
        ("Armature|LeftFoot", "LeftFoot"),
    ],
)  # fmt: skip
def test_other_programs_names(names: str, expected: str) -> None:
    found = match_names(names.split())
    assert [next((k for k, v in found.items() if v == i), None) for i in range(len(names.split()))] == expected.split()


def test_words_that_begin_like_a_side_are_left_alone() -> None:
    assert read_name("leg").side == ""
    assert read_name("Ring1_R").side == "Right"
    assert read_name("lowerback").side == ""
    assert read_name("root").side == ""


def test_the_mapping_can_be_overridden(media: Media) -> None:
    motion = read_bvh(media("mocap/cmu_02_01_walk.bvh"))
    mapping = map_joints(motion, {"Neck": "Neck", "LeftHandIndex1": None})
    assert mapping["Neck"] == "Neck"
    assert "LeftHandIndex1" not in mapping
    for wrong in ({"Tail": "Neck"}, {"Neck": "Tail"}):
        with pytest.raises(InputError) as error:
            map_joints(motion, wrong)
        assert error.value.code == "motion_joint_unknown"


def test_what_is_no_person_is_refused_and_shows_what_there_is() -> None:
    skeleton = build_skeleton(fingers=False)
    keep = [
        i for i, name in enumerate(skeleton.names) if "Leg" not in name and "Foot" not in name and "Toe" not in name
    ]
    parents = np.array([keep.index(p) if p in keep else -1 for p in skeleton.parents[keep]], np.int32)
    torso = Skeleton(tuple(f"b{i}" for i in keep), parents, skeleton.heads[keep])
    clip = Clip("still", 30.0, rotation.identity(3, len(keep)).astype(np.float32), np.zeros((3, 3), np.float32))
    with pytest.raises(InputError) as error:
        map_joints(told_by(torso, clip, rotation.identity(len(keep)), rotation.identity(), 1.0, prefix=""))
    assert error.value.code == "motion_not_humanoid"
    assert error.value.found["joints"] == list(torso.names)


def test_a_character_maps_to_itself(skeleton: Skeleton) -> None:
    clip = built_in("idle", skeleton)
    motion = told_by(skeleton, clip, rotation.identity(len(skeleton.names)), rotation.identity(), 0.01)
    assert map_joints(motion) == {name: f"mixamorig:{name}" for name in map_joints(motion)}
    assert set(map_joints(motion)) == set(skeleton.names)


def test_one_joint_cannot_move_both_legs(skeleton: Skeleton) -> None:
    clip = built_in("idle", skeleton)
    motion = told_by(skeleton, clip, rotation.identity(len(skeleton.names)), rotation.identity(), 0.01, prefix="")
    legs = [f"{side}{part}" for side in ("Left", "Right") for part in ("UpLeg", "Leg", "Foot")]
    with pytest.raises(
        InputError, match="'LeftLeg' cannot move all of LeftUpLeg, LeftLeg, LeftFoot, RightUpLeg"
    ) as error:
        map_joints(motion, dict.fromkeys(legs, "LeftLeg"))
    assert (error.value.code, error.value.correctable) == ("motion_not_humanoid", ("motion_joints", "motion"))
    assert error.value.found["joints"] == list(motion.names)
    assert map_joints(motion, {"Spine1": "Spine2"})["Spine1"] == "Spine2", "the trunk may share"
