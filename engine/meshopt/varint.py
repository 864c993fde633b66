"""Whole numbers in as few bytes as they need: seven bits a byte, the lowest first (LEB128), signs in the lowest bit (zigzag).

Specification: Khronos, EXT_meshopt_compression, appendix A.
"""

from __future__ import annotations

import numpy as np

from engine.compiled import njit

MAX_VARINT_BYTES = 5
"""Of a number of 32 bits."""
BROKEN_STREAM = -1


@njit(nogil=True)
def put_number(out: np.ndarray, end: int, number: int) -> int:
    """Write a number from 0 on; where it ends."""
    while number > 127:
        out[end] = (number & 127) | 128
        number >>= 7
        end += 1
    out[end] = number
    return end + 1


@njit(nogil=True)
def get_number(data: np.ndarray, place: int) -> tuple[int, int]:
    """A number, and where it ends: `BROKEN_STREAM` where the data end within it, or it has more than 32 bits."""
    number = 0
    for k in range(MAX_VARINT_BYTES):
        if place + k >= len(data):
            break
        byte = int(data[place + k])
        number |= (byte & 127) << (7 * k)
        if byte < 128:
            return number, place + k + 1 if number < 1 << 32 else BROKEN_STREAM
    return 0, BROKEN_STREAM


@njit(nogil=True)
def zigzag(difference: int) -> int:
    """0, -1, 1, -2 ... as 0, 1, 2, 3 ..."""
    return 2 * difference if difference >= 0 else -2 * difference - 1


@njit(nogil=True)
def signed(code: int) -> int:
    """The inverse of `zigzag`."""
    return -(code >> 1) - 1 if code & 1 else code >> 1
