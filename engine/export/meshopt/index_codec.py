"""Indices as streams of EXT_meshopt_compression: triangles by the edges and vertices that were used last, and sequences.

Specification: Khronos, EXT_meshopt_compression, "Mode 1: triangles" and "Mode 2: indices". The way of triangles is that of
Fabian Giesen (Simple lossless index buffer compression, 2013).
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from engine.compiled import njit

TRIANGLES_HEADER, INDICES_HEADER = 0xE1, 0xD1
RECENT = 16
"""Edges, and vertices, that are remembered."""
EXPLICIT = 15
"""Says that a vertex is told by its difference to the one told last, an edge that none is shared."""
BELOW_LAST, ABOVE_LAST = 13, 14
"""Say that a vertex is next to the one told last."""
FREE_TRIANGLES = (0x00, 0x76, 0x87, 0x56, 0x67, 0x78, 0xA9, 0x86, 0x65, 0x89, 0x68, 0x98, 0x01, 0x69)
"""Pairs of where the second and third vertex of a triangle without a shared edge come from, that one byte tells."""
MAX_NUMBER_BYTES = 5


def encode_triangles(triangles: NDArray[np.integer]) -> bytes:
    """The stream of triangles (T, 3) of vertex numbers. What is decoded has the same triangles in the same order and with the
    same winding; each may begin at another of its vertices."""
    table = np.zeros(RECENT, np.uint8)
    table[: len(FREE_TRIANGLES)] = FREE_TRIANGLES
    codes = np.empty(len(triangles), np.uint8)
    more = np.empty(len(triangles) * (1 + 3 * MAX_NUMBER_BYTES), np.uint8)
    used = _encode_triangles(np.ascontiguousarray(triangles, np.int64), table, codes, more)
    return bytes([TRIANGLES_HEADER]) + codes.tobytes() + more[:used].tobytes() + table.tobytes()


def encode_indices(indices: NDArray[np.integer]) -> bytes:
    """The stream of any numbers (N,) from 0 to 2^29, small where each is near the one before."""
    out = np.empty(len(indices) * MAX_NUMBER_BYTES, np.uint8)
    used = _encode_sequence(np.ascontiguousarray(indices, np.int64), out)
    return bytes([INDICES_HEADER]) + out[:used].tobytes() + bytes(4)


@njit(nogil=True)
def _put_number(out: np.ndarray, end: int, number: int) -> int:
    """Seven bits a byte, the lowest first; where it ends."""
    while number > 127:
        out[end] = (number & 127) | 128
        number >>= 7
        end += 1
    out[end] = number
    return end + 1


@njit(nogil=True)
def _put_difference(out: np.ndarray, end: int, difference: int) -> int:
    return _put_number(out, end, 2 * difference if difference >= 0 else -2 * difference - 1)


@njit(nogil=True)
def _encode_sequence(indices: np.ndarray, out: np.ndarray) -> int:
    end = 0
    last = 0
    for index in indices:
        difference = index - last
        # the lowest bit says to which of two it is the difference: always the first
        end = _put_number(out, end, 2 * (2 * difference if difference >= 0 else -2 * difference - 1))
        last = index
    return end


@njit(nogil=True)
def _age(recent: np.ndarray, place: int, vertex: int) -> int:
    """How many vertices were remembered after this one; -1 where it is forgotten."""
    for age in range(RECENT):
        if recent[(place - 1 - age) % RECENT] == vertex:
            return age
    return -1


@njit(nogil=True)
def _shared_edge(edges: np.ndarray, place: int, triangle: np.ndarray) -> tuple[int, int]:
    """How many edges were remembered after one that this triangle has, and at which of its vertices it begins; -1 for none."""
    for age in range(EXPLICIT):
        edge = edges[(place - 1 - age) % RECENT]
        for first in range(3):
            if edge[0] == triangle[first] and edge[1] == triangle[(first + 1) % 3]:
                return age, first
    return -1, 0


@njit(nogil=True)
def _encode_triangles(triangles: np.ndarray, table: np.ndarray, codes: np.ndarray, out: np.ndarray) -> int:
    edges, vertices = np.full((RECENT, 2), -1, np.int64), np.full(RECENT, -1, np.int64)
    edge_place = vertex_place = end = 0
    new = last = 0  # the number that a vertex not seen before has; the vertex told last
    whence = np.empty(3, np.int64)
    for t in range(len(triangles)):
        age, first = _shared_edge(edges, edge_place, triangles[t])
        if age < 0:  # begin where the new vertex is
            first = 1 if triangles[t, 1] == new else 2 if triangles[t, 2] == new else 0
        a, b, c = triangles[t, first], triangles[t, (first + 1) % 3], triangles[t, (first + 2) % 3]
        if age >= 0:
            known = _age(vertices, vertex_place, c)
            code = known if 1 <= known < BELOW_LAST else EXPLICIT
            if code == EXPLICIT and c == new:
                code = 0
                new += 1
            elif code == EXPLICIT and abs(c - last) == 1:
                code = BELOW_LAST if c < last else ABOVE_LAST
                last = c
            elif code == EXPLICIT:
                end = _put_difference(out, end, c - last)
                last = c
            codes[t] = age << 4 | code
            if code == 0 or code >= BELOW_LAST:
                vertices[vertex_place] = c
                vertex_place = (vertex_place + 1) % RECENT
        else:
            for k, vertex in enumerate((a, b, c)):
                known = _age(vertices, vertex_place, vertex)
                whence[k] = known + 1 if k and 0 <= known < EXPLICIT - 1 else EXPLICIT
                if whence[k] == EXPLICIT and vertex == new:
                    whence[k] = 0
                    new += 1
            both = whence[1] << 4 | whence[2]
            short = -1
            for k in range(len(FREE_TRIANGLES)):
                if whence[0] == 0 and table[k] == both:
                    short = k
                    break
            if short >= 0:
                codes[t] = 0xF0 | short
            else:
                codes[t] = 0xFE | (whence[0] & 1)
                out[end] = both
                end += 1
            for k, vertex in enumerate((a, b, c)):
                if whence[k] == EXPLICIT:
                    end = _put_difference(out, end, vertex - last)
                    last = vertex
                if whence[k] == 0 or whence[k] == EXPLICIT:
                    vertices[vertex_place] = vertex
                    vertex_place = (vertex_place + 1) % RECENT
            edges[edge_place] = b, a
            edge_place = (edge_place + 1) % RECENT
        edges[edge_place] = c, b
        edges[(edge_place + 1) % RECENT] = a, c
        edge_place = (edge_place + 2) % RECENT
    return end
