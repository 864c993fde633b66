"""From which sides the cameras see the person."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

UNSEEN_GAP_RADIANS = np.radians(100)
"""Between neighbouring cameras around the person: from there on a side is not seen well."""
VIEWED_SIDES = ("front", "left side", "back", "right side")
"""Of the person, by quarter turns from +z to +x, the person's left."""


def unseen_side(eyes: NDArray[np.floating]) -> str | None:
    """The side of the person, who faces +z at the origin, from which none of the cameras at `eyes` (C, 3) looks; None where
    they go all around."""
    around = np.sort(np.arctan2(eyes[:, 0], eyes[:, 2]))
    gaps = np.diff(np.append(around, around[0] + 2 * np.pi))
    widest = int(gaps.argmax())
    if gaps[widest] <= UNSEEN_GAP_RADIANS:
        return None
    middle = around[widest] + gaps[widest] / 2
    return VIEWED_SIDES[round(middle / (np.pi / 2)) % len(VIEWED_SIDES)]
