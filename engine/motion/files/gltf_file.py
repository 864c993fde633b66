"""glTF files for reading: their parts and the bytes in them, sizes checked first."""

from __future__ import annotations

import base64
import binascii
import json
import re
import struct
from collections.abc import Sequence
from pathlib import Path
from typing import Any, cast

from engine.errors import InputError
from engine.motion.files.gltf_compression import MESHOPT_EXTENSION, decompressed
from engine.motion.files.source_motion import MAX_MOTION_BYTES

MAX_JSON_BYTES = 8 << 20
"""Bytes of a file's JSON beside the buffers in it."""

MAX_NODES = 20_000
"""Nodes of all that a file shows; its skeleton may have far fewer."""

MAX_SKIN_JOINTS = 65_536
"""Joints that all skins name, together: a character of a hundred parts names each of its joints a hundred times."""

MAX_ANIMATIONS = 4096
"""Animations of a file."""

MAX_CHANNELS = 65_536
"""Channels of all animations of a file together."""

MAX_DECOMPRESSED_BYTES = 4 * MAX_MOTION_BYTES
"""Of all compressed views together that are read."""

_MAGIC = b"glTF"
_JSON, _BINARY = 0x4E4F534A, 0x004E4942
_DATA_URI = re.compile(rb'"data:[^"\\]*"')


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
            self.parts: Part = json.loads(text.decode("utf-8-sig"), object_hook=Part, parse_constant=_no_number)
        except (ValueError, RecursionError) as error:
            raise unreadable("its structure is broken") from error
        if not _well_formed(self.parts):
            raise unreadable("its structure is broken")
        _require_few(self.parts)
        self._required = frozenset(self.parts.extensionsRequired or ())
        self._buffers: dict[int, bytes] = {}
        self._decompressed: dict[int, bytes] = {}

    def view(self, index: Any) -> tuple[memoryview, Part]:
        """The bytes of a buffer view, which are not copied (thousands of accessors may share a view of 64 MB), and what the
        file says of it. What EXT_meshopt_compression has made smaller is as it was.

        Raises
        ------
        InputError : `motion_unreadable`, `motion_extension`, `motion_too_large`.
        """
        part = self.part("bufferViews", index)
        extensions = part.extensions if isinstance(part.extensions, dict) else {}
        if (
            MESHOPT_EXTENSION not in self._required or MESHOPT_EXTENSION not in extensions
        ):  # the numbers are there, as they were
            return self._bytes(part), part
        if index not in self._decompressed:
            self._decompressed[index] = self._decompress(part, extensions[MESHOPT_EXTENSION])
        return memoryview(self._decompressed[index]), part

    def _bytes(self, part: Part) -> memoryview:
        start, size = natural_number(part.byteOffset, 0), natural_number(part.byteLength)
        data = self._buffer(part.buffer)
        if start + size > len(data):
            raise unreadable("a view reaches beyond its buffer")
        return memoryview(data)[start : start + size]

    def _decompress(self, part: Part, packed: Any) -> bytes:
        if not isinstance(packed, Part):
            raise unreadable("a view's compression is broken")
        count, stride = natural_number(packed.count), natural_number(packed.byteStride)
        if count * stride != natural_number(part.byteLength):
            raise unreadable("a view's compression is broken")
        if count * stride + sum(map(len, self._decompressed.values())) > MAX_DECOMPRESSED_BYTES:
            raise InputError("motion_too_large", "The glTF file's compressed numbers are too many: cut the recording.")
        try:
            return decompressed(bytes(self._bytes(packed)), count, stride, packed.mode, packed.get("filter"))
        except ValueError as broken:
            raise unreadable("a view's compression is broken") from broken

    def part(self, kind: str, index: Any) -> Part:
        """An element of one of the file's lists, of which everything that must be known is known.

        Raises
        ------
        InputError : `motion_unreadable`, `motion_extension`.
        """
        parts = self.parts.get(kind, [])
        if type(index) is not int or not 0 <= index < len(parts):
            raise unreadable(f"one of its {kind} is not there")
        self.require_known(parts[index], (MESHOPT_EXTENSION,) if kind == "bufferViews" else ())
        return cast(Part, parts[index])

    def require_known(self, part: Part, known: Sequence[str] = ()) -> None:
        """Refuse a part which is read, and which an extension changes that a reader must know, and which is not `known`.

        Extensions of other parts, materials or meshes say, are of no concern, whether a reader must know them or not.

        Raises
        ------
        InputError : `motion_extension`.
        """
        for name in part.extensions if isinstance(part.extensions, dict) else ():
            if name in self._required and name not in known:
                raise _extension(name)

    def _buffer(self, index: Any) -> bytes:
        part = self.part("buffers", index)
        if index not in self._buffers:
            uri = part.uri
            if uri is None and index == 0 and self._binary is not None:
                data = self._binary
            elif uri is None:
                raise _extension(next(iter(part.extensions))) if part.extensions else unreadable("a buffer is missing")
            elif isinstance(uri, str) and uri.startswith("data:"):
                try:
                    data = base64.b64decode(uri.partition(",")[2], validate=True)
                except binascii.Error as error:
                    raise unreadable("a buffer is broken") from error
            else:
                raise InputError(
                    "motion_unreadable", "The glTF file's numbers lie in another file: export it as one GLB file."
                )
            size = natural_number(part.byteLength)
            if size > len(data):
                raise unreadable("a buffer is shorter than it says")
            self._buffers[index] = data[:size]
        return self._buffers[index]


def natural_number(value: Any, default: int | None = None) -> int:
    """A whole number from 0 on, as lengths and counts are; the default where none is given.

    Raises
    ------
    InputError : `motion_unreadable`.
    """
    if value is None and default is not None:
        return default
    if type(value) is not int or value < 0:
        raise unreadable("a length or a count is no whole number")
    return value


def _extension(name: str) -> InputError:
    return InputError(
        "motion_extension",
        f"The glTF file keeps its motion by the extension {name[:60]!r}, which is not known here: export it without"
        " compression and other extensions.",
    )


def _well_formed(parts: Any) -> bool:
    """Whether the lists that are read hold what they should."""
    if not isinstance(parts, Part):
        return False
    lists = ("nodes", "skins", "animations", "accessors", "bufferViews", "buffers")
    if not all(_list_of(Part, parts.get(key, [])) for key in lists):
        return False
    if not _list_of(str, parts.get("extensionsRequired", [])):
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
        isinstance(target.path, str) and (target.node is None or type(target.node) is int) for target in targets
    )


def _list_of(kind: type, value: Any) -> bool:
    return isinstance(value, list) and all(type(item) is kind for item in value)


def _no_number(word: str) -> float:
    raise ValueError(f"{word} is not JSON")


def _read(source: Path | bytes) -> tuple[bytes, bytes | None]:
    """The JSON, and the binary part of a GLB that has one."""
    size = source.stat().st_size if isinstance(source, Path) else len(source)
    if size > MAX_MOTION_BYTES:
        raise InputError("motion_too_large", f"A motion file can have {MAX_MOTION_BYTES >> 20} MB: cut the recording.")
    data = source.read_bytes() if isinstance(source, Path) else source
    if not begins_as_gltf(data):
        raise unreadable("it is neither GLB nor glTF")
    if data[:4] != _MAGIC:
        _require_few_parts(len(data) - sum(len(found.group()) for found in _DATA_URI.finditer(data)))
        return data, None
    if len(data) < 20:
        raise unreadable("it breaks off")
    version, length = struct.unpack_from("<II", data, 4)
    if version != 2 or length > len(data):
        raise unreadable("it breaks off")
    text, kind, place = _chunk(data, 12, length)
    if kind != _JSON:
        raise unreadable("its structure is broken")
    _require_few_parts(len(text))
    if place + 8 > length:
        return text, None
    binary, kind, _ = _chunk(data, place, length)
    return text, binary if kind == _BINARY else None


def _chunk(data: bytes, place: int, length: int) -> tuple[bytes, int, int]:
    """A GLB's chunk, of which kind it is, and where the next one begins."""
    size, kind = struct.unpack_from("<II", data, place) if place + 8 <= length else (length, 0)
    begin = place + 8
    if begin + size > length:
        raise unreadable("it breaks off")
    return data[begin : begin + size], kind, begin + size


def _require_few_parts(size: int) -> None:
    if size > MAX_JSON_BYTES:
        raise InputError("motion_too_large", "The glTF file describes too many parts: export the skeleton alone.")
