"""Blendshape targets: sparse displacements of the template's vertices, by name."""

from __future__ import annotations

import zlib
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

METRES_PER_COUNT = 1e-4
"""Metres to one count of `counts`: the sources are written with this precision, so nothing is lost."""


@dataclass(frozen=True)
class Targets:
    """Named displacement fields over the same vertices, stored by the vertices that they move.

    `starts` (N + 1,) int32: target `i` owns the rows `starts[i]:starts[i + 1]` of
    `moved` (R,) uint16, the vertices, and `counts` (R, 3) int16, their displacements in `METRES_PER_COUNT`.
    """

    names: tuple[str, ...]
    starts: NDArray[np.int32]
    moved: NDArray[np.uint16]
    counts: NDArray[np.int16]
    vertex_count: int

    def displacement(self, weights: Mapping[str, float]) -> NDArray[np.float32]:
        """The weighted sum of targets, (V, 3) float32 metres.

        Raises
        ------
        KeyError : no target has that name.
        """
        total = np.zeros((self.vertex_count, 3), np.float32)
        for name, weight in weights.items():
            if weight:
                rows = self._rows(name)
                total[self.moved[rows]] += np.float32(weight * METRES_PER_COUNT) * self.counts[rows]
        return total

    def moves(self, name: str) -> NDArray[np.intp]:
        """The vertices that a target moves."""
        return self.moved[self._rows(name)].astype(np.intp)

    def dense(self, names: tuple[str, ...]) -> NDArray[np.float32]:
        """The named targets as one array, (N, V, 3) float32 metres: for weights that change every frame."""
        return np.stack([self.displacement({name: 1.0}) for name in names])

    def _rows(self, name: str) -> slice:
        try:
            index = self.names.index(name)
        except ValueError:
            raise KeyError(f"the template has no target {name}") from None
        return slice(int(self.starts[index]), int(self.starts[index + 1]))


def gather(
    fields: Mapping[str, tuple[NDArray[np.integer], NDArray[np.floating]]],
    vertex_count: int,
) -> Targets:
    """Pack `{name: (vertices, displacements in metres)}`; displacements are rounded to `METRES_PER_COUNT`."""
    counts = [np.rint(offsets / METRES_PER_COUNT).astype(np.int16).reshape(-1, 3) for _, offsets in fields.values()]
    return Targets(
        names=tuple(fields),
        starts=np.cumsum([0, *(len(c) for c in counts)], dtype=np.int32),
        moved=np.concatenate([vertices for vertices, _ in fields.values()]).astype(np.uint16),
        counts=np.concatenate(counts),
        vertex_count=vertex_count,
    )


def compact(targets: Targets) -> dict[str, NDArray[np.generic]]:
    """The targets as smaller arrays, without loss: vertices as runs of neighbours, and the counts' high bytes, most of
    which say nothing, compressed."""
    steps = np.diff(targets.moved, prepend=np.uint16(0))  # what goes down wraps around, here and back
    runs = np.flatnonzero(steps != 1)
    split = np.ascontiguousarray(targets.counts, "<i2").view(np.uint8).reshape(-1, 2)
    return {
        "names": np.array(targets.names),
        "starts": targets.starts,
        "runs": runs.astype(np.uint32),
        "steps": steps[runs],
        "low": np.ascontiguousarray(split[:, 0]),
        "high": np.frombuffer(zlib.compress(split[:, 1].tobytes()), np.uint8),
    }


def expand(stored: Mapping[str, NDArray[np.generic]], vertex_count: int) -> Targets:
    """The inverse of `compact`."""
    low = stored["low"]
    split = np.empty((len(low), 2), np.uint8)
    split[:, 0] = low
    split[:, 1] = np.frombuffer(zlib.decompress(stored["high"].tobytes()), np.uint8)
    steps = np.ones(len(low) // 3, np.uint16)
    steps[stored["runs"].astype(np.intp)] = stored["steps"]
    return Targets(
        names=tuple(str(name) for name in stored["names"]),
        starts=stored["starts"].astype(np.int32),
        moved=np.cumsum(steps, dtype=np.uint16),
        counts=split.view("<i2").reshape(-1, 3),
        vertex_count=vertex_count,
    )
