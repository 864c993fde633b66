"""Filters of EXT_meshopt_compression, by which numbers differ in fewer bytes from row to row.

Specification: Khronos, EXT_meshopt_compression, appendix B.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

MANTISSA_BITS = 24


def encode_exponential(numbers: NDArray[np.floating], exponent: int) -> NDArray[np.int32]:
    """Words of the filter for numbers, of the same shape: each the nearest multiple of 2 to the power of `exponent`.

    Raises ValueError where a number is too large for it: 2^(23 + exponent) or more.
    """
    whole = np.rint(np.asarray(numbers, np.float64) * 2.0**-exponent)
    if np.abs(whole).max(initial=0) >= 1 << (MANTISSA_BITS - 1):
        raise ValueError(f"a number is too large for steps of 2^{exponent}")
    mantissa = whole.astype(np.int64) & ((1 << MANTISSA_BITS) - 1)
    return (mantissa | (exponent & 0xFF) << MANTISSA_BITS).astype(np.uint32).view(np.int32)


def rounded(numbers: NDArray[np.floating], exponent: int) -> NDArray[np.float64]:
    """What a decoder makes of numbers that are encoded so."""
    return np.asarray(np.rint(np.asarray(numbers, np.float64) * 2.0**-exponent) * 2.0**exponent)


def decode_exponential(words: NDArray[np.int32]) -> NDArray[np.float32]:
    """Floating-point numbers of words: a whole number of 24 bits times a power of two, both signed (filter 3)."""
    with np.errstate(over="ignore"):
        return np.ldexp(((words << 8) >> 8).astype(np.float32), words >> MANTISSA_BITS)


def decode_octahedral(rows: NDArray[np.signedinteger]) -> NDArray[np.signedinteger]:
    """(N, 4) unit vectors as normalised integers, and a fourth number as it is (filter 1). The `rows`, of the same
    type, 8 or 16 bits, hold places on an octahedron and what is 1 among them."""
    one = np.where(rows[:, 2] == 0, 1, rows[:, 2]).astype(np.float64)
    x, y = rows[:, 0] / one, rows[:, 1] / one
    z = 1 - np.abs(x) - np.abs(y)
    below = np.minimum(z, 0)
    x, y = x - np.copysign(below, x), y - np.copysign(below, y)
    vectors = np.stack([x, y, z], 1)
    vectors /= np.linalg.norm(vectors, axis=1, keepdims=True)
    return np.column_stack([_normalised(vectors, rows.dtype), rows[:, 3]])


def decode_quaternions(rows: NDArray[np.int16]) -> NDArray[np.int16]:
    """(N, 4) unit quaternions as normalised integers; of `rows` with the three smaller components, and what is 1 among them with
    the number of the largest in its lowest bits (filter 2)."""
    largest = rows[:, 3] & 3
    smaller = rows[:, :3] / ((rows[:, 3] | 3).astype(np.float64)[:, None] * np.sqrt(2))
    w = np.sqrt(np.maximum(1 - (smaller**2).sum(1), 0))
    places = (largest[:, None] + np.arange(1, 5)) % 4
    found = np.empty(rows.shape, rows.dtype)
    np.put_along_axis(found, places, _normalised(np.column_stack([smaller, w]), rows.dtype), 1)
    return found


def _normalised(values: NDArray[np.float64], kind: np.dtype[Any]) -> NDArray[Any]:
    most = np.iinfo(kind).max
    return np.asarray(np.rint(np.clip(values, -1, 1) * most), kind)
