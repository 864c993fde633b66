"""VRM files against the specification's tables, and the joints against those that engines ask of a humanoid."""

from pathlib import Path

import numpy as np
import pytest
from glb_reader import Glb, validate
from template_character import still, template_character

from engine.body.template import load_rig
from engine.export.gltf.glb import CharacterModel
from engine.export.gltf.vrm import VrmMeta, human_bones, write_vrm
from engine.geometry.rigging.skinned_mesh import SkinnedMesh

SIDES = ("Left", "Right")

UNITY = {
    "Hips": "Hips",
    "Spine": "Spine",
    "Head": "Head",
    **{
        f"{side}{theirs}": f"{side}{ours}"
        for side in SIDES
        for theirs, ours in {
            "UpperLeg": "UpLeg",
            "LowerLeg": "Leg",
            "Foot": "Foot",
            "UpperArm": "Arm",
            "LowerArm": "ForeArm",
            "Hand": "Hand",
        }.items()
    },
}
"""The bones without which Unity's Avatar is no humanoid, and our joints."""

UNREAL = {
    "pelvis": "Hips",
    "spine_01": "Spine",
    "spine_02": "Spine1",
    "spine_03": "Spine2",
    "neck_01": "Neck",
    "head": "Head",
    **{
        f"{theirs}_{side[0].lower()}": f"{side}{ours}"
        for side in SIDES
        for theirs, ours in {
            "clavicle": "Shoulder",
            "upperarm": "Arm",
            "lowerarm": "ForeArm",
            "hand": "Hand",
            "thigh": "UpLeg",
            "calf": "Leg",
            "foot": "Foot",
            "ball": "ToeBase",
            **{
                f"{finger}_0{k}": f"Hand{ours}{k}"
                for finger, ours in (
                    ("thumb", "Thumb"),
                    ("index", "Index"),
                    ("middle", "Middle"),
                    ("ring", "Ring"),
                    ("pinky", "Pinky"),
                )
                for k in (1, 2, 3)
            },
        }.items()
    },
}
"""The mannequin's bones that Unreal's retargeting chains begin and end with, and our joints."""

ANCESTORS = [
    ("hips", "spine"),
    ("spine", "chest"),
    ("chest", "upperChest"),
    ("upperChest", "neck"),
    ("neck", "head"),
] + [
    (f"{side}{above}", f"{side}{below}")
    for side in ("left", "right")
    for above, below in (
        ("Shoulder", "UpperArm"),
        ("UpperArm", "LowerArm"),
        ("LowerArm", "Hand"),
        ("UpperLeg", "LowerLeg"),
        ("LowerLeg", "Foot"),
        ("Foot", "Toes"),
        ("Hand", "ThumbMetacarpal"),
        ("ThumbMetacarpal", "ThumbProximal"),
        ("ThumbProximal", "ThumbDistal"),
        ("LittleProximal", "LittleIntermediate"),
        ("LittleIntermediate", "LittleDistal"),
    )
]
"""Which bone hangs on which, in the specification's table of human bones."""


@pytest.fixture(scope="module")
def mesh() -> SkinnedMesh:
    return template_character(texture_size=64)


@pytest.fixture(scope="module")
def path(mesh: SkinnedMesh, tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("vrm") / "character.vrm"
    meta = VrmMeta("Person", ("A. Author",), other_licence_url="https://example.org/licence", redistribution=True)
    write_vrm(path, CharacterModel(mesh, [still(mesh.skeleton)]), meta)
    return path


def test_the_file_is_a_valid_glb(path: Path) -> None:
    issues = validate(path)
    assert issues["numErrors"] == issues["numWarnings"] == 0
    assert {issue["code"] for issue in issues["messages"]} <= {"UNSUPPORTED_EXTENSION"}


def test_the_humanoid_has_every_required_bone_and_hangs_together(path: Path) -> None:
    glb = Glb(path)
    assert "VRMC_vrm" in glb.json["extensionsUsed"]
    bones = glb.json["extensions"]["VRMC_vrm"]["humanoid"]["humanBones"]
    assert len(bones) == 6 + 2 * (8 + 15)
    parents = {child: node for node, each in enumerate(glb.nodes) for child in each.get("children", [])}
    for above, below in ANCESTORS:
        node = bones[below]["node"]
        while node != bones[above]["node"]:
            node = parents[node]
    assert len({bone["node"] for bone in bones.values()}) == len(bones)
    for bone, entry in bones.items():
        if bone.startswith(("left", "right")):
            assert glb.names[entry["node"]].lower().startswith(bone[:4])


def test_the_meta_says_what_was_said_and_forbids_the_rest(path: Path) -> None:
    meta = Glb(path).json["extensions"]["VRMC_vrm"]["meta"]
    assert meta["name"] == "Person" and meta["authors"] == ["A. Author"]
    assert meta["licenseUrl"] == "https://vrm.dev/licenses/1.0/"
    assert meta["otherLicenseUrl"] == "https://example.org/licence"
    assert meta["allowRedistribution"] is True and meta["allowAntisocialOrHateUsage"] is False
    assert meta["avatarPermission"] == "onlyAuthor" and meta["modification"] == "prohibited"
    assert "contactInformation" not in meta


def test_the_first_person_looks_out_of_the_head(path: Path, mesh: SkinnedMesh) -> None:
    vrm = Glb(path).json["extensions"]["VRMC_vrm"]
    eye = mesh.skeleton.heads[mesh.skeleton.index("Head")] + np.array(vrm["lookAt"]["offsetFromHeadBone"])
    assert eye[1] < mesh.vertices[:, 1].max() and eye[1] > 0.9 * mesh.vertices[:, 1].max()
    (annotation,) = vrm["firstPerson"]["meshAnnotations"]
    assert "mesh" in Glb(path).nodes[annotation["node"]]


def test_the_meshs_arms_are_stretched_out_along_x(mesh: SkinnedMesh) -> None:
    heads, index = mesh.skeleton.heads, mesh.skeleton.index
    for side, out in (("Left", 1), ("Right", -1)):
        arm = heads[index(f"{side}Hand")] - heads[index(f"{side}Arm")]
        assert out * arm[0] / np.linalg.norm(arm) > 0.99


@pytest.mark.parametrize("table", [UNITY, UNREAL], ids=["Unity", "Unreal"])
def test_engines_find_the_joints_of_their_humanoids(table: dict[str, str]) -> None:
    assert set(table.values()) <= set(load_rig("mixamo").names)


def test_a_skeleton_that_is_no_human_is_refused(mesh: SkinnedMesh, tmp_path: Path) -> None:
    with pytest.raises(ValueError, match="leftFoot"):
        human_bones([name for name in mesh.skeleton.names if name != "LeftFoot"])
    with pytest.raises(ValueError, match="author"):
        write_vrm(tmp_path / "a.vrm", CharacterModel(mesh), VrmMeta("Person", ()))


def test_a_vrm_of_several_levels_of_detail_is_refused(mesh: SkinnedMesh, tmp_path: Path) -> None:
    with pytest.raises(ValueError, match="levels of detail"):
        write_vrm(tmp_path / "a.vrm", CharacterModel(mesh, levels=[mesh]), VrmMeta("Person", ("A. Author",)))
    assert list(tmp_path.iterdir()) == []


def test_where_there_are_two_joints_above_the_hips_the_upper_is_the_chest(mesh: SkinnedMesh) -> None:
    """VRM has no upper chest without a chest below it."""
    names = [name for name in mesh.skeleton.names if name != "Spine1"]
    found = human_bones(names)
    assert found["chest"]["node"] == names.index("Spine2") and "upperChest" not in found
    assert human_bones(mesh.skeleton.names)["upperChest"]["node"] == mesh.skeleton.names.index("Spine2")
