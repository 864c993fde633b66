"""The background plate: the picture as it would be if the layer before it were not there."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from engine.imaging.filling.inpaint import SOFT_EDGE, grown_by_margin, inpaint

MIN_ALPHA = 0.02
"""Alpha above which a pixel carries some of the layer."""


def background_plate(
    rgb: NDArray[np.uint8], alpha: NDArray[np.float32], reach: float | None = None, seed: int = 0
) -> NDArray[np.uint8]:
    """The picture (H, W, 3) uint8 with the layer of `alpha` (H, W) taken away and filled from around it.

    Parameters
    ----------
    reach : how far behind the outline, in pixels, the plate is filled in full detail (default: a tenth of
        the square root of the layer's area, about what a head that moves by 10% of its size lays bare).
    seed : of the randomised search.

    Pixels away from the layer are unchanged. A layer that covers the whole picture leaves nothing to fill
    from: its plate is the picture's mean colour.
    """
    hole = hole_behind(alpha)
    if hole.all():
        return np.broadcast_to(rgb.mean((0, 1)).astype(np.uint8), rgb.shape).copy()
    if reach is None:
        reach = 0.1 * float(np.sqrt(alpha.sum()))
    return inpaint(rgb, hole, ~hole, reach=reach + SOFT_EDGE * max(rgb.shape), margin=0, seed=seed)


def hole_behind(alpha: NDArray[np.float32]) -> NDArray[np.bool_]:
    """Pixels (H, W) that carry any trace of the layer, with a margin for its soft edge and glow."""
    return grown_by_margin(alpha > MIN_ALPHA)
