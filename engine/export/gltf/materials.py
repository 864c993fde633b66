"""Materials of a glTF mesh: one for all of it, or one for each of its parts, as skin, eyes and teeth.

Specification: Khronos, glTF 2.0, 3.9 (materials); KHR_materials_unlit; KHR_texture_transform.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, Literal

import cv2
import numpy as np
import pygltflib as gl
from numpy.typing import NDArray

from engine.export.gltf.buffer import Buffer


@dataclass(frozen=True)
class TextureTransform:
    """How places (u, v) of the mesh become places on the texture: times `scale`, turned by `rotation` radians
    counter-clockwise, plus `offset`."""

    offset: tuple[float, float] = (0.0, 0.0)
    rotation: float = 0.0
    scale: tuple[float, float] = (1.0, 1.0)


@dataclass(frozen=True)
class Material:
    """What a part of a mesh is made of.

    texture : (H, W, 3) uint8 sRGB, or (H, W, 4) with alpha; by default the mesh's own.
    colour : red, green, blue (linear) and alpha, each 0 to 1, by which it is multiplied.
    alpha : whether alpha says nothing, cuts at a half, or blends.
    two_sided : seen from behind, too.
    roughness : 0 to 1, for viewers that light it.
    transform : of its places on the texture.
    """

    name: str
    texture: NDArray[np.uint8] | None = None
    colour: tuple[float, float, float, float] = (1.0, 1.0, 1.0, 1.0)
    alpha: Literal["OPAQUE", "MASK", "BLEND"] = "OPAQUE"
    two_sided: bool = False
    roughness: float = 0.9
    transform: TextureTransform | None = None


def add_materials(
    gltf: gl.GLTF2,
    buffer: Buffer,
    texture: bytes,
    unlit: bool,
    materials: Sequence[Material],
    pack: Callable[[NDArray[np.uint8]], bytes],
) -> None:
    """Add materials and their textures. `texture`: the mesh's own, a JPEG; `pack` makes one of another without alpha."""
    _add_texture(gltf, buffer, "texture", texture, "image/jpeg")
    gltf.samplers = [
        gl.Sampler(
            magFilter=gl.LINEAR, minFilter=gl.LINEAR_MIPMAP_LINEAR, wrapS=gl.CLAMP_TO_EDGE, wrapT=gl.CLAMP_TO_EDGE
        )
    ]
    used: set[str] = set()
    for material in materials:
        index = 0
        if material.texture is not None:
            if material.texture.shape[2] == 4:
                index = _add_texture(gltf, buffer, material.name, _png(material.texture), "image/png")
            else:
                index = _add_texture(gltf, buffer, material.name, pack(material.texture), "image/jpeg")
        gltf.materials.append(_material(material, index, unlit, used))
    for name in ("KHR_materials_unlit", "KHR_texture_transform"):
        if name in used:
            gltf.extensionsUsed = [*(gltf.extensionsUsed or []), name]


def _add_texture(gltf: gl.GLTF2, buffer: Buffer, name: str, content: bytes, kind: str) -> int:
    gltf.images.append(gl.Image(name=name, mimeType=kind, bufferView=buffer.add_file(content)))
    gltf.textures.append(gl.Texture(source=len(gltf.images) - 1, sampler=0))
    return len(gltf.textures) - 1


def _material(material: Material, texture: int, unlit: bool, used: set[str]) -> gl.Material:
    info = gl.TextureInfo(index=texture)
    if material.transform is not None:
        said: dict[str, Any] = {"offset": list(material.transform.offset), "scale": list(material.transform.scale)}
        info.extensions = {"KHR_texture_transform": {**said, "rotation": material.transform.rotation}}
        used.add("KHR_texture_transform")
    surface = gl.PbrMetallicRoughness(baseColorTexture=info, metallicFactor=0.0, roughnessFactor=material.roughness)
    if material.colour != (1.0, 1.0, 1.0, 1.0):
        surface.baseColorFactor = list(material.colour)
    found = gl.Material(name=material.name, pbrMetallicRoughness=surface, emissiveFactor=None)
    found.alphaMode, found.doubleSided = material.alpha, material.two_sided
    if unlit:
        found.extensions = {"KHR_materials_unlit": {}}
        used.add("KHR_materials_unlit")
    return found


def _png(texture: NDArray[np.uint8]) -> bytes:
    return cv2.imencode(".png", cv2.cvtColor(texture, cv2.COLOR_RGBA2BGRA))[1].tobytes()
