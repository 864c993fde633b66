"""Characters out as USDZ, for AR Quick Look: a skinned mesh, its skeleton and one clip.

Follows what Apple's viewers ask of a USDZ: metres, y up, one UsdPreviewSurface with its textures in the package, joints
as paths, files stored uncompressed at multiples of 64 bytes (which `UsdUtils` sees to).
"""

from __future__ import annotations

import tempfile
from pathlib import Path

import numpy as np
from pxr import Gf, Sdf, Usd, UsdGeom, UsdShade, UsdSkel, UsdUtils, Vt

from engine.export.animation_tracks import tracks
from engine.export.gltf.glb import jpeg
from engine.export.influences import FULL_INFLUENCE, quantise_influences
from engine.export.synthetic import SOURCE_TYPE, SYNTHETIC_STATEMENT
from engine.geometry.mesh.welding import seamless_normals
from engine.geometry.rigging.skeleton import Skeleton
from engine.geometry.rigging.skinned_mesh import SkinnedMesh
from engine.motion.clip import Clip


def write_usdz(
    path: Path,
    mesh: SkinnedMesh,
    clip: Clip,
    *,
    name: str = "character",
    quality: int = 90,
    synthetic: bool = True,
) -> None:
    """Write a character that plays one clip; the file appears under its name when it is whole.

    Parameters
    ----------
    name : an identifier (letters, digits, underscores): of the scene's root.
    quality : of the texture, a JPEG (1 to 100).
    synthetic : whether the file says of itself that it is synthetic (`engine.export.synthetic`).

    Raises ValueError where the clip does not fit the skeleton or the name is no identifier.
    """
    if not Sdf.Path.IsValidIdentifier(name):
        raise ValueError(f"{name!r} is no identifier")
    with tempfile.TemporaryDirectory(dir=path.parent, prefix=f".{path.name}-") as folder:
        layer, package = Path(folder, f"{name}.usdc"), Path(folder, f"{name}.usdz")
        Path(folder, "texture.jpg").write_bytes(jpeg(mesh.texture, quality, synthetic))
        stage = Usd.Stage.CreateNew(str(layer))
        _describe(stage, mesh, clip, name, synthetic)
        stage.GetRootLayer().Save()
        if not UsdUtils.CreateNewARKitUsdzPackage(Sdf.AssetPath(str(layer)), str(package)):
            raise OSError(f"the package {path.name} could not be written")
        package.replace(path)


def joint_paths(skeleton: Skeleton) -> list[str]:
    """Each joint as UsdSkel names it: the path from the root, such as `Hips/Spine/Spine1`."""
    paths: list[str] = []
    for joint, parent in zip(skeleton.names, skeleton.parents, strict=True):
        paths.append(f"{paths[parent]}/{joint}" if parent >= 0 else joint)
    return paths


def _describe(stage: Usd.Stage, mesh: SkinnedMesh, clip: Clip, name: str, synthetic: bool) -> None:
    keys = tracks(clip, mesh.skeleton)
    UsdGeom.SetStageMetersPerUnit(stage, 1.0)
    UsdGeom.SetStageUpAxis(stage, UsdGeom.Tokens.y)
    # time codes are the clip's frames; a single frame is held, so its two keys are not a frame apart
    rate = float(len(keys.times) - 1) / float(keys.times[-1])
    stage.SetTimeCodesPerSecond(rate)
    stage.SetFramesPerSecond(rate)
    stage.SetStartTimeCode(0)
    stage.SetEndTimeCode(len(keys.times) - 1)
    root = UsdSkel.Root.Define(stage, f"/{name}")
    stage.SetDefaultPrim(root.GetPrim())
    if synthetic:
        stage.GetRootLayer().comment = SYNTHETIC_STATEMENT
        root.GetPrim().SetCustomDataByKey("digitalSourceType", SOURCE_TYPE)
    skeleton = _add_skeleton(stage, mesh.skeleton, name)
    skeleton.CreateVisibilityAttr(UsdGeom.Tokens.inherited)
    animation = UsdSkel.Animation.Define(stage, f"/{name}/Skeleton/{_identifier(clip.name)}")
    animation.CreateJointsAttr(joint_paths(mesh.skeleton))
    offsets = mesh.skeleton.offsets()
    translations, rotations = animation.CreateTranslationsAttr(), animation.CreateRotationsAttr()
    animation.CreateScalesAttr(Vt.Vec3hArray(len(offsets), Gf.Vec3h(1, 1, 1)))
    for code, (turned, place) in enumerate(zip(keys.rotations, keys.root, strict=True)):
        places = offsets.copy()
        places[mesh.skeleton.parents < 0] = place
        translations.Set(Vt.Vec3fArray.FromNumpy(places), code)
        rotations.Set(Vt.QuatfArray([Gf.Quatf(float(w), float(x), float(y), float(z)) for x, y, z, w in turned]), code)
    UsdSkel.BindingAPI.Apply(skeleton.GetPrim()).CreateAnimationSourceRel().SetTargets([animation.GetPath()])
    shape = _add_mesh(stage, mesh, name, skeleton)
    shape.GetPrim().ApplyAPI(UsdShade.MaterialBindingAPI)
    UsdShade.MaterialBindingAPI(shape).Bind(_add_material(stage, name))
    root.CreateExtentAttr(shape.GetExtentAttr().Get())


def _identifier(name: str) -> str:
    return "".join(letter if letter.isascii() and letter.isalnum() else "_" for letter in f"clip_{name}")


def _add_skeleton(stage: Usd.Stage, skeleton: Skeleton, name: str) -> UsdSkel.Skeleton:
    found = UsdSkel.Skeleton.Define(stage, f"/{name}/Skeleton")
    found.CreateJointsAttr(joint_paths(skeleton))
    matrices = [
        [Gf.Matrix4d(1).SetTranslate(Gf.Vec3d(*place.tolist())) for place in places]
        for places in (skeleton.heads, skeleton.offsets())
    ]
    found.CreateBindTransformsAttr(Vt.Matrix4dArray(matrices[0]))
    found.CreateRestTransformsAttr(Vt.Matrix4dArray(matrices[1]))
    UsdSkel.BindingAPI.Apply(found.GetPrim())
    return found


def _add_mesh(stage: Usd.Stage, mesh: SkinnedMesh, name: str, skeleton: UsdSkel.Skeleton) -> UsdGeom.Mesh:
    shape = UsdGeom.Mesh.Define(stage, f"/{name}/Mesh")
    shape.CreatePointsAttr(Vt.Vec3fArray.FromNumpy(mesh.vertices.astype(np.float32)))
    shape.CreateFaceVertexCountsAttr(Vt.IntArray(len(mesh.triangles), 3))
    shape.CreateFaceVertexIndicesAttr(Vt.IntArray.FromNumpy(mesh.triangles.astype(np.int32).ravel()))
    shape.CreateSubdivisionSchemeAttr(UsdGeom.Tokens.none)
    shape.CreateDoubleSidedAttr(False)
    shape.CreateNormalsAttr(Vt.Vec3fArray.FromNumpy(seamless_normals(mesh)))
    shape.SetNormalsInterpolation(UsdGeom.Tokens.vertex)
    low, high = mesh.vertices.min(0), mesh.vertices.max(0)
    shape.CreateExtentAttr([Gf.Vec3f(*low.tolist()), Gf.Vec3f(*high.tolist())])
    uv = UsdGeom.PrimvarsAPI(shape).CreatePrimvar("st", Sdf.ValueTypeNames.TexCoord2fArray, UsdGeom.Tokens.vertex)
    # USD's texture coordinates begin at the lower left corner
    flipped = np.stack([mesh.uv[:, 0], 1 - mesh.uv[:, 1]], 1).astype(np.float32)
    uv.Set(Vt.Vec2fArray.FromNumpy(np.ascontiguousarray(flipped)))
    joints, weights = quantise_influences(mesh.bones, mesh.weights)
    binding = UsdSkel.BindingAPI.Apply(shape.GetPrim())
    binding.CreateSkeletonRel().SetTargets([skeleton.GetPath()])
    binding.CreateJointIndicesPrimvar(False, 4).Set(Vt.IntArray.FromNumpy(joints.astype(np.int32).ravel()))
    binding.CreateJointWeightsPrimvar(False, 4).Set(
        Vt.FloatArray.FromNumpy((weights.astype(np.float64) / FULL_INFLUENCE).astype(np.float32).ravel())
    )
    binding.CreateGeomBindTransformAttr(Gf.Matrix4d(1))
    return shape


def _add_material(stage: Usd.Stage, name: str) -> UsdShade.Material:
    material = UsdShade.Material.Define(stage, f"/{name}/Material")
    shader = UsdShade.Shader.Define(stage, f"/{name}/Material/Surface")
    shader.CreateIdAttr("UsdPreviewSurface")
    shader.CreateInput("roughness", Sdf.ValueTypeNames.Float).Set(0.9)
    shader.CreateInput("metallic", Sdf.ValueTypeNames.Float).Set(0.0)
    reader = UsdShade.Shader.Define(stage, f"/{name}/Material/Coordinates")
    reader.CreateIdAttr("UsdPrimvarReader_float2")
    reader.CreateInput("varname", Sdf.ValueTypeNames.String).Set("st")
    texture = UsdShade.Shader.Define(stage, f"/{name}/Material/Texture")
    texture.CreateIdAttr("UsdUVTexture")
    texture.CreateInput("file", Sdf.ValueTypeNames.Asset).Set("./texture.jpg")
    texture.CreateInput("sourceColorSpace", Sdf.ValueTypeNames.Token).Set("sRGB")
    for side in ("wrapS", "wrapT"):
        texture.CreateInput(side, Sdf.ValueTypeNames.Token).Set("clamp")
    texture.CreateInput("st", Sdf.ValueTypeNames.Float2).ConnectToSource(
        reader.CreateOutput("result", Sdf.ValueTypeNames.Float2)
    )
    shader.CreateInput("diffuseColor", Sdf.ValueTypeNames.Color3f).ConnectToSource(
        texture.CreateOutput("rgb", Sdf.ValueTypeNames.Float3)
    )
    material.CreateSurfaceOutput().ConnectToSource(shader.CreateOutput("surface", Sdf.ValueTypeNames.Token))
    return material
