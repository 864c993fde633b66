"""Morph targets and materials in GLB files, and expressions in VRM files: judged by Khronos' validator, and read back."""

from __future__ import annotations

import io
from pathlib import Path

import numpy as np
import pytest
import trimesh
from glb_reader import Glb, validate
from PIL import Image
from template_character import still, template_character, walk

from engine.body import load_template
from engine.body.template import FACE_UNITS
from engine.export.gltf.glb import CharacterModel, build_glb, write_glb
from engine.export.gltf.materials import Material, TextureTransform
from engine.export.gltf.vrm import VrmMeta, write_vrm
from engine.export.gltf.vrm_expressions import ARKIT_MIXTURES, PRESET_NAMES, Expression, arkit_expressions
from engine.geometry.mesh.surface import triangulate
from engine.geometry.rigging.morph_target import MorphTarget, MorphTrack, morph_target
from engine.geometry.rigging.skinned_mesh import SkinnedMesh

META = VrmMeta("Person", ("A. Author",))


@pytest.fixture(scope="module")
def mesh() -> SkinnedMesh:
    return template_character(texture_size=64)


@pytest.fixture(scope="module")
def face_units(mesh: SkinnedMesh) -> list[MorphTarget]:
    """ARKit's units of the template, for the character's vertices, doubled along seams as they are."""
    template = load_template()
    span = slice(*template.parts["body"])
    corners = np.stack([triangulate(template.quads[span]), triangulate(template.uv_quads[span])], 2).reshape(-1, 2)
    shown = np.unique(corners, axis=0)[:, 0]
    assert len(shown) == len(mesh.vertices)
    return [morph_target(name, template.face_units.displacement({name: 1.0})[shown]) for name in FACE_UNITS]


@pytest.fixture(scope="module")
def path(mesh: SkinnedMesh, face_units: list[MorphTarget], tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("morphs") / "character.glb"
    write_glb(path, CharacterModel(mesh, [still(mesh.skeleton)], morphs=face_units))
    return path


def targets(glb: Glb) -> list[dict[str, int]]:
    return glb.json["meshes"][0]["primitives"][0]["targets"]


def test_the_validator_finds_nothing(path: Path) -> None:
    assert validate(path)["messages"] == []


def test_shapes_come_back_to_the_bit_under_their_names(
    path: Path, mesh: SkinnedMesh, face_units: list[MorphTarget]
) -> None:
    glb = Glb(path)
    assert glb.json["meshes"][0]["extras"]["targetNames"] == list(FACE_UNITS)
    assert len(targets(glb)) == 52 == len(glb.json["meshes"][0]["weights"])
    for target, unit in zip(targets(glb), face_units, strict=True):
        found = glb.array(target["POSITION"])
        np.testing.assert_array_equal(found, unit.dense(len(mesh.vertices)))
        accessor = glb.json["accessors"][target["POSITION"]]
        np.testing.assert_array_equal(accessor["min"], found.min(0))
        np.testing.assert_array_equal(accessor["max"], found.max(0))


def test_targets_are_sparse_where_that_is_smaller(
    path: Path, mesh: SkinnedMesh, face_units: list[MorphTarget], tmp_path: Path
) -> None:
    glb = Glb(path)
    sparse = ["sparse" in glb.json["accessors"][target["POSITION"]] for target in targets(glb)]
    assert sparse == [len(unit.moved) > 0 for unit in face_units] and sum(sparse) == 51  # the skin has no tongue
    everywhere = morph_target("all", np.full((len(mesh.vertices), 3), 0.01))
    few = MorphTarget("few", np.array([5, 700]), np.full((2, 3), 0.02, np.float32))
    write_glb(tmp_path / "a.glb", CharacterModel(mesh, morphs=[everywhere, few]))
    assert validate(tmp_path / "a.glb")["messages"] == []
    glb = Glb(tmp_path / "a.glb")
    kinds = ["sparse" in glb.json["accessors"][target["POSITION"]] for target in targets(glb)]
    assert kinds == [False, True]
    np.testing.assert_array_equal(glb.array(targets(glb)[0]["POSITION"]), everywhere.dense(len(mesh.vertices)))
    write_glb(tmp_path / "b.glb", CharacterModel(mesh))
    more = (tmp_path / "a.glb").stat().st_size - (tmp_path / "b.glb").stat().st_size
    assert more < 12 * len(mesh.vertices) + 3000


def test_other_software_opens_it(path: Path, mesh: SkinnedMesh) -> None:
    (geometry,) = trimesh.load(path).geometry.values()
    assert geometry.vertices.shape == mesh.vertices.shape


def test_a_lit_character_has_the_normals_of_its_shapes(
    mesh: SkinnedMesh, face_units: list[MorphTarget], tmp_path: Path
) -> None:
    opened = next(unit for unit in face_units if unit.name == "jawOpen")
    write_glb(tmp_path / "lit.glb", CharacterModel(mesh, morphs=[opened], unlit=False))
    assert validate(tmp_path / "lit.glb")["messages"] == []
    glb = Glb(tmp_path / "lit.glb")
    normals = glb.attribute("NORMAL") + glb.array(targets(glb)[0]["NORMAL"])
    moved = mesh.vertices + opened.dense(len(mesh.vertices))
    np.testing.assert_allclose(np.linalg.norm(normals, axis=1), 1, atol=1e-3)
    _, where, twins = np.unique(mesh.vertices, axis=0, return_index=True, return_inverse=True)
    np.testing.assert_allclose(normals, normals[where][twins], atol=1e-6)  # no seam opens in the light
    a, b, c = (moved[mesh.triangles[:, k]].astype(float) for k in range(3))
    across = np.cross(b - a, c - a)
    areas = np.linalg.norm(across, axis=1)
    sound = areas > 1e-9
    faces = across[sound] / areas[sound][:, None]
    assert ((normals[mesh.triangles[sound]] * faces[:, None]).sum(2) > 0).mean() > 0.99
    turned = twins[mesh.triangles[np.isin(twins[mesh.triangles], twins[opened.moved]).any(1)]]
    assert not glb.array(targets(glb)[0]["NORMAL"])[~np.isin(twins, turned)].any()


def test_a_shape_that_moves_nothing_is_valid(mesh: SkinnedMesh, tmp_path: Path) -> None:
    nothing = MorphTarget("nothing", np.zeros(0, int), np.zeros((0, 3), np.float32))
    write_glb(tmp_path / "a.glb", CharacterModel(mesh, morphs=[nothing], unlit=False))
    issues = validate(tmp_path / "a.glb")
    assert issues["numErrors"] == issues["numWarnings"] == 0
    assert not Glb(tmp_path / "a.glb").array(targets(Glb(tmp_path / "a.glb"))[0]["POSITION"]).any()


def test_wrong_shapes_are_refused_and_leave_no_file(mesh: SkinnedMesh, tmp_path: Path) -> None:
    one = np.zeros((1, 3), np.float32)
    good = MorphTarget("a", np.array([1]), one)
    for wrong, reason in (
        ([good, good], "same name"),
        ([MorphTarget("a", np.array([1, 1]), np.zeros((2, 3), np.float32))], "twice"),
        ([MorphTarget("a", np.array([len(mesh.vertices)]), one)], "not there"),
        ([MorphTarget("a", np.array([-1]), one)], "not there"),
        ([MorphTarget("a", np.array([1, 2]), one)], "displacements"),
        ([MorphTarget("a", np.array([1]), one * np.nan)], "finite"),
    ):
        with pytest.raises(ValueError, match=reason):
            write_glb(tmp_path / "a.glb", CharacterModel(mesh, morphs=wrong))
    assert list(tmp_path.iterdir()) == []


def test_several_materials_share_vertices_and_shapes(
    mesh: SkinnedMesh, face_units: list[MorphTarget], tmp_path: Path
) -> None:
    red = np.zeros((8, 8, 3), np.uint8) + np.array([200, 30, 30], np.uint8)
    lash = np.dstack([red, np.tile(np.arange(8, dtype=np.uint8) * 32, (8, 1))])
    turned = TextureTransform(offset=(0.25, 0.5), rotation=0.3, scale=(2.0, 0.5))
    kinds = [
        Material("skin"),
        Material("eyes", red, roughness=0.1, transform=turned),
        Material("lashes", lash, (1, 1, 1, 0.5), "BLEND", two_sided=True),
        Material("unused"),
    ]
    which = np.arange(len(mesh.triangles)) * 3 // len(mesh.triangles)
    write_glb(tmp_path / "a.glb", CharacterModel(mesh, morphs=face_units[:3], materials=kinds, material_of=which))
    issues = validate(tmp_path / "a.glb")
    assert issues["numErrors"] == issues["numWarnings"] == 0
    glb = Glb(tmp_path / "a.glb")
    primitives = glb.json["meshes"][0]["primitives"]
    assert [each["material"] for each in primitives] == [0, 1, 2]
    assert all(each["attributes"] == primitives[0]["attributes"] for each in primitives)
    assert all(each["targets"] == primitives[0]["targets"] for each in primitives)
    drawn = np.concatenate([glb.array(each["indices"]).reshape(-1, 3) for each in primitives])
    np.testing.assert_array_equal(drawn, mesh.triangles)
    skin, eyes, lashes, _ = glb.json["materials"]
    assert glb.json["extensionsUsed"] == ["KHR_materials_unlit", "KHR_texture_transform"]
    info = eyes["pbrMetallicRoughness"]["baseColorTexture"]
    assert info["extensions"]["KHR_texture_transform"] == {"offset": [0.25, 0.5], "rotation": 0.3, "scale": [2.0, 0.5]}
    assert lashes["alphaMode"] == "BLEND" and lashes["doubleSided"]
    assert not any(one.get("doubleSided") for one in (skin, eyes))
    assert lashes["pbrMetallicRoughness"]["baseColorFactor"] == [1, 1, 1, 0.5]
    assert skin["pbrMetallicRoughness"]["baseColorTexture"]["index"] == 0
    texture = glb.json["textures"][lashes["pbrMetallicRoughness"]["baseColorTexture"]["index"]]
    with Image.open(io.BytesIO(glb.view(glb.json["images"][texture["source"]]["bufferView"]))) as found:
        np.testing.assert_array_equal(np.asarray(found), lash)
    scene = trimesh.load(tmp_path / "a.glb")
    assert sum(len(each.faces) for each in scene.geometry.values()) == len(mesh.triangles)


def test_materials_that_do_not_fit_are_refused(mesh: SkinnedMesh, tmp_path: Path) -> None:
    two = [Material("a"), Material("b")]
    which = np.zeros(len(mesh.triangles), int)
    for given, reason in (
        ({"materials": two}, "say which"),
        ({"materials": two, "material_of": which[:-1]}, "not there"),
        ({"materials": two, "material_of": which + 2}, "not there"),
        ({"materials": two, "material_of": which, "levels": [mesh]}, "one material"),
    ):
        with pytest.raises(ValueError, match=reason):
            write_glb(tmp_path / "a.glb", CharacterModel(mesh, **given))


def test_a_vrm_has_expressions_of_its_own_names_and_the_characters(
    mesh: SkinnedMesh, face_units: list[MorphTarget], tmp_path: Path
) -> None:
    said = arkit_expressions([unit.name for unit in face_units])
    write_vrm(
        tmp_path / "a.vrm",
        CharacterModel(mesh, [still(mesh.skeleton)], morphs=face_units),
        META,
        expressions=said,
        look_at="expression",
    )
    issues = validate(tmp_path / "a.vrm")
    assert issues["numErrors"] == issues["numWarnings"] == 0
    glb = Glb(tmp_path / "a.vrm")
    vrm = glb.json["extensions"]["VRMC_vrm"]
    assert set(vrm["expressions"]["preset"]) == set(PRESET_NAMES)
    assert set(vrm["expressions"]["custom"]) == set(FACE_UNITS)
    names = glb.json["meshes"][0]["extras"]["targetNames"]
    for name, expression in vrm["expressions"]["preset"].items():
        binds = {names[bind["index"]]: bind["weight"] for bind in expression.get("morphTargetBinds", [])}
        assert binds == ARKIT_MIXTURES[name].targets
        assert all("mesh" in glb.nodes[bind["node"]] for bind in expression.get("morphTargetBinds", []))
        assert expression["overrideBlink"] in ("none", "block", "blend") and expression["isBinary"] is False
    assert vrm["lookAt"]["type"] == "expression"
    assert all(vrm["lookAt"][f"rangeMap{side}"]["outputScale"] == 1.0 for side in ("VerticalUp", "HorizontalOuter"))


def test_without_expressions_a_vrm_says_nothing_of_them(mesh: SkinnedMesh, tmp_path: Path) -> None:
    write_vrm(tmp_path / "a.vrm", CharacterModel(mesh), META)
    vrm = Glb(tmp_path / "a.vrm").json["extensions"]["VRMC_vrm"]
    assert "expressions" not in vrm and vrm["lookAt"]["type"] == "bone"


def test_only_what_the_shapes_can_show_is_an_expression() -> None:
    said = arkit_expressions(["eyeBlinkLeft", "eyeBlinkRight", "jawOpen", "wink", "blink"])
    assert set(said) == {
        "blink",
        "blinkLeft",
        "blinkRight",
        "neutral",
        "eyeBlinkLeft",
        "eyeBlinkRight",
        "jawOpen",
        "wink",
    }
    assert dict(said["blink"].targets) == {"eyeBlinkLeft": 1.0, "eyeBlinkRight": 1.0}


def test_every_mixture_is_of_face_units_within_bounds() -> None:
    assert set(ARKIT_MIXTURES) == set(PRESET_NAMES)
    for mixture in ARKIT_MIXTURES.values():
        assert set(mixture.targets) <= set(FACE_UNITS)
        assert all(0 < weight <= 1 for weight in mixture.targets.values())


def test_expressions_that_do_not_fit_are_refused(
    mesh: SkinnedMesh, face_units: list[MorphTarget], tmp_path: Path
) -> None:
    for given, reason in (
        ({"expressions": {"happy": Expression({"smirk": 1.0})}}, "smirk"),
        ({"expressions": {"happy": Expression({"jawOpen": 1.5})}}, "0 to 1"),
        ({"look_at": "expression"}, "lookUp"),
    ):
        with pytest.raises(ValueError, match=reason):
            write_vrm(tmp_path / "a.vrm", CharacterModel(mesh, morphs=face_units), META, **given)
    assert list(tmp_path.iterdir()) == []


def test_what_a_face_does_during_a_clip_comes_back_from_its_animation(
    mesh: SkinnedMesh, face_units: list[MorphTarget], tmp_path: Path
) -> None:
    names = ("jawOpen", "not of this mesh", "browInnerUp")
    track = MorphTrack(names, np.random.default_rng(4).uniform(0, 1, (30, 3)).astype(np.float32))
    loop = walk(mesh.skeleton)
    model = CharacterModel(mesh, [loop, still(mesh.skeleton)], morphs=face_units, expressions={loop.name: track})
    write_glb(tmp_path / "acting.glb", model)
    assert validate(tmp_path / "acting.glb")["messages"] == []

    glb = Glb(tmp_path / "acting.glb")
    animation = glb.animation(loop.name)
    (channel,) = [one for one in animation["channels"] if one["target"]["path"] == "weights"]
    sampler = animation["samplers"][channel["sampler"]]
    times, weights = glb.array(sampler["input"]), glb.array(sampler["output"]).reshape(-1, 52)
    assert len(times) == len(weights) == 31  # a loop ends on its first frame
    for column, name in enumerate(FACE_UNITS):
        given = track.weights[:, names.index(name)] if name in names else np.zeros(30, np.float32)
        np.testing.assert_array_equal(weights[:, column], [*given, given[0]])


def test_a_face_holds_its_expression_as_long_as_a_clip_of_one_frame(
    mesh: SkinnedMesh, face_units: list[MorphTarget], tmp_path: Path
) -> None:
    pose = still(mesh.skeleton)
    track = MorphTrack(("jawOpen",), np.array([[0.75]], np.float32))
    write_glb(tmp_path / "held.glb", CharacterModel(mesh, [pose], morphs=face_units, expressions={pose.name: track}))
    assert validate(tmp_path / "held.glb")["messages"] == []
    glb = Glb(tmp_path / "held.glb")
    animation = glb.animation(pose.name)
    (channel,) = [one for one in animation["channels"] if one["target"]["path"] == "weights"]
    weights = glb.array(animation["samplers"][channel["sampler"]]["output"]).reshape(-1, 52)
    np.testing.assert_array_equal(weights[:, FACE_UNITS.index("jawOpen")], [0.75, 0.75])


def test_expressions_that_do_not_fit_the_clips_are_refused(mesh: SkinnedMesh, face_units: list[MorphTarget]) -> None:
    track = MorphTrack(("jawOpen",), np.zeros((7, 1), np.float32))
    for name, message in (("dance", "clips that are not there"), ("walk", "has 30 frames, its expressions 7")):
        model = CharacterModel(mesh, [walk(mesh.skeleton)], morphs=face_units, expressions={name: track})
        with pytest.raises(ValueError, match=message):
            build_glb(model, b"")
