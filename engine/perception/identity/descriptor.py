"""What tells people apart: the one interface of its backends."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True)
class IdentityDistances:
    """Euclidean distances of two descriptors. Below `same` the faces are of one person, from `other` on of two; between them
    either may be."""

    same: float
    other: float


class FaceDescriptor(Protocol):
    """Something that tells people apart."""

    @property
    def distances(self) -> IdentityDistances:
        """What its distances mean."""

    def __call__(self, rgb: NDArray[np.uint8], mesh: NDArray[np.floating]) -> NDArray[np.float32]:
        """(D,) the descriptor of the face of `mesh` (478, 3), as `FaceTracker` gives it, in the picture `rgb` (H, W, 3)."""
