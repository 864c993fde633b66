"""Triangles as streams of EXT_meshopt_compression: by the edges and vertices that were used last.

Specification: Khronos, EXT_meshopt_compression, "Mode 1: triangles"; the way is that of Fabian Giesen (Simple lossless index
buffer compression, 2013).
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from engine.compiled import njit
from engine.meshopt.varint import BROKEN_STREAM, MAX_VARINT_BYTES, get_number, put_number, signed, zigzag

TRIANGLE_HEADER = 0xE1
RECENT_COUNT = 16
"""Edges, and vertices, that are remembered."""
EXPLICIT_CODE = 15
"""Says that a vertex is told by its difference to the one told last, an edge that none is shared."""
BELOW_LAST, ABOVE_LAST = 13, 14
"""Say that a vertex is next to the one told last."""
REMEMBERED_VERTEX = -1
"""Of a vertex that is remembered, and is not remembered anew."""
FREE_TRIANGLES = (0x00, 0x76, 0x87, 0x56, 0x67, 0x78, 0xA9, 0x86, 0x65, 0x89, 0x68, 0x98, 0x01, 0x69)
"""Pairs of where the second and third vertex of a triangle without a shared edge come from, that one byte tells."""
TRIANGLE_TAIL_BYTES = 16
"""Bytes of the table of pairs that one byte tells."""


def encode_triangles(triangles: NDArray[np.integer]) -> bytes:
    """The stream of triangles (T, 3) of vertex numbers. What is decoded has the same triangles in the same order and with the
    same winding; each may begin at another of its vertices."""
    table = np.zeros(RECENT_COUNT, np.uint8)
    table[: len(FREE_TRIANGLES)] = FREE_TRIANGLES
    codes = np.empty(len(triangles), np.uint8)
    more = np.empty(len(triangles) * (1 + 3 * MAX_VARINT_BYTES), np.uint8)
    used = _encode(np.ascontiguousarray(triangles, np.int64), table, codes, more)
    return bytes([TRIANGLE_HEADER]) + codes.tobytes() + more[:used].tobytes() + table.tobytes()


def decode_triangles(stream: bytes, count: int) -> NDArray[np.uint32]:
    """(count, 3) the triangles of a stream. Raises ValueError where it is none of so many, or its tail is broken."""
    if len(stream) < 1 + count + TRIANGLE_TAIL_BYTES or stream[0] != TRIANGLE_HEADER:
        raise ValueError(f"no stream of {count} triangles")
    data = np.frombuffer(stream, np.uint8)
    triangles = np.empty((count, 3), np.uint32)
    if not _decode(data[1 : 1 + count], data[1 + count : -TRIANGLE_TAIL_BYTES], data[-TRIANGLE_TAIL_BYTES:], triangles):
        raise ValueError("a stream of triangles is broken")
    return triangles


@njit(nogil=True)
def _age(recent: np.ndarray, place: int, vertex: int) -> int:
    """How many vertices were remembered after this one; -1 where it is forgotten."""
    for age in range(RECENT_COUNT):
        if recent[(place - 1 - age) % RECENT_COUNT] == vertex:
            return age
    return -1


@njit(nogil=True)
def _shared_edge(edges: np.ndarray, place: int, triangle: np.ndarray) -> tuple[int, int]:
    """How many edges were remembered after one that this triangle has, and at which of its vertices it begins; -1 for none."""
    for age in range(EXPLICIT_CODE):
        edge = edges[(place - 1 - age) % RECENT_COUNT]
        for first in range(3):
            if edge[0] == triangle[first] and edge[1] == triangle[(first + 1) % 3]:
                return age, first
    return -1, 0


@njit(nogil=True)
def _encode(triangles: np.ndarray, table: np.ndarray, codes: np.ndarray, out: np.ndarray) -> int:
    edges, vertices = np.empty((RECENT_COUNT, 2), np.int64), np.empty(RECENT_COUNT, np.int64)
    edges[:], vertices[:] = -1, -1
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
            code = known if 1 <= known < BELOW_LAST else EXPLICIT_CODE
            if code == EXPLICIT_CODE and c == new:
                code = 0
                new += 1
            elif code == EXPLICIT_CODE and abs(c - last) == 1:
                code = BELOW_LAST if c < last else ABOVE_LAST
                last = c
            elif code == EXPLICIT_CODE:
                end = put_number(out, end, zigzag(c - last))
                last = c
            codes[t] = age << 4 | code
            if code == 0 or code >= BELOW_LAST:
                vertices[vertex_place] = c
                vertex_place = (vertex_place + 1) % RECENT_COUNT
        else:
            for k, vertex in enumerate((a, b, c)):
                known = _age(vertices, vertex_place, vertex)
                whence[k] = known + 1 if k and 0 <= known < EXPLICIT_CODE - 1 else EXPLICIT_CODE
                if whence[k] == EXPLICIT_CODE and vertex == new:
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
                if whence[k] == EXPLICIT_CODE:
                    end = put_number(out, end, zigzag(vertex - last))
                    last = vertex
                if whence[k] == 0 or whence[k] == EXPLICIT_CODE:
                    vertices[vertex_place] = vertex
                    vertex_place = (vertex_place + 1) % RECENT_COUNT
            edges[edge_place, 0], edges[edge_place, 1] = b, a
            edge_place = (edge_place + 1) % RECENT_COUNT
        after = (edge_place + 1) % RECENT_COUNT
        edges[edge_place, 0], edges[edge_place, 1], edges[after, 0], edges[after, 1] = c, b, a, c
        edge_place = (edge_place + 2) % RECENT_COUNT
    return end


@njit(nogil=True)
def _decode(codes: np.ndarray, data: np.ndarray, table: np.ndarray, triangles: np.ndarray) -> bool:
    """Read all triangles; whether the data held them and nothing else."""
    edges, vertices = np.zeros((RECENT_COUNT, 2), np.int64), np.zeros(RECENT_COUNT, np.int64)
    edge_place = vertex_place = place = 0
    new = last = 0
    whence, corners = np.empty(3, np.int64), np.empty(3, np.int64)
    for t in range(len(codes)):
        age, code = np.int64(codes[t]) >> 4, np.int64(codes[t]) & 15
        if age < EXPLICIT_CODE:
            edge = edges[(edge_place - 1 - age) % RECENT_COUNT]
            corners[0], corners[1] = edge[0], edge[1]
            whence[0] = whence[1] = REMEMBERED_VERTEX  # both are remembered
            whence[2] = code if code == 0 or code >= BELOW_LAST else REMEMBERED_VERTEX
            if whence[2] == REMEMBERED_VERTEX:
                corners[2] = vertices[(vertex_place - 1 - code) % RECENT_COUNT]
        else:
            both = np.int64(table[code])
            if code >= len(FREE_TRIANGLES):  # no pair of the table: the next byte
                if place >= len(data):
                    return False
                both = np.int64(data[place])
                place += 1
                new = 0 if both == 0 else new
            whence[0] = EXPLICIT_CODE if code == EXPLICIT_CODE else 0
            whence[1], whence[2] = both >> 4, both & 15
            for k in range(1, 3):
                if 0 < whence[k] < EXPLICIT_CODE:
                    corners[k] = vertices[(vertex_place - whence[k]) % RECENT_COUNT]
                    whence[k] = REMEMBERED_VERTEX
        for k in range(3):
            if whence[k] == 0:
                corners[k] = new
                new += 1
            elif whence[k] == EXPLICIT_CODE:
                number, place = get_number(data, place)
                if place == BROKEN_STREAM:
                    return False
                last = (last + signed(number)) & 0xFFFFFFFF
                corners[k] = last
            elif whence[k] != REMEMBERED_VERTEX:
                last = (last + (1 if whence[k] == ABOVE_LAST else -1)) & 0xFFFFFFFF
                corners[k] = last
        a, b, c = corners[0], corners[1], corners[2]
        if age == EXPLICIT_CODE:
            edges[edge_place, 0], edges[edge_place, 1] = b, a
            edge_place = (edge_place + 1) % RECENT_COUNT
        after = (edge_place + 1) % RECENT_COUNT
        edges[edge_place, 0], edges[edge_place, 1], edges[after, 0], edges[after, 1] = c, b, a, c
        edge_place = (edge_place + 2) % RECENT_COUNT
        for k in range(3):
            if whence[k] != REMEMBERED_VERTEX:
                vertices[vertex_place] = corners[k]
                vertex_place = (vertex_place + 1) % RECENT_COUNT
        for k in range(3):
            triangles[t, k] = corners[k]
    return place == len(data)
