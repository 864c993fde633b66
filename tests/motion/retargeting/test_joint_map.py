"""Which joint is which."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from humanoids import build_skeleton, told_by
from hypothesis import example, given, settings
from hypothesis import strategies as st

from engine.errors import InputError
from engine.geometry.rigging.skeleton import Skeleton
from engine.motion import rotation
from engine.motion.clip import Clip
from engine.motion.files.bvh import read_bvh
from engine.motion.files.source_motion import SourceMotion, unique_names
from engine.motion.library import built_in
from engine.motion.retargeting.joint_map import lost_joints, lost_warning, map_joints
from engine.motion.retargeting.joint_names import match_names, read_name

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


def renamed(motion: SourceMotion, name: Callable[[str, int], str]) -> SourceMotion:
    return replace(motion, names=tuple(name(one, index) for index, one in enumerate(motion.names)))


def unreal(name: str, index: int) -> str:
    """Our joints as Unreal's mannequin calls them."""
    side = "_l" if name.startswith("Left") else "_r"
    part = name.removeprefix("Left").removeprefix("Right")
    words = {
        "Hips": "pelvis", "Spine": "spine_01", "Spine1": "spine_02", "Spine2": "spine_03", "Neck": "neck_01", "Head": "head",
        "Shoulder": "clavicle", "Arm": "upperarm", "ForeArm": "lowerarm", "Hand": "hand", "UpLeg": "thigh", "Leg": "calf",
        "Foot": "foot", "ToeBase": "ball",
    }  # fmt: skip
    told = words.get(part) or f"{part[4:-1].lower()}_0{part[-1]}"
    return told if name == part else told + side


def biped(name: str, index: int) -> str:
    """As 3ds Max calls them."""
    side = "L " if name.startswith("Left") else "R "
    part = name.removeprefix("Left").removeprefix("Right")
    words = {
        "Hips": "Pelvis",
        "Shoulder": "Clavicle",
        "Arm": "UpperArm",
        "UpLeg": "Thigh",
        "Leg": "Calf",
        "ToeBase": "Toe0",
    }
    if part.startswith("Hand") and part != "Hand":
        digit = ("Thumb", "Index", "Middle", "Ring", "Pinky").index(part[4:-1])
        part = f"Finger{digit}" + ("" if part[-1] == "1" else str(int(part[-1]) - 1))
    return "Bip01 " + (side if name.startswith(("Left", "Right")) else "") + words.get(part, part)


def rigify(name: str, index: int) -> str:
    """As Blender's rig does, whose every joint has the number of a copy."""
    side = ".L" if name.startswith("Left") else ".R"
    part = name.removeprefix("Left").removeprefix("Right")
    words = {
        "Hips": "hips",
        "Shoulder": "shoulder",
        "Arm": "upper_arm",
        "ForeArm": "forearm",
        "UpLeg": "thigh",
        "Leg": "shin",
        "ToeBase": "toe",
    }
    if part.startswith("Hand") and part != "Hand":
        part = f"{'' if part[4:-1] == 'Thumb' else 'f_'}{part[4:-1].lower()}.0{part[-1]}"
    told = words.get(part, part.lower())
    return f"DEF-{told}{'' if name in ('Hips', 'Neck', 'Head') or name.startswith('Spine') else side}.001"


HABITS: dict[str, Callable[[str, int], str]] = {
    "as they are": lambda name, index: name,
    "a colon": lambda name, index: f"mixamorig:{name}",
    "Collada": lambda name, index: f"mixamorig_{name}",
    "a number": lambda name, index: f"mixamorig1_{name}",
    "a longer number": lambda name, index: f"mixamorig12:{name}",
    "without a colon": lambda name, index: f"mixamorig{name}",
    "an armature": lambda name, index: f"Armature|{name}",
    "a program": lambda name, index: f"CC_Base_{name}",
    "anything": lambda name, index: f"Zoë's_robot-2_{name}",
    "behind": lambda name, index: f"{name}_jnt",
    "on both sides": lambda name, index: f"hero_{name}_bind_jnt",
    "copies": lambda name, index: f"{name}.001",
    "counted": lambda name, index: f"mixamorig:{name}_{index:02}",
    "Unreal": unreal,
    "3ds Max": biped,
    "rigify": rigify,
}


@pytest.mark.parametrize("habit", HABITS)
def test_what_all_names_have_in_common_says_nothing(skeleton: Skeleton, habit: str) -> None:
    """All joints are found, fingers too; beside them stand the nodes that such files have above and below."""
    walk = built_in("walk", skeleton)
    turns = rotation.identity(len(skeleton.names))
    motion = renamed(told_by(skeleton, walk, turns, rotation.IDENTITY_QUATERNION, 1.0, prefix=""), HABITS[habit])
    mapping = map_joints(motion)
    assert {ours: motion.names.index(theirs) for ours, theirs in mapping.items()} == {
        ours: index for index, ours in enumerate(skeleton.names)
    }
    others = match_names([*motion.names, "Armature", "Body_mesh", "root", "Camera"])
    assert {ours: others[ours] for ours in others} == match_names(motion.names)


@settings(max_examples=300, deadline=None)
@given(st.lists(st.lists(st.sampled_from(["thing", "rig", "left", "arm", "hips", "7"]), max_size=3), max_size=12))
@example([["thing", str(k)] for k in range(20)] + [["left", "arm"]])
@example([["thing"]] * 6 + [["left", "arm"]] * 2)
def test_names_of_any_kind_come_to_an_end(names: list[list[str]]) -> None:
    """Also where most have no more than what they have in common, and others have."""
    joined = unique_names(" ".join(words) for words in names)
    found = match_names(joined)
    assert len(set(found.values())) == len(found)


def test_what_names_said_is_kept_where_the_shape_has_to_help(skeleton: Skeleton) -> None:
    walk = built_in("walk", skeleton)
    motion = told_by(
        skeleton, walk, rotation.identity(len(skeleton.names)), rotation.IDENTITY_QUATERNION, 1.0, prefix=""
    )
    nameless = ("UpLeg", "Leg", "Foot", "ToeBase")
    odd = renamed(motion, lambda name, index: f"bone{index}" if name.endswith(nameless) else name)
    mapping = map_joints(odd)
    assert len(mapping) == len(skeleton.names)
    assert all(odd.names.index(theirs) == skeleton.index(ours) for ours, theirs in mapping.items())


def test_joints_that_turn_for_nothing_are_told_of(skeleton: Skeleton) -> None:
    walk = built_in("walk", skeleton)
    motion = told_by(
        skeleton, walk, rotation.identity(len(skeleton.names)), rotation.IDENTITY_QUATERNION, 1.0, prefix=""
    )
    assert lost_warning(motion, map_joints(motion)) is None
    tails = [f"tail {k}" for k in range(15)]
    frames = len(motion.rotations)
    wags = np.repeat(rotation.about("x", np.linspace(0, 1, frames))[:, None], 15, 1)
    held = np.repeat(rotation.identity(frames)[:, None], 1, 1)
    longer = replace(
        motion,
        names=(*motion.names, *tails, "held", "LeftArmHalf"),
        parents=np.array([*motion.parents, *[0] * 17], np.int32),
        rotations=np.concatenate([motion.rotations, wags, held, wags[:, :1]], 1),
        translations=np.concatenate([motion.translations, np.ones((frames, 17, 3))], 1),
    )
    assert list(lost_joints(longer, map_joints(motion))) == tails
    said = lost_warning(longer, map_joints(motion))
    assert said is not None and said.startswith("15 of") and "tail 9" in said and "tail 10" not in said
