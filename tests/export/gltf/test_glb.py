"""GLB files against the specification: judged by Khronos' validator, read back and posed by other means than ours."""

import io
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import trimesh
from glb_reader import Glb, validate
from PIL import Image
from template_character import still, template_character, walk

from engine.export.gltf.glb import TEXTURE_JPEG_QUALITY, TEXTURE_REDUCTIONS, CharacterModel, WrittenGlb, jpeg, write_glb
from engine.geometry.rigging.joint_axes import mixamo_axes
from engine.geometry.rigging.skinned_mesh import SkinnedMesh
from engine.geometry.rigging.skinning import skin
from engine.motion.edit import loop_travel
from engine.motion.kinematics import pose_transforms
from engine.motion.library import CLIPS, built_in


@pytest.fixture(scope="module")
def mesh() -> SkinnedMesh:
    return template_character()


@pytest.fixture(scope="module")
def path(mesh: SkinnedMesh, tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("glb") / "character.glb"
    skeleton = mesh.skeleton
    write_glb(path, CharacterModel(mesh, [walk(skeleton), walk(skeleton, travels=False), still(skeleton)]))
    return path


def test_the_validator_finds_nothing(path: Path) -> None:
    assert validate(path)["messages"] == []


def test_levels_of_detail_are_valid_and_share_the_skin(mesh: SkinnedMesh, tmp_path: Path) -> None:
    coarse = SkinnedMesh(**{**vars(mesh), "triangles": mesh.triangles[::2]})
    write_glb(tmp_path / "lod.glb", CharacterModel(mesh, [still(mesh.skeleton)], levels=[coarse], unlit=False))
    issues = validate(tmp_path / "lod.glb")
    assert issues["numErrors"] == issues["numWarnings"] == 0
    glb = Glb(tmp_path / "lod.glb")
    (shown,) = (node for node in glb.nodes if "extensions" in node)
    (level,) = shown["extensions"]["MSFT_lod"]["ids"]
    assert glb.nodes[level]["skin"] == shown["skin"] and level not in glb.json["scenes"][0]["nodes"]
    np.testing.assert_array_equal(glb.triangles(glb.nodes[level]["mesh"]), coarse.triangles)
    assert "extensions" not in glb.json["materials"][0]


def test_geometry_comes_back_to_the_bit(path: Path, mesh: SkinnedMesh) -> None:
    glb = Glb(path)
    np.testing.assert_array_equal(glb.attribute("POSITION"), mesh.vertices)
    np.testing.assert_array_equal(glb.attribute("TEXCOORD_0"), mesh.uv)
    np.testing.assert_array_equal(glb.triangles(), mesh.triangles)
    weights = np.zeros((len(mesh.vertices), len(mesh.skeleton.names)))
    np.add.at(weights, (np.arange(len(weights))[:, None], glb.attribute("JOINTS_0")), glb.attribute("WEIGHTS_0"))
    np.add.at(weights, (np.arange(len(weights))[:, None], mesh.bones), -mesh.weights)
    assert np.abs(weights).max() < 3 / 65535
    np.testing.assert_allclose(glb.attribute("WEIGHTS_0").sum(1), 1, atol=1e-12)


@pytest.fixture(scope="module")
def mixamo(mesh: SkinnedMesh, tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("mixamo") / "character.glb"
    write_glb(path, CharacterModel(mesh, [walk(mesh.skeleton), still(mesh.skeleton)], mixamo=True))
    return path


@pytest.mark.parametrize("name", ["walk", "walk_in_place", "pictured"])
def test_a_reader_of_the_file_poses_it_as_we_do(path: Path, mesh: SkinnedMesh, name: str) -> None:
    clips = {
        clip.name: clip for clip in (walk(mesh.skeleton), walk(mesh.skeleton, travels=False), still(mesh.skeleton))
    }
    clip, glb = clips[name], Glb(path)
    for frame in {0, len(clip.rotations) // 3, len(clip.rotations) - 1}:
        transforms = pose_transforms(mesh.skeleton, clip.rotations[[frame]], clip.root[[frame]])[0]
        expected = skin(mesh.vertices, mesh.bones, mesh.weights, transforms)
        found = glb.posed(name, float(np.float32(frame / clip.fps)))
        assert np.abs(found - expected).max() < 1e-4


@pytest.mark.parametrize("name", ["walk", "pictured"])
def test_so_does_one_whose_joints_have_axes_of_their_own(mixamo: Path, mesh: SkinnedMesh, name: str) -> None:
    clip, glb = {"walk": walk, "pictured": still}[name](mesh.skeleton), Glb(mixamo)
    frame = len(clip.rotations) // 3
    transforms = pose_transforms(mesh.skeleton, clip.rotations[[frame]], clip.root[[frame]])[0]
    expected = skin(mesh.vertices, mesh.bones, mesh.weights, transforms)
    assert np.abs(glb.posed(name, float(np.float32(frame / clip.fps))) - expected).max() < 1e-4


def test_what_is_built_as_mixamos_characters_has_all_of_it_in_the_armature(mixamo: Path, mesh: SkinnedMesh) -> None:
    issues = validate(mixamo)["messages"]
    assert {issue["code"] for issue in issues} == {"NODE_SKINNED_MESH_NON_ROOT"}, (
        "the place of one in it does not count"
    )
    glb = Glb(mixamo)
    (root,) = glb.json["scenes"][0]["nodes"]
    assert glb.names[root] == "Armature" and "rotation" not in glb.nodes[root]
    assert [glb.names[child] for child in glb.nodes[root]["children"]] == ["Hips", "character"]
    inverse = glb.array(glb.json["skins"][0]["inverseBindMatrices"])
    np.testing.assert_allclose(np.linalg.inv(inverse)[:, :3, :3], mixamo_axes(mesh.skeleton), atol=1e-6)


def test_a_loop_says_so_and_ends_where_it_began_moved_on_by_its_travel(path: Path) -> None:
    glb = Glb(path)
    assert glb.animation("walk")["extras"] == {"loops": True}
    assert "extras" not in glb.animation("pictured")
    np.testing.assert_allclose(glb.posed("walk_in_place", 1.0), glb.posed("walk_in_place", 0), atol=1e-5)
    np.testing.assert_allclose(glb.posed("walk", 1.0), glb.posed("walk", 0) + np.array([0, 0, 1.2]), atol=1e-5)


def test_joints_that_rest_are_left_out_and_those_held_have_one_key(path: Path) -> None:
    glb = Glb(path)
    walking = glb.animation("walk")
    keys = {
        (glb.names[channel["target"]["node"]], channel["target"]["path"]): len(
            glb.array(walking["samplers"][channel["sampler"]]["output"])
        )
        for channel in walking["channels"]
    }
    assert ("Head", "rotation") not in keys
    assert keys["LeftForeArm", "rotation"] == 1
    assert keys["LeftUpLeg", "rotation"] == keys["Hips", "translation"] == 31


def test_the_skeleton_binds_in_the_t_pose_under_mixamo_names(path: Path, mesh: SkinnedMesh) -> None:
    glb = Glb(path)
    skin_ = glb.json["skins"][0]
    assert [glb.names[node] for node in skin_["joints"]] == list(mesh.skeleton.names)
    inverse = glb.array(skin_["inverseBindMatrices"])
    np.testing.assert_allclose(np.linalg.inv(inverse)[:, :3, 3], mesh.skeleton.heads, atol=1e-6)
    assert all("rotation" not in node and "scale" not in node for node in glb.nodes)


def test_normals_are_smooth_across_seams_and_point_outwards(path: Path, mesh: SkinnedMesh) -> None:
    glb = Glb(path)
    normals = glb.attribute("NORMAL")
    reference = trimesh.Trimesh(mesh.vertices, mesh.triangles, process=False)
    _, where, twins = np.unique(mesh.vertices, axis=0, return_index=True, return_inverse=True)
    np.testing.assert_array_equal(normals, normals[where][twins])
    faces = reference.face_normals[reference.area_faces > 1e-9]
    corners = normals[mesh.triangles[reference.area_faces > 1e-9]]
    assert ((corners * faces[:, None]).sum(2) > 0).mean() > 0.99


def test_the_texture_and_the_material(path: Path, mesh: SkinnedMesh, tmp_path: Path) -> None:
    glb = Glb(path)
    assert glb.json["materials"][0]["extensions"] == {"KHR_materials_unlit": {}}
    assert glb.json["extensionsUsed"] == ["KHR_materials_unlit"] and "extensionsRequired" not in glb.json
    (tmp_path / "texture.jpg").write_bytes(glb.view(glb.json["images"][0]["bufferView"]))
    texture = np.asarray(Image.open(tmp_path / "texture.jpg"), float)
    assert 10 * np.log10(255**2 / ((texture - mesh.texture) ** 2).mean()) > 33


def test_other_software_opens_it(path: Path, mesh: SkinnedMesh) -> None:
    scene = trimesh.load(path)
    (geometry,) = scene.geometry.values()
    assert geometry.vertices.shape == mesh.vertices.shape and geometry.faces.shape == mesh.triangles.shape
    assert geometry.visual.material.baseColorTexture.size == (512, 512)


def test_many_vertices_get_wide_indices(mesh: SkinnedMesh, tmp_path: Path) -> None:
    times = 5
    count = len(mesh.vertices)
    many = SkinnedMesh(
        mesh.skeleton,
        np.tile(mesh.vertices, (times, 1)),
        np.concatenate([mesh.triangles + k * count for k in range(times)]).astype(np.int32),
        *(np.tile(column, (times, 1)) for column in (mesh.uv, mesh.bones, mesh.weights)),
        texture=mesh.texture[:64, :64],
    )
    write_glb(tmp_path / "many.glb", CharacterModel(many))
    assert validate(tmp_path / "many.glb")["messages"] == []
    np.testing.assert_array_equal(Glb(tmp_path / "many.glb").triangles(), many.triangles)


def test_noise_is_a_texture_like_any_other() -> None:
    """Of more than a byte to a pixel; and no colour is shared with a neighbour."""
    noise = np.random.default_rng(6).integers(0, 256, (256, 512, 3), np.uint8)
    packed = jpeg(noise, TEXTURE_JPEG_QUALITY, synthetic=True)
    assert len(packed) > noise.size / 3
    with Image.open(io.BytesIO(packed)) as texture:
        assert np.abs(np.asarray(texture).astype(int) - noise).mean() < 12


def test_a_file_that_would_be_too_large_has_the_mildest_texture_that_fits(mesh: SkinnedMesh, tmp_path: Path) -> None:
    noise = np.random.default_rng(5).integers(0, 256, (512, 1024, 3), np.uint8)
    noisy, file = replace(mesh, texture=noise), tmp_path / "a.glb"
    free = write_glb(file, CharacterModel(noisy))
    assert (
        free
        == write_glb(file, CharacterModel(noisy), most=free.size)
        == WrittenGlb(file.stat().st_size, 1, TEXTURE_JPEG_QUALITY)
    )
    before = free
    for smaller, quality in TEXTURE_REDUCTIONS:
        written = write_glb(file, CharacterModel(noisy), most=before.size - 1)
        assert written == WrittenGlb(file.stat().st_size, smaller, quality)
        assert written.size < before.size
        assert validate(file)["messages"] == []
        glb = Glb(file)
        with Image.open(io.BytesIO(glb.view(glb.json["images"][0]["bufferView"]))) as texture:
            assert texture.size == (1024 // smaller, 512 // smaller)
        before = written
    assert write_glb(file, CharacterModel(noisy), most=before.size - 1) == free, "not by the texture: it stays as it is"


def test_what_does_not_fit_is_refused_and_leaves_no_file(mesh: SkinnedMesh, tmp_path: Path) -> None:
    clip = still(mesh.skeleton)
    with pytest.raises(ValueError, match="same name"):
        write_glb(tmp_path / "a.glb", CharacterModel(mesh, [clip, clip]))
    with pytest.raises(ValueError, match="does not fit"):
        write_glb(tmp_path / "a.glb", CharacterModel(mesh, [type(clip)("other", 30, clip.rotations[:, :5], clip.root)]))
    assert list(tmp_path.iterdir()) == []


def test_every_built_in_clip_is_valid_and_loops_close(mesh: SkinnedMesh, tmp_path: Path) -> None:
    clips = [built_in(name, mesh.skeleton) for name in CLIPS]
    write_glb(tmp_path / "clips.glb", CharacterModel(mesh, clips))
    assert validate(tmp_path / "clips.glb")["messages"] == []
    glb = Glb(tmp_path / "clips.glb")
    assert [each["name"] for each in glb.json["animations"]] == list(CLIPS)
    for clip in clips:
        if clip.loops:
            moved = glb.posed(clip.name, clip.seconds) - glb.posed(clip.name, 0.0)
            np.testing.assert_allclose(moved, np.broadcast_to(moved[0], moved.shape), atol=1e-5)
            np.testing.assert_allclose(moved[0], loop_travel(clip) if clip.name in ("walk", "run") else 0, atol=2e-4)
