"""A shape that a mesh can be moved towards: an expression of a face, the form of a mouth as it says a sound."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True)
class MorphTarget:
    """Where some vertices of a mesh go when the target called `name` is at one.

    `moved` (M,) int: vertices, in rising order, none twice. `offsets` (M, 3) float32: their displacements at rest, metres.
    """

    name: str
    moved: NDArray[np.integer]
    offsets: NDArray[np.float32]

    def dense(self, count: int) -> NDArray[np.float32]:
        """The displacements of all `count` vertices, (V, 3) float32."""
        out = np.zeros((count, 3), np.float32)
        out[self.moved] = self.offsets
        return out


def morph_target(name: str, offsets: NDArray[np.floating], least: float = 1e-6) -> MorphTarget:
    """The target that displaces vertices by `offsets` (V, 3) metres, those aside that move by less than `least`."""
    moved = np.flatnonzero(np.linalg.norm(offsets, axis=1) >= least)
    return MorphTarget(name, moved, np.asarray(offsets[moved], np.float32))


@dataclass(frozen=True)
class MorphTrack:
    """How far morph targets go over time: `weights` (F, M) float32, for each frame those of the targets `names`."""

    names: tuple[str, ...]
    weights: NDArray[np.float32]

    def __post_init__(self) -> None:
        if self.weights.ndim != 2 or self.weights.shape[1] != len(self.names):
            raise ValueError(f"{len(self.names)} morph targets have weights of shape {self.weights.shape}")

    def of(self, names: Sequence[str]) -> NDArray[np.float32]:
        """The weights (F, N) of the targets `names`, in this order: 0 of those that the track does not name."""
        out = np.zeros((len(self.weights), len(names)), np.float32)
        for column, name in enumerate(names):
            if name in self.names:
                out[:, column] = self.weights[:, self.names.index(name)]
        return out


def morphed(
    vertices: NDArray[np.float32], morphs: Sequence[MorphTarget], weights: NDArray[np.floating]
) -> NDArray[np.float32]:
    """The vertices (V, 3) at rest, each target as far as its weight (M,) says."""
    out = vertices.copy()
    for morph, weight in zip(morphs, weights, strict=True):
        if weight:
            out[morph.moved] += np.float32(weight) * morph.offsets
    return out
