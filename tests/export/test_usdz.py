"""USDZ files: opened, checked and posed by USD itself."""

import zipfile
from pathlib import Path

import numpy as np
import pytest
from PIL import Image
from pxr import Usd, UsdGeom, UsdShade, UsdSkel, UsdValidation
from template_character import still, template_character, walk

from engine.export.usdz import joint_paths, write_usdz
from engine.geometry.rigging.skinned_mesh import SkinnedMesh
from engine.geometry.rigging.skinning import skin
from engine.motion.kinematics import pose_transforms


@pytest.fixture(scope="module")
def mesh() -> SkinnedMesh:
    return template_character()


@pytest.fixture(scope="module")
def path(mesh: SkinnedMesh, tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("usdz") / "character.usdz"
    write_usdz(path, mesh, walk(mesh.skeleton))
    assert [each.name for each in path.parent.iterdir()] == ["character.usdz"]
    return path


def posed(stage: Usd.Stage, code: float) -> np.ndarray:
    """The mesh's points as UsdSkel poses them."""
    root = UsdSkel.Root(stage.GetDefaultPrim())
    cache = UsdSkel.Cache()
    cache.Populate(root, Usd.PrimDefaultPredicate)
    (binding,) = cache.ComputeSkelBindings(root, Usd.PrimDefaultPredicate)
    skeleton = cache.GetSkelQuery(binding.GetSkeleton())
    query = cache.GetSkinningQuery(binding.GetSkinningTargets()[0].GetPrim())
    transforms = skeleton.ComputeSkinningTransforms(code)
    points = UsdGeom.Mesh(query.GetPrim()).GetPointsAttr().Get()
    assert query.ComputeSkinnedPoints(transforms, points, code)
    return np.array(points)


def test_apples_rules_are_kept(path: Path) -> None:
    """The rules of USD's own compliance checker for ARKit, each of them a validator by now."""
    registry = UsdValidation.ValidationRegistry()
    every = registry.GetOrLoadValidatorsByName([each.name for each in registry.GetAllValidatorMetadata()])
    assert {"usdUtilsValidators:UsdzPackageValidator", "usdSkelValidators:SkelBindingApiValidator"} <= {
        each.GetMetadata().name for each in every
    }
    errors = UsdValidation.ValidationContext(every).Validate(Usd.Stage.Open(str(path)))
    assert [error.GetMessage() for error in errors] == []


def test_files_in_the_package_lie_uncompressed_at_multiples_of_64_bytes(path: Path) -> None:
    with zipfile.ZipFile(path) as package:
        entries = package.infolist()
        assert {Path(entry.filename).suffix for entry in entries} == {".usdc", ".jpg"}
        assert entries[0].filename.endswith(".usdc")
        for entry in entries:
            head = path.read_bytes()[entry.header_offset : entry.header_offset + 30]
            names = int.from_bytes(head[26:28], "little") + int.from_bytes(head[28:30], "little")
            assert (entry.header_offset + 30 + names) % 64 == 0 and entry.compress_type == zipfile.ZIP_STORED


def test_usd_poses_it_as_we_do(path: Path, mesh: SkinnedMesh) -> None:
    clip, stage = walk(mesh.skeleton), Usd.Stage.Open(str(path))
    for frame in (0, 11, 29):
        transforms = pose_transforms(mesh.skeleton, clip.rotations[[frame]], clip.root[[frame]])[0]
        expected = skin(mesh.vertices, mesh.bones, mesh.weights, transforms)
        assert np.abs(posed(stage, frame) - expected).max() < 2e-4
    np.testing.assert_allclose(posed(stage, 30), posed(stage, 0) + np.array([0, 0, 1.2]), atol=1e-4)


def test_units_axes_and_times(path: Path) -> None:
    stage = Usd.Stage.Open(str(path))
    assert UsdGeom.GetStageMetersPerUnit(stage) == 1 and UsdGeom.GetStageUpAxis(stage) == "Y"
    assert stage.GetTimeCodesPerSecond() == pytest.approx(30, abs=1e-4)
    assert (stage.GetStartTimeCode(), stage.GetEndTimeCode()) == (0, 30)
    assert stage.GetDefaultPrim().GetName() == "character"


def test_the_texture_comes_the_right_way_up(path: Path, mesh: SkinnedMesh, tmp_path: Path) -> None:
    stage = Usd.Stage.Open(str(path))
    uv = np.array(UsdGeom.PrimvarsAPI(stage.GetPrimAtPath("/character/Mesh")).GetPrimvar("st").Get())
    np.testing.assert_allclose(uv, np.stack([mesh.uv[:, 0], 1 - mesh.uv[:, 1]], 1), atol=1e-6)
    material, _ = UsdShade.MaterialBindingAPI(stage.GetPrimAtPath("/character/Mesh")).ComputeBoundMaterial()
    assert material.ComputeSurfaceSource()[0].GetIdAttr().Get() == "UsdPreviewSurface"
    with zipfile.ZipFile(path) as package:
        (name,) = (each for each in package.namelist() if each.endswith(".jpg"))
        texture = np.asarray(Image.open(package.extract(name, tmp_path)), float)
    assert np.abs(texture - mesh.texture).mean() < 4


def test_a_single_frame_is_held_for_a_second(mesh: SkinnedMesh, tmp_path: Path) -> None:
    clip = still(mesh.skeleton, "as pictured!")
    write_usdz(tmp_path / "still.usdz", mesh, clip, name="me")
    stage = Usd.Stage.Open(str(tmp_path / "still.usdz"))
    assert (stage.GetEndTimeCode() - stage.GetStartTimeCode()) / stage.GetTimeCodesPerSecond() == pytest.approx(1)
    transforms = pose_transforms(mesh.skeleton, clip.rotations, clip.root)[0]
    expected = skin(mesh.vertices, mesh.bones, mesh.weights, transforms)
    assert np.abs(posed(stage, 0.5) - expected).max() < 2e-4
    with pytest.raises(ValueError, match="identifier"):
        write_usdz(tmp_path / "bad.usdz", mesh, clip, name="no identifier")


def test_joints_are_paths_from_the_root(mesh: SkinnedMesh) -> None:
    paths = joint_paths(mesh.skeleton)
    assert paths[0] == "Hips" and "Hips/Spine/Spine1/Spine2/Neck/Head" in paths
    assert [path.rsplit("/", 1)[-1] for path in paths] == list(mesh.skeleton.names)
