"""glTF files for reading: their parts and the numbers in them, sizes checked first."""

from __future__ import annotations

import base64
import binascii
import json
import re
import struct
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from engine.errors import InputError
from engine.motion.source_motion import MAX_BYTES, MAX_NUMBERS

MAX_JSON = 8 << 20
"""Bytes of a file's JSON beside the buffers in it."""

MAX_NODES = 20_000
"""Nodes of all that a file shows; its skeleton may have far fewer."""

MAX_SKIN_JOINTS = 65_536
"""Joints that all skins name, together: a character of a hundred parts names each of its joints a hundred times."""

MAX_ANIMATIONS = 4096

MAX_CHANNELS = 65_536
"""Of all animations together."""

MOST_READ = 4 * MAX_NUMBERS
"""Numbers that a file may have read in all: many accessors can point to the same bytes."""

_TYPES = {5120: np.int8, 5121: np.uint8, 5122: np.int16, 5123: np.uint16, 5125: np.uint32, 5126: np.float32}
_WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT4": 16}
_MAGIC = b"glTF"
_BUFFER = re.compile(rb'"data:[^"\\]*"')


def begins_as_gltf(head: bytes) -> bool:
    """Whether a file with these first bytes (64 are enough) is a GLB, or JSON, as glTF is."""
    return head[:4] == _MAGIC or head[:64].removeprefix(b"\xef\xbb\xbf").lstrip().startswith(b"{")


def unreadable(why: str) -> InputError:
    """The error for files that break glTF's rules."""
    return InputError("motion_unreadable", f"The glTF file cannot be read ({why}): export it again.")


class Part(dict[str, Any]):
    """An object of the file's JSON; what it does not have is None."""

    __slots__ = ()

    def __getattr__(self, name: str) -> Any:
        return self.get(name)


class GltfFile:
    """A glTF file and its buffers: `parts` is its JSON, in which nodes, skins and animations are checked to be what they
    should be.

    Read without `pygltflib`, which takes a second for an ordinary character and minutes for a hostile one.
    """

    def __init__(self, source: Path | bytes):
        """Read a GLB, or a glTF file whose buffers lie in itself.

        Raises
        ------
        InputError : `motion_unreadable`, `motion_too_large`.
        """
        text, self._binary = _read(source)
        try:
            self.parts: Part = json.loads(text, object_hook=Part)
        except (ValueError, RecursionError) as error:
            raise unreadable("its structure is broken") from error
        if not _well_formed(self.parts):
            raise unreadable("its structure is broken")
        _require_few(self.parts)
        self._buffers: dict[int, bytes] = {}
        self._read = 0

    def numbers(self, accessor: int | None) -> NDArray[np.float64]:
        """(count, width) the numbers of an accessor; integers that stand for fractions become these.

        Raises
        ------
        InputError : `motion_unreadable`, `motion_too_large`, `motion_not_finite`.
        """
        try:
            part = self.parts.accessors[accessor]
            view = self.parts.bufferViews[part.bufferView]
            width, kind = _WIDTHS[part.type], np.dtype(_TYPES[part.componentType]).newbyteorder("<")
            count = int(part.count)
            if part.sparse is not None or count < 0:
                raise unreadable("it has sparse accessors")
            row = width * kind.itemsize
            stride = view.byteStride or row
            start = (view.byteOffset or 0) + (part.byteOffset or 0)
            data = self._buffer(view.buffer)
            if count == 0 or start < 0 or stride < row or start + stride * (count - 1) + row > len(data):
                raise unreadable("an accessor points outside its buffer")
            self._read += count * width
            if self._read > MOST_READ:
                raise InputError("motion_too_large", "The glTF file has too many keys: cut the recording.")
            table = np.ndarray((count, width), kind, data, start, (stride, kind.itemsize)).astype(np.float64)
        except (TypeError, KeyError, IndexError, ValueError) as error:
            raise unreadable("an accessor is broken") from error
        if part.normalized and kind.kind != "f":
            table = np.maximum(table / (2.0 ** (8 * kind.itemsize - (kind.kind == "i")) - 1), -1.0)
        if not np.isfinite(table).all():
            raise InputError("motion_not_finite", "The glTF file holds numbers that are not finite: export it again.")
        return table

    def _buffer(self, index: int) -> bytes:
        if index not in self._buffers:
            uri = self.parts.buffers[index].uri
            if uri is None:
                data = self._binary
            elif isinstance(uri, str) and uri.startswith("data:"):
                try:
                    data = base64.b64decode(uri.partition(",")[2], validate=True)
                except binascii.Error as error:
                    raise unreadable("a buffer is broken") from error
            else:
                raise InputError(
                    "motion_unreadable", "The glTF file's numbers lie in another file: export it as one GLB file."
                )
            self._buffers[index] = data
        return self._buffers[index]


def _well_formed(parts: Any) -> bool:
    """Whether the lists that are read hold what they should."""
    if not isinstance(parts, Part):
        return False
    lists = ("nodes", "skins", "animations", "accessors", "bufferViews", "buffers")
    if not all(_list_of(Part, parts.get(key, [])) for key in lists):
        return False
    return (
        all(_list_of(int, node.get("children", [])) for node in parts.get("nodes", []))
        and all(_list_of(int, skin.joints) for skin in parts.get("skins", []))
        and all(_is_animation(animation) for animation in parts.get("animations", []))
    )


def _require_few(parts: Part) -> None:
    """Looked at before anything is walked."""
    animations, skins = parts.animations or [], parts.skins or []
    if len(parts.nodes or []) > MAX_NODES:
        raise InputError(
            "motion_too_large", f"The glTF file has more than {MAX_NODES} nodes: export the skeleton alone."
        )
    if sum(len(skin.joints) for skin in skins) > MAX_SKIN_JOINTS:
        raise InputError("motion_too_large", "The glTF file's skins have too many joints: export the skeleton alone.")
    if len(animations) > MAX_ANIMATIONS or sum(len(a.channels) for a in animations) > MAX_CHANNELS:
        raise InputError("motion_too_large", "The glTF file has too many animations: export the one that is meant.")


def _is_animation(animation: Part) -> bool:
    if not (_list_of(Part, animation.channels) and _list_of(Part, animation.samplers)):
        return False
    targets = [channel.target for channel in animation.channels]
    return _list_of(Part, targets) and all(
        isinstance(target.path, str) and isinstance(target.node, int | None) for target in targets
    )


def _list_of(kind: type, value: Any) -> bool:
    return isinstance(value, list) and all(isinstance(item, kind) for item in value)


def _read(source: Path | bytes) -> tuple[bytes, bytes]:
    """The JSON, and the binary part of a GLB."""
    size = source.stat().st_size if isinstance(source, Path) else len(source)
    if size > MAX_BYTES:
        raise InputError("motion_too_large", f"A motion file can have {MAX_BYTES >> 20} MB: cut the recording.")
    data = source.read_bytes() if isinstance(source, Path) else source
    if not begins_as_gltf(data):
        raise unreadable("it is neither GLB nor glTF")
    if data[:4] != _MAGIC:
        _require_few_parts(len(data) - sum(len(found.group()) for found in _BUFFER.finditer(data)))
        return data, b""
    if len(data) < 20:
        raise unreadable("it breaks off")
    version, length, first = struct.unpack_from("<III", data, 4)
    if version != 2 or length > len(data) or first > len(data) - 20:
        raise unreadable("it breaks off")
    _require_few_parts(first)
    return data[20 : 20 + first], data[28 + first :]


def _require_few_parts(size: int) -> None:
    if size > MAX_JSON:
        raise InputError("motion_too_large", "The glTF file describes too many parts: export the skeleton alone.")
