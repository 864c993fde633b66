"""A GLB whose geometry and animations are compressed, and its images as they are.

Specification: Khronos, EXT_meshopt_compression. KHR_mesh_quantization is not needed: numbers stay floating-point numbers.
"""

from __future__ import annotations

import json
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from engine.meshopt.attribute_codec import encode_attributes
from engine.meshopt.filters import encode_exponential, rounded
from engine.meshopt.index_codec import encode_indices
from engine.meshopt.triangle_codec import encode_triangles
from engine.motion.files.gltf_accessors import COMPONENT_COUNTS
from engine.motion.files.gltf_compression import MESHOPT_EXTENSION

FLOAT_COMPONENT_TYPE = 5126
COMPONENT_BYTES = {5121: 1, 5123: 2, 5125: 4, FLOAT_COMPONENT_TYPE: 4}

STEP_EXPONENTS = {
    "POSITION": -16,
    "NORMAL": -10,
    "TEXCOORD_0": -16,
    "translation": -16,
    "rotation": -15,
    "weights": -12,
}
"""The power of two of which each kind of number is a multiple afterwards: 0.015 mm, 0.06 degrees, a sixteenth of a texel of a
texture of 4096, 0.004 degrees. What is not named stays as it is to the bit."""

Document = dict[str, Any]


@dataclass
class _Use:
    """What a buffer view holds: elements of `stride` bytes, by `mode`; numbers that are multiples of 2 to the power of
    `step` afterwards, or None."""

    stride: int
    mode: str = "ATTRIBUTES"
    step: int | None = None
    accessors: list[Document] = field(default_factory=list)


def compressed(glb: bytes) -> bytes:
    """A GLB made smaller, for readers that know the extension, which it then requires.

    Triangles may begin at another of their vertices. Raises ValueError for numbers that are too large for `STEP_EXPONENTS`: 128 metres.
    """
    length = int.from_bytes(glb[12:16], "little")
    document: Document = json.loads(glb[20 : 20 + length])
    binary = glb[28 + length :]
    uses = _uses(document)
    data, plain = bytearray(), 0
    for index, view in enumerate(document["bufferViews"]):
        start = view.get("byteOffset", 0)
        raw = binary[start : start + view["byteLength"]]
        use = uses.get(index)
        packed = None if use is None else _packed(raw, use)
        told: Document = {"buffer": 0, "byteOffset": len(data), "byteLength": len(raw)}
        if use is None or packed is None or len(packed) >= len(raw):
            view |= told
            data += raw + bytes(-len(raw) % 4)
            continue
        _settle_bounds(use)
        told |= {"byteLength": len(packed), "byteStride": use.stride, "mode": use.mode}
        told |= {"count": len(raw) // use.stride, "filter": "NONE" if use.step is None else "EXPONENTIAL"}
        view |= {"buffer": 1, "byteOffset": plain, "extensions": {MESHOPT_EXTENSION: told}}
        plain += len(raw) + -len(raw) % 4
        data += packed + bytes(-len(packed) % 4)
    document["buffers"] = [
        {"byteLength": len(data)},
        {"byteLength": plain, "extensions": {MESHOPT_EXTENSION: {"fallback": True}}},
    ]
    for key in ("extensionsUsed", "extensionsRequired"):
        document[key] = [*document.get(key, ()), MESHOPT_EXTENSION]
    return _glb(document, bytes(data))


def _uses(document: Document) -> dict[int, _Use]:
    """What each buffer view is used for that accessors read. Those that several ways of reading share are left out."""
    uses: dict[int, _Use] = {}
    steps, triangles = dict(_steps(document)), set(_triangles(document))
    for number, accessor in enumerate(document["accessors"]):
        stride = COMPONENT_BYTES[accessor["componentType"]] * COMPONENT_COUNTS[accessor["type"]]
        step = steps.get(number) if accessor["componentType"] == FLOAT_COMPONENT_TYPE else None
        if "bufferView" in accessor:
            use = uses.setdefault(accessor["bufferView"], _Use(stride, step=step))
            use.mode = "TRIANGLES" if number in triangles else use.mode
            use.accessors.append(accessor)
            use.step = None if None in (use.step, step) else min(use.step or 0, step or 0)
        if "sparse" in accessor:
            indices, values = accessor["sparse"]["indices"], accessor["sparse"]["values"]
            uses[indices["bufferView"]] = _Use(COMPONENT_BYTES[indices["componentType"]], "INDICES")
            uses[values["bufferView"]] = _Use(stride, step=step, accessors=[accessor])
    return uses


def _steps(document: Document) -> Iterator[tuple[int, int]]:
    """Accessors, and the power of two of their numbers' steps."""
    for mesh in document.get("meshes", ()):
        for primitive in mesh["primitives"]:
            for attributes in (primitive["attributes"], *primitive.get("targets", ())):
                yield from (
                    (number, STEP_EXPONENTS[name]) for name, number in attributes.items() if name in STEP_EXPONENTS
                )
    for animation in document.get("animations", ()):
        for channel in animation["channels"]:
            sampler = animation["samplers"][channel["sampler"]]
            yield sampler["output"], STEP_EXPONENTS[channel["target"]["path"]]


def _triangles(document: Document) -> Iterator[int]:
    for mesh in document.get("meshes", ()):
        yield from (primitive["indices"] for primitive in mesh["primitives"])


def _packed(raw: bytes, use: _Use) -> bytes | None:
    """The stream of a view; None where the codecs do not take it."""
    if use.mode != "ATTRIBUTES":
        indices: NDArray[np.unsignedinteger] = np.frombuffer(raw, f"<u{use.stride}")
        return encode_triangles(indices.reshape(-1, 3)) if use.mode == "TRIANGLES" else encode_indices(indices)
    if use.stride % 4 or not raw or len(raw) % use.stride:
        return None
    words = np.frombuffer(raw, np.uint8)
    if use.step is not None:
        words = encode_exponential(np.frombuffer(raw, "<f4"), use.step).astype("<i4").view(np.uint8)
    return encode_attributes(words.reshape(-1, use.stride))


def _settle_bounds(use: _Use) -> None:
    """State the bounds of numbers as they are afterwards."""
    for accessor in use.accessors:
        for bound in ("min", "max"):
            if use.step is not None and accessor.get(bound) is not None:
                accessor[bound] = rounded(np.array(accessor[bound]), use.step).tolist()


def _glb(document: Document, binary: bytes) -> bytes:
    text = json.dumps(document, separators=(",", ":")).encode()
    text += b" " * (-len(text) % 4)
    size = 28 + len(text) + len(binary)
    head = b"glTF" + (2).to_bytes(4, "little") + size.to_bytes(4, "little")
    chunks = ((text, b"JSON"), (binary, b"BIN\0"))
    return head + b"".join(len(part).to_bytes(4, "little") + kind + part for part, kind in chunks)
