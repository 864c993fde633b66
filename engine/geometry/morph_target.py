"""A shape that a mesh can be moved towards: an expression of a face, the form of a mouth as it says a sound."""

from __future__ import annotations

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
