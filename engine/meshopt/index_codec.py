"""Sequences of indices as streams of EXT_meshopt_compression: each by its difference to one of the two baselines before.

Specification: Khronos, EXT_meshopt_compression, "Mode 2: indices".
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from engine.compiled import njit
from engine.meshopt.varint import BROKEN_STREAM, MAX_VARINT_BYTES, get_number, put_number, signed, zigzag

INDEX_HEADER = 0xD1
INDEX_TAIL_BYTES = 4
"""Reserved, zeros."""


def encode_indices(indices: NDArray[np.integer]) -> bytes:
    """The stream of any numbers (N,) from 0 to 2^29, small where each is near the one before."""
    out = np.empty(len(indices) * MAX_VARINT_BYTES, np.uint8)
    used = _encode(np.ascontiguousarray(indices, np.int64), out)
    return bytes([INDEX_HEADER]) + out[:used].tobytes() + bytes(INDEX_TAIL_BYTES)


def decode_indices(stream: bytes, count: int) -> NDArray[np.uint32]:
    """(count,) the numbers of a stream. Raises ValueError where it is none of so many."""
    if len(stream) < 1 + count + INDEX_TAIL_BYTES or stream[0] != INDEX_HEADER:
        raise ValueError(f"no stream of {count} indices")
    indices = np.empty(count, np.uint32)
    if not _decode(np.frombuffer(stream, np.uint8)[1:-INDEX_TAIL_BYTES], indices):
        raise ValueError("a stream of indices is broken")
    return indices


@njit(nogil=True)
def _encode(indices: np.ndarray, out: np.ndarray) -> int:
    end = 0
    last = 0
    for index in indices:
        end = put_number(out, end, 2 * zigzag(index - last))  # the lowest bit says which baseline: always the first
        last = index
    return end


@njit(nogil=True)
def _decode(data: np.ndarray, indices: np.ndarray) -> bool:
    baselines = np.zeros(2, np.int64)
    place = 0
    for k in range(len(indices)):
        code, place = get_number(data, place)
        if place == BROKEN_STREAM:
            return False
        baselines[code & 1] += signed(code >> 1)
        indices[k] = baselines[code & 1] & 0xFFFFFFFF
    return place == len(data)
