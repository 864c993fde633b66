"""The skeleton has the bones that the humanoid maps of engines require, each under the one that they expect above it."""

from __future__ import annotations

from itertools import pairwise

import pytest

from engine.body.rig import HUMAN_RIG
from engine.body.template import load_rig
from engine.character.fit.template_fit import load_human

SIDES = ("Left", "Right")

UNITY = {
    **{"Hips": "Hips", "Spine": "Spine", "Head": "Head"},
    **{
        f"{side}{bone}": f"{side}{joint}"
        for side in SIDES
        for bone, joint in (
            *(("UpperLeg", "UpLeg"), ("LowerLeg", "Leg"), ("Foot", "Foot")),
            *(("UpperArm", "Arm"), ("LowerArm", "ForeArm"), ("Hand", "Hand")),
        )
    },
}
"""The fifteen bones that Unity's Avatar requires (HumanBodyBones), as our joints."""

UNREAL = {
    **{"pelvis": "Hips", "spine_01": "Spine", "spine_02": "Spine1", "spine_03": "Spine2"},
    **{"neck_01": "Neck", "head": "Head"},
    **{
        f"{bone}_{side[0].lower()}": f"{side}{joint}"
        for side in SIDES
        for bone, joint in (
            *(("clavicle", "Shoulder"), ("upperarm", "Arm"), ("lowerarm", "ForeArm"), ("hand", "Hand")),
            *(("thigh", "UpLeg"), ("calf", "Leg"), ("foot", "Foot"), ("ball", "ToeBase")),
            *((f"{finger}_0{k}", f"Hand{ours}{k}") for finger, ours in (
                ("thumb", "Thumb"), ("index", "Index"), ("middle", "Middle"), ("ring", "Ring"), ("pinky", "Pinky"))
              for k in (1, 2, 3)),
        )
    },
}  # fmt: skip
"""The bones of Unreal's mannequin that its retargeting chains name, as our joints."""

OPTIONAL = {"Jaw": "Jaw", "LeftEye": "LeftEye", "RightEye": "RightEye"}
"""Bones of Unity's Avatar, and of VRM's humanoid, that a face may have, as our joints."""

CHAINS = (
    ("Hips", "Spine", "Spine1", "Spine2", "Neck", "Head"),
    *(("Spine2", f"{side}Shoulder", f"{side}Arm", f"{side}ForeArm", f"{side}Hand") for side in SIDES),
    *(("Head", joint) for joint in OPTIONAL.values()),
    *(("Hips", f"{side}UpLeg", f"{side}Leg", f"{side}Foot", f"{side}ToeBase") for side in SIDES),
    *((f"{side}Hand", f"{side}HandIndex1", f"{side}HandIndex2", f"{side}HandIndex3") for side in SIDES),
)


@pytest.mark.parametrize("required", [UNITY, UNREAL, OPTIONAL], ids=["Unity", "Unreal", "optional"])
def test_every_bone_that_an_engine_requires_is_there(required: dict[str, str]) -> None:
    names = load_rig(HUMAN_RIG).names
    assert {bone: joint for bone, joint in required.items() if joint not in names} == {}
    assert len(set(required.values())) == len(required), "no joint is two bones"


@pytest.mark.parametrize("chain", CHAINS, ids=lambda chain: chain[-1])
def test_chains_hang_together(chain: tuple[str, ...]) -> None:
    rig = load_rig(HUMAN_RIG)
    for upper, lower in pairwise(chain):
        assert rig.names[rig.parents[rig.index(lower)]] == upper


def test_the_root_is_the_hips() -> None:
    rig = load_rig(HUMAN_RIG)
    assert [name for name, parent in zip(rig.names, rig.parents, strict=True) if parent < 0] == ["Hips"]


def test_a_character_made_of_a_picture_has_the_bodys_joints_alone() -> None:
    """It is one surface: neither mouth nor eyes open in it."""
    human = load_human()
    assert human.rig.names == human.space.names == tuple(load_rig("mixamo").names)
    assert {*load_rig(HUMAN_RIG).names} - {*human.rig.names} == {*OPTIONAL.values()}
