"""Memory that is free: kept by one short command until it ends, given back by what runs for long."""

from __future__ import annotations

import ctypes

TRIM_THRESHOLD, MMAP_THRESHOLD, ARENA_MAX = -1, -3, -8
"""What `mallopt` of the GNU C library calls M_...; other libraries have none, or do nothing."""
MAX_MMAP_BYTES = 32 << 20
"""Bytes from which an array is given back at once; the library allows no more."""


def keep_memory() -> None:
    """Let arrays take the place of arrays that are gone. By default each large one is given back to the system, and the
    next one's pages are asked for and cleared one by one. That happens a hundred thousand times for a clip of three
    seconds."""
    mallopt = getattr(ctypes.CDLL(None), "mallopt", None)
    if mallopt is not None:
        mallopt(ARENA_MAX, 1)
        mallopt(MMAP_THRESHOLD, MAX_MMAP_BYTES)
        mallopt(TRIM_THRESHOLD, 1 << 30)


def give_back_memory() -> None:
    """Hand what is free to the system. Each thread allocates in a part of its own, and in each something small may hold back
    what was large: over a long clip, by tens of megabytes."""
    trim = getattr(ctypes.CDLL(None), "malloc_trim", None)
    if trim is not None:
        trim(0)
