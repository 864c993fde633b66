"""A picture with a face in it."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Self

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True)
class PicturedFace:
    """rgb : (h, w, 3) uint8.
    mesh : (478, 3) float32, pixels of it.
    """

    rgb: NDArray[np.uint8]
    mesh: NDArray[np.float32]

    def cut(self, low: NDArray[np.integer], high: NDArray[np.integer]) -> Self:
        """The part from the pixel `low` (x, y) up to `high`, which is the first beyond it."""
        mesh = self.mesh.copy()
        mesh[:, :2] -= low
        return replace(self, rgb=np.ascontiguousarray(self.rgb[low[1] : high[1], low[0] : high[0]]), mesh=mesh)
