"""What hangs: hair falls from hair above it, and passes behind ears."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray


def hanging(
    found: NDArray[np.bool_], roots: NDArray[np.bool_], before: NDArray[np.bool_] | None = None
) -> NDArray[np.bool_]:
    """What of pixels (h, w) is `roots` (h, w) or hangs from them: a path leads there that goes down or aside, and nowhere up. It may pass behind what
    lies `before` (h, w), which itself does not count."""
    passable = found if before is None else found | before
    hangs = roots & passable
    for row in range(len(passable)):
        own = hangs[row]
        if row:
            above = hangs[row - 1]
            own |= above
            own[1:] |= above[:-1]
            own[:-1] |= above[1:]
            own &= passable[row]
        run = np.cumsum(np.diff(passable[row].astype(np.int8), prepend=0) == 1)
        own |= passable[row] & np.isin(run, run[own])
    return hangs & found
