"""Where a person's mouth is in their head, seen from the front: what teeth are laid behind."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from engine.perception.face.landmarks import INNER_MOUTH_CORNER_VERTICES, mouth_opening

UPPER_LIP_MIDDLE_VERTICES = (82, 13, 312)
BEHIND_LIPS_EYE_DISTANCES = 0.03
"""Eye distances by which teeth lie behind the inner lips."""
BELOW_LIPS_EYE_DISTANCES = 0.06
"""Eye distances below where the lips meet, at which upper teeth end."""
MAX_SHUT_OPENING = 0.05
"""Of a mouth that tells where its lips meet."""
MIN_FULL_OPENING = 0.09
"""Of a mouth that is open."""
NOSE_BASE_VERTICES = (2, 94, 98, 327)


@dataclass(frozen=True)
class RestingMouth:
    """front : (478, 3) the face from the front, in its eye distances, y down and z away from the viewer.
    shut : (478, 3) the same with closed lips, as far as it is known.
    """

    front: NDArray[np.float64]
    shut: NDArray[np.float64]

    @property
    def depth(self) -> float:
        """Of the front of the upper teeth."""
        return float(self.front[list(UPPER_LIP_MIDDLE_VERTICES), 2].mean()) + BEHIND_LIPS_EYE_DISTANCES

    @property
    def middle(self) -> float:
        """Of the mouth, along x."""
        return float(self.front[list(INNER_MOUTH_CORNER_VERTICES), 0].mean())

    @property
    def width(self) -> float:
        """From corner to corner."""
        return float(
            np.linalg.norm(self.front[INNER_MOUTH_CORNER_VERTICES[1]] - self.front[INNER_MOUTH_CORNER_VERTICES[0]])
        )

    @property
    def edge(self) -> float:
        """The height at which the upper teeth end."""
        return float(self.shut[[13, 14], 1].mean()) + BELOW_LIPS_EYE_DISTANCES


def resting_mouth(front: NDArray[np.floating], neutral: NDArray[np.floating]) -> RestingMouth:
    """That of a face `front` (478, 3), whose mouth may be open: then `neutral` (478, 3), the person's face at rest, tells where its lips
    meet, the bases of both noses laid on one another."""
    whole = np.asarray(front, np.float64)
    if float(mouth_opening(whole)) < MAX_SHUT_OPENING:
        return RestingMouth(whole, whole)
    base = list(NOSE_BASE_VERTICES)
    return RestingMouth(whole, np.asarray(neutral + (whole[base] - neutral[base]).mean(axis=0), np.float64))
