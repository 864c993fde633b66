"""A photograph that is kept of a collection, with the face in it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True)
class FacePhoto:
    """rgb : (h, w, 3) uint8. mesh : (478, 3) float32, pixels of it. number : which of the persona's photographs it is."""

    rgb: NDArray[np.uint8]
    mesh: NDArray[np.float32]
    number: int

    def cut(self, low: NDArray[np.integer], high: NDArray[np.integer]) -> FacePhoto:
        """The part from the pixel `low` (x, y) up to `high`, which is the first beyond it."""
        mesh = self.mesh.copy()
        mesh[:, :2] -= low
        return FacePhoto(np.ascontiguousarray(self.rgb[low[1] : high[1], low[0] : high[0]]), mesh, self.number)
