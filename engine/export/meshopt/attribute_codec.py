"""Rows of bytes, such as a mesh's vertices, as a stream of EXT_meshopt_compression in mode ATTRIBUTES, version 0.

Each byte of a row is coded by its difference to that of the row before, in groups of sixteen rows, with two, four or
eight bits each. Specification: Khronos, EXT_meshopt_compression, "Mode 0: attributes".
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from engine.compiled import njit

HEADER = 0xA0
GROUP = 16
"""Rows that are coded together."""
BLOCK_BYTES, BLOCK_ROWS = 8192, 256
"""A block has as many whole groups as fit into both."""
TAIL_BYTES = 32
"""Of what follows the last block, at least: zeros, then the first row."""


def encode_attributes(rows: NDArray[np.uint8]) -> bytes:
    """The stream of rows (N, S) of S bytes, where S is a multiple of four up to 256.

    Raises ValueError where there is no row, or S is another number.
    """
    count, stride = rows.shape
    if not count or stride % 4 or not 0 < stride <= 256:
        raise ValueError(f"{count} rows of {stride} bytes cannot be coded: rows have 4, 8 ... 256 bytes")
    room = np.empty(1 + 2 * rows.size + count // 4 * stride + 2 * BLOCK_ROWS * stride, np.uint8)
    room[0] = HEADER
    block = min(BLOCK_BYTES // stride & ~(GROUP - 1), BLOCK_ROWS)
    length = _encode(np.ascontiguousarray(rows), block, room)
    return room[:length].tobytes() + bytes(max(TAIL_BYTES - stride, 0)) + rows[0].tobytes()


@njit(nogil=True)
def _encode(rows: np.ndarray, block: int, out: np.ndarray) -> int:
    """Write all blocks into `out` after its first byte; where they end."""
    count, stride = rows.shape
    end = 1
    for start in range(0, count, block):
        size = min(block, count - start)
        groups = (size + GROUP - 1) // GROUP
        codes = np.zeros(groups * GROUP, np.uint8)
        for byte in range(stride):
            before = rows[max(start - 1, 0), byte]
            for row in range(size):
                value = rows[start + row, byte]
                delta = np.int8(np.uint8(value - before))
                codes[row] = np.uint8((delta << 1) ^ (delta >> 7))
                before = value
            head = end
            end += (groups + 3) // 4
            out[head:end] = 0
            for group in range(groups):
                kind, end = _encode_group(codes[group * GROUP : (group + 1) * GROUP], out, end)
                out[head + group // 4] |= kind << (group % 4 * 2)
    return end


@njit(nogil=True)
def _encode_group(codes: np.ndarray, out: np.ndarray, end: int) -> tuple[int, int]:
    """Write one group in the shortest of the four ways; which one, and where it ends."""
    if codes.max() == 0:
        return 0, end
    small, medium = GROUP // 4 + (codes >= 3).sum(), GROUP // 2 + (codes >= 15).sum()
    if min(small, medium) >= GROUP:
        out[end : end + GROUP] = codes
        return 3, end + GROUP
    bits = 2 if small <= medium else 4
    escape = (1 << bits) - 1
    each = 8 // bits
    further = end + GROUP // each
    for k in range(GROUP):
        code = min(codes[k], escape)
        shift = (each - 1 - k % each) * bits
        place = end + k // each
        out[place] = (code << shift) | (out[place] if k % each else 0)
        if code == escape:
            out[further] = codes[k]
            further += 1
    return bits // 2, further
