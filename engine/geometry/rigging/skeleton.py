"""A skeleton at rest: joints by their Mixamo names, in T-pose."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True)
class Skeleton:
    """Joints, parents before children.

    `parents` (J,) int32, -1 for the root. `heads` (J, 3) float32 are the joints' places at rest: metres, y up, the
    feet on the plane y = 0, facing +z, the person's left at +x, arms stretched out along x (T-pose). At rest every
    joint's axes are the world's: a joint's rotation is its turn from the T-pose, given in its parent's axes.
    """

    names: tuple[str, ...]
    parents: NDArray[np.int32]
    heads: NDArray[np.float32]

    def index(self, name: str) -> int:
        """The joint's index; ValueError if there is no such joint."""
        return self.names.index(name)

    def offsets(self) -> NDArray[np.float32]:
        """(J, 3) each joint's place seen from its parent at rest; the root's from the origin."""
        return (self.heads - np.where(self.parents[:, None] >= 0, self.heads[self.parents], 0)).astype(np.float32)
