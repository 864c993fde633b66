"""Buffer views of glTF files that EXT_meshopt_compression has made smaller.

Specification: Khronos, EXT_meshopt_compression, "JSON schema updates".
"""

from __future__ import annotations

from typing import Any

import numpy as np

from engine.meshopt.attribute_codec import decode_attributes
from engine.meshopt.filters import decode_exponential, decode_octahedral, decode_quaternions
from engine.meshopt.index_codec import decode_indices
from engine.meshopt.triangle_codec import decode_triangles

MESHOPT_EXTENSION = "EXT_meshopt_compression"


def decompressed(stream: bytes, count: int, stride: int, mode: Any, filter_: Any) -> bytes:
    """The `count` elements of `stride` bytes of a stream, by the extension's mode and filter.

    Raises ValueError where the stream is broken, or the extension does not allow these together. Nothing is made of a size
    that the stream cannot hold.
    """
    match mode:
        case "ATTRIBUTES":
            return _filtered(decode_attributes(stream, count, stride), filter_).tobytes()
        case "TRIANGLES" | "INDICES" if stride in (2, 4) and filter_ in (None, "NONE"):
            if mode == "INDICES":
                indices = decode_indices(stream, count)
            elif count % 3 == 0:
                indices = decode_triangles(stream, count // 3)
            else:
                raise ValueError("triangles have three vertices each")
            return indices.astype(f"<u{stride}").tobytes()
    raise ValueError("a view is compressed in no known way")


def _filtered(rows: np.ndarray, filter_: Any) -> np.ndarray:
    match filter_, rows.shape[1]:
        case ((None | "NONE"), _):
            return rows
        case "EXPONENTIAL", _:
            return decode_exponential(rows.view("<i4"))
        case "QUATERNION", 8:
            return decode_quaternions(rows.view("<i2"))
        case "OCTAHEDRAL", (4 | 8) as stride:
            return decode_octahedral(rows.view(f"<i{stride // 4}"))
    raise ValueError("a view is filtered in no known way")
