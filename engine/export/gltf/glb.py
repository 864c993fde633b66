"""Characters out as GLB (glTF 2.0): one skinned mesh, its materials and morph targets, the clips as animations.

The skeleton binds in T-pose and its nodes carry the Mixamo names, so that Unity, Unreal, Godot, Blender, three.js and
model-viewer can play its clips and give it others. Specification: Khronos, glTF 2.0 (ISO/IEC 12113), section numbers
in the comments.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Literal

import cv2
import numpy as np
import pygltflib as gl
from numpy.typing import NDArray

from engine.export.gltf.animations import add_animation, add_expressions
from engine.export.gltf.buffer import Buffer
from engine.export.gltf.joints import add_skeleton
from engine.export.gltf.materials import Material, add_materials
from engine.export.gltf.meshopt_compression import compressed
from engine.export.gltf.morphs import add_morphs
from engine.export.influences import quantise_influences
from engine.export.synthetic import SOURCE_TYPE, SYNTHETIC_STATEMENT, marked_jpeg
from engine.geometry.mesh.welding import seamless_normals
from engine.geometry.rigging.joint_axes import mixamo_axes
from engine.geometry.rigging.morph_target import MorphTarget, MorphTrack
from engine.geometry.rigging.skinned_mesh import SkinnedMesh
from engine.motion.clip import Clip

DETAIL_COVERAGE_RATIO = 0.5
"""Each level of detail takes over where the character fills this share less of the screen than the one before."""

TEXTURE_JPEG_QUALITY = 95
"""Of a texture's JPEG, 1 to 100: a finely patterned dress loses 0.5 dB by it, 1.2 dB at 90, and files are a tenth smaller there."""
TEXTURE_REDUCTIONS = ((1, 90), (1, 80), (1, 70), (2, 90), (2, 75), (4, 80))
"""How a texture is written where it makes a file too large, the mildest first: by how much smaller, and the JPEG's quality."""
SKIN_MATERIALS = (Material("skin"),)
"""What a mesh is made of where nothing else is said: of its own texture."""
MAX_PADDING_BYTES = 3
"""Bytes after a file within a GLB, at most: what follows begins at a multiple of four."""


@dataclass(frozen=True)
class WrittenGlb:
    """A file of `size` bytes, whose texture is so many times `smaller` than the mesh's, a JPEG of this `quality`."""

    size: int
    smaller: int
    quality: int


@dataclass(frozen=True)
class CharacterModel:
    """A character as its file shows it.

    Parts that do not fit each other raise ValueError where they are written: clips or levels another skeleton than the
    mesh, morph targets or materials another mesh, or two of one kind with one name.
    """

    mesh: SkinnedMesh
    clips: Sequence[Clip] = ()
    """Become animations of the same names. Joints that never leave the T-pose are left out of an animation. One that
    loops says so in its `extras` (`{"loops": true}`), and ends on its first frame again (moved on, where it travels). A
    clip of one frame is held for a second."""
    unlit: bool = True
    """The texture shows the light of its picture: ask viewers to add none (`KHR_materials_unlit`, not required)."""
    levels: Sequence[SkinnedMesh] = ()
    """Coarser meshes for the same skeleton, finest first (`MSFT_lod`): viewers that know no levels of detail show `mesh`.
    Their textures are not used, and they have no morph targets."""
    morphs: Sequence[MorphTarget] = ()
    """Shapes of `mesh`; their names stand in the mesh's `extras.targetNames`, where viewers look for them. With normals of
    their own unless the character is `unlit`."""
    expressions: Mapping[str, MorphTrack] = field(default_factory=dict)
    """What the morph targets do during clips, by the clips' names: as many frames as the clip has, at its rate."""
    materials: Sequence[Material] = SKIN_MATERIALS
    """What the mesh is made of."""
    material_of: NDArray[np.integer] | None = None
    """(T,) which of the materials each triangle has, where there are several."""
    mixamo: bool = False
    """Built as Mixamo's and Ready Player Me's characters are. Joints have their axes
    (`engine.geometry.rigging.joint_axes`), so that motions and poses made for those fit. The meshes are within
    `Armature`, where players of avatars look for them."""


def write_glb(
    path: Path,
    model: CharacterModel,
    *,
    name: str = "character",
    quality: int = TEXTURE_JPEG_QUALITY,
    synthetic: bool = True,
    most: int | None = None,
    compression: Literal["none", "meshopt"] = "none",
    check: Callable[[], None] = lambda: None,
) -> WrittenGlb:
    """Write a character; the file appears under its name when it is whole.

    Parameters
    ----------
    quality : of the texture, a JPEG (1 to 100).
    synthetic : whether the file says of itself that it is synthetic (`engine.export.synthetic`).
    most : bytes that the file should have at most, levels included: its texture is written as mildly `TEXTURE_REDUCTIONS`
        as that takes. Where no texture is small enough it stays as it is, and the file is larger.
    compression : of geometry and animations, which readers must know (`engine.export.gltf.meshopt_compression`).
    check : called before each of these textures is packed; what it raises ends that, and no file is left.

    Raises ValueError where the parts of the model do not fit each other.
    """
    mesh = model.mesh

    def with_texture(texture: bytes) -> bytes:
        gltf = build_glb(model, texture, name=name, synthetic=synthetic)
        data = b"".join(gltf.save_to_bytes())
        return compressed(data) if compression == "meshopt" else data

    how, texture = (1, quality), jpeg(mesh.texture, quality, synthetic)
    data = with_texture(texture)
    rest = len(data) - len(texture) + MAX_PADDING_BYTES  # no more with a smaller one: numbers have no more digits
    if most is not None and rest < most < len(data):
        for smaller, lower in TEXTURE_REDUCTIONS:
            check()
            texture = jpeg(_reduced(mesh.texture, smaller), lower, synthetic)
            if rest + len(texture) <= most:
                how, data = (smaller, lower), with_texture(texture)
                break
    save_glb(path, data)
    return WrittenGlb(len(data), *how)


def save_glb(path: Path, data: bytes) -> None:
    """Write a file that appears under its name when it is whole."""
    draft = path.with_name(f".{path.name}.draft")
    try:
        draft.write_bytes(data)
        draft.replace(path)
    finally:
        draft.unlink(missing_ok=True)


def _reduced(texture: NDArray[np.uint8], smaller: int) -> NDArray[np.uint8]:
    """The texture so many times smaller; what lies where on it stays so."""
    if smaller == 1:
        return texture
    size = (max(1, texture.shape[1] // smaller), max(1, texture.shape[0] // smaller))
    return np.asarray(cv2.resize(texture, size, interpolation=cv2.INTER_AREA), np.uint8)


def build_glb(model: CharacterModel, texture: bytes, *, name: str = "character", synthetic: bool = True) -> gl.GLTF2:
    """The file as an object, for formats that are GLB with additions (`engine.export.gltf.vrm`). `texture`: as `jpeg`.

    Node `j` is joint `j` of the skeleton; then come the root of all joints and the meshes.
    """
    if len({clip.name for clip in model.clips}) < len(model.clips):
        raise ValueError("two clips have the same name")
    mesh, skeleton = model.mesh, model.mesh.skeleton
    gltf = gl.GLTF2(asset=gl.Asset(version="2.0", generator="Galatea"))
    if synthetic:
        gltf.asset.extras = {"comment": SYNTHETIC_STATEMENT, "digitalSourceType": SOURCE_TYPE}
    buffer = Buffer(gltf)
    axes = mixamo_axes(skeleton) if model.mixamo else None
    add_skeleton(gltf, buffer, skeleton, axes)
    add_materials(
        gltf, buffer, texture, model.unlit, model.materials, lambda other: jpeg(other, TEXTURE_JPEG_QUALITY, synthetic)
    )
    parts = _parts(mesh, len(model.materials), model.material_of)
    if model.levels and len(model.materials) > 1:
        raise ValueError("levels of detail have one material")
    shown = [_add_mesh(gltf, buffer, mesh, name, parts, model.morphs, not model.unlit)]
    shown += [
        _add_mesh(gltf, buffer, each, f"{name}_lod{level}", [np.arange(len(each.triangles))])
        for level, each in enumerate(model.levels, 1)
    ]
    if model.levels:
        _add_levels(gltf, shown)
    if unknown := set(model.expressions) - {clip.name for clip in model.clips}:
        raise ValueError(f"expressions of clips that are not there: {', '.join(sorted(unknown))}")
    for clip in model.clips:
        add_animation(gltf, buffer, clip, skeleton, axes)
        if clip.name in model.expressions:
            add_expressions(
                gltf, buffer, clip, model.expressions[clip.name].of([m.name for m in model.morphs]), shown[0]
            )
    root = len(skeleton.names)
    # a skinned mesh is a root: its node's place does not count (3.7.3.3), and some engines warn about parents
    gltf.scenes = [gl.Scene(name=name, nodes=[root] if model.mixamo else [root, shown[0]])]
    if model.mixamo:
        gltf.nodes[root].children.append(shown[0])
    gltf.scene = 0
    buffer.finish()
    return gltf


def _parts(mesh: SkinnedMesh, materials: int, material_of: NDArray[np.integer] | None) -> list[NDArray[np.intp]]:
    """The triangles of each material."""
    if material_of is None:
        if materials != 1:
            raise ValueError("several materials: say which each triangle has")
        return [np.arange(len(mesh.triangles))]
    if material_of.shape != (len(mesh.triangles),) or len(np.setdiff1d(material_of, np.arange(materials))):
        raise ValueError("a triangle has a material that is not there")
    return [np.flatnonzero(material_of == material) for material in range(materials)]


def jpeg(texture: NDArray[np.uint8], quality: int, synthetic: bool) -> bytes:
    """A texture as JPEG, its colours at full resolution: neighbours in an atlas must not bleed into each other."""
    settings = [cv2.IMWRITE_JPEG_QUALITY, quality, cv2.IMWRITE_JPEG_OPTIMIZE, 1]
    settings += [cv2.IMWRITE_JPEG_SAMPLING_FACTOR, cv2.IMWRITE_JPEG_SAMPLING_FACTOR_444]
    _, packed = cv2.imencode(".jpg", cv2.cvtColor(texture, cv2.COLOR_RGB2BGR), settings)
    return marked_jpeg(packed.tobytes()) if synthetic else packed.tobytes()


def _add_mesh(
    gltf: gl.GLTF2,
    buffer: Buffer,
    mesh: SkinnedMesh,
    name: str,
    parts: Sequence[NDArray[np.intp]],
    morphs: Sequence[MorphTarget] = (),
    shaded: bool = False,
) -> int:
    """The index of the node that shows the mesh, each material's triangles as a primitive over the same vertices."""
    if mesh.skeleton.names != joint_names(gltf):
        raise ValueError("a level of detail has another skeleton")
    joints, weights = quantise_influences(mesh.bones, mesh.weights)
    # the largest number of a type restarts a strip (3.7.2.1)
    narrow = len(mesh.vertices) < np.iinfo(np.uint16).max
    attributes = gl.Attributes(
        POSITION=buffer.add(mesh.vertices.astype(np.float32), gl.ARRAY_BUFFER, bounds=True),
        NORMAL=buffer.add(seamless_normals(mesh), gl.ARRAY_BUFFER),
        TEXCOORD_0=buffer.add(mesh.uv.astype(np.float32), gl.ARRAY_BUFFER),
        JOINTS_0=buffer.add(joints, gl.ARRAY_BUFFER),
        WEIGHTS_0=buffer.add(weights, gl.ARRAY_BUFFER, normalised=True),
    )
    primitives = []
    targets = add_morphs(buffer, mesh, morphs, shaded)
    for material, part in enumerate(parts):
        if not len(part) and len(parts) > 1:
            continue
        indices = mesh.triangles[part].astype(np.uint16 if narrow else np.uint32).ravel()
        primitive = gl.Primitive(
            attributes=attributes,
            indices=buffer.add(indices, gl.ELEMENT_ARRAY_BUFFER),
            material=material,
            mode=gl.TRIANGLES,
            targets=targets,
        )
        primitives.append(primitive)
    shape = gl.Mesh(name=name, primitives=primitives)
    if morphs:
        shape.extras = {"targetNames": [morph.name for morph in morphs]}
        shape.weights = [0.0] * len(morphs)
    gltf.meshes.append(shape)
    gltf.nodes.append(gl.Node(name=name, mesh=len(gltf.meshes) - 1, skin=0))
    return len(gltf.nodes) - 1


def joint_names(gltf: gl.GLTF2) -> tuple[str, ...]:
    """The names of the joints of the first skin."""
    return tuple(gltf.nodes[node].name for node in gltf.skins[0].joints)


def _add_levels(gltf: gl.GLTF2, shown: Sequence[int]) -> None:
    gltf.nodes[shown[0]].extensions = {"MSFT_lod": {"ids": list(shown[1:])}}
    gltf.nodes[shown[0]].extras = {
        "MSFT_screencoverage": [DETAIL_COVERAGE_RATIO ** (k + 1) for k in range(len(shown) - 1)] + [0.0]
    }
    gltf.extensionsUsed = [*(gltf.extensionsUsed or []), "MSFT_lod"]
