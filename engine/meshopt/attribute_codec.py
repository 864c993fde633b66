"""Rows of bytes, such as a mesh's vertices, as a stream of EXT_meshopt_compression in mode ATTRIBUTES, version 0.

Each byte of a row is coded by its difference to that of the row before, in groups of sixteen rows, with two, four or
eight bits each. Specification: Khronos, EXT_meshopt_compression, "Mode 0: attributes".
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from engine.compiled import njit
from engine.meshopt.varint import BROKEN_STREAM

ATTRIBUTE_HEADER = 0xA0
ROWS_PER_GROUP = 16
"""Rows that are coded together."""
BLOCK_BYTES, BLOCK_ROWS = 8192, 256
"""A block has as many whole groups as fit into both."""
ATTRIBUTE_TAIL_BYTES = 32
"""Of what follows the last block, at least: zeros, then the first row."""
MAX_BYTES_PER_STREAM_BYTE = 4 * ROWS_PER_GROUP
"""Bytes that a byte of a stream can stand for: four groups without a difference."""


def encode_attributes(rows: NDArray[np.uint8]) -> bytes:
    """The stream of rows (N, S) of S bytes, where S is a multiple of four up to 256.

    Raises ValueError where there is no row, or S is another number.
    """
    count, stride = rows.shape
    if not count or stride % 4 or not 0 < stride <= 256:
        raise ValueError(f"{count} rows of {stride} bytes cannot be coded: rows have 4, 8 ... 256 bytes")
    room = np.empty(1 + 2 * rows.size + count // 4 * stride + 2 * BLOCK_ROWS * stride, np.uint8)
    room[0] = ATTRIBUTE_HEADER
    length = _encode(np.require(rows, requirements=["C", "W"]), _block_rows(stride), room)
    return room[:length].tobytes() + bytes(max(ATTRIBUTE_TAIL_BYTES - stride, 0)) + rows[0].tobytes()


def decode_attributes(stream: bytes, count: int, stride: int) -> NDArray[np.uint8]:
    """(count, stride) the rows of a stream. Raises ValueError where it is none of so many rows of so many bytes."""
    if not count or stride % 4 or not 0 < stride <= 256:
        raise ValueError(f"there is no stream of {count} rows of {stride} bytes")
    data = np.frombuffer(stream, np.uint8)
    tail = len(data) - max(ATTRIBUTE_TAIL_BYTES, stride)
    if tail < 1 or data[0] != ATTRIBUTE_HEADER or count * stride > MAX_BYTES_PER_STREAM_BYTE * (len(data) + BLOCK_ROWS):
        raise ValueError(f"no stream of {count} rows of {stride} bytes")
    rows = np.empty((count, stride), np.uint8)
    if _decode(data[1:tail], data[len(data) - stride :], _block_rows(stride), rows) != tail - 1:
        raise ValueError("a stream of rows is broken")
    return rows


def _block_rows(stride: int) -> int:
    return min(BLOCK_BYTES // stride & ~(ROWS_PER_GROUP - 1), BLOCK_ROWS)


@njit(nogil=True)
def _encode(rows: np.ndarray, block: int, out: np.ndarray) -> int:
    """Write all blocks into `out` after its first byte; where they end."""
    count, stride = rows.shape
    end = 1
    for start in range(0, count, block):
        size = min(block, count - start)
        groups = (size + ROWS_PER_GROUP - 1) // ROWS_PER_GROUP
        codes = np.zeros(groups * ROWS_PER_GROUP, np.uint8)
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
                kind, end = _encode_group(codes[group * ROWS_PER_GROUP : (group + 1) * ROWS_PER_GROUP], out, end)
                out[head + group // 4] |= kind << (group % 4 * 2)
    return end


@njit(nogil=True)
def _encode_group(codes: np.ndarray, out: np.ndarray, end: int) -> tuple[int, int]:
    """Write one group in the shortest of the four ways; which one, and where it ends."""
    small, medium, any_ = ROWS_PER_GROUP // 4, ROWS_PER_GROUP // 2, False
    for k in range(ROWS_PER_GROUP):
        any_ |= codes[k] > 0
        small += codes[k] >= 3
        medium += codes[k] >= 15
    if not any_:
        return 0, end
    if min(small, medium) >= ROWS_PER_GROUP:
        for k in range(ROWS_PER_GROUP):
            out[end + k] = codes[k]
        return 3, end + ROWS_PER_GROUP
    bits = 2 if small <= medium else 4
    escape = (1 << bits) - 1
    each = 8 // bits
    further = end + ROWS_PER_GROUP // each
    for k in range(ROWS_PER_GROUP):
        code = min(codes[k], escape)
        shift = (each - 1 - k % each) * bits
        place = end + k // each
        out[place] = (code << shift) | (out[place] if k % each else 0)
        if code == escape:
            out[further] = codes[k]
            further += 1
    return bits // 2, further


@njit(nogil=True)
def _decode(data: np.ndarray, first: np.ndarray, block: int, rows: np.ndarray) -> int:
    """Read all blocks; where they end, or `BROKEN_STREAM` where the data end before."""
    count, stride = rows.shape
    place = 0
    codes = np.empty(ROWS_PER_GROUP, np.uint8)
    for start in range(0, count, block):
        size = min(block, count - start)
        groups = (size + ROWS_PER_GROUP - 1) // ROWS_PER_GROUP
        for byte in range(stride):
            value = first[byte] if start == 0 else rows[start - 1, byte]
            head = place
            place += (groups + 3) // 4
            if place > len(data):
                return BROKEN_STREAM
            for group in range(groups):
                kind = data[head + group // 4] >> (group % 4 * 2) & 3
                place = _decode_group(data, place, kind, codes)
                if place == BROKEN_STREAM:
                    return BROKEN_STREAM
                for k in range(min(ROWS_PER_GROUP, size - group * ROWS_PER_GROUP)):
                    code = codes[k]
                    value = np.uint8(value + ((code >> 1) ^ (255 if code & 1 else 0)))
                    rows[start + group * ROWS_PER_GROUP + k, byte] = value
    return place


@njit(nogil=True)
def _decode_group(data: np.ndarray, place: int, kind: int, codes: np.ndarray) -> int:
    """Read one group that is coded in one of the four ways; where it ends, or `BROKEN_STREAM`."""
    if kind == 0:
        codes[:] = 0
        return place
    if kind == 3:
        if place + ROWS_PER_GROUP > len(data):
            return BROKEN_STREAM
        for k in range(ROWS_PER_GROUP):
            codes[k] = data[place + k]
        return place + ROWS_PER_GROUP
    bits = 2 * kind
    escape = (1 << bits) - 1
    each = 8 // bits
    further = place + ROWS_PER_GROUP // each
    if further > len(data):
        return BROKEN_STREAM
    for k in range(ROWS_PER_GROUP):
        code = data[place + k // each] >> ((each - 1 - k % each) * bits) & escape
        if code == escape:
            if further == len(data):
                return BROKEN_STREAM
            code = data[further]
            further += 1
        codes[k] = code
    return further
