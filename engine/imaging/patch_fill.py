"""A hole filled with patches of what is named, and of nothing else."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from engine.imaging.inpaint import background_plate
from engine.imaging.mask_pieces import bounding_box


def filled(rgb: NDArray[np.uint8], hole: NDArray[np.bool_], known: NDArray[np.bool_]) -> NDArray[np.uint8]:
    """The picture (h, w, 3) with the hole (h, w) filled with patches of what is `known` (h, w), and of nothing else."""
    if not hole.any() or not known.any():
        return rgb
    box = bounding_box(hole | known)
    reach = float(np.sqrt(hole.sum()))
    plate = background_plate(np.ascontiguousarray(rgb[box]), hole[box].astype(np.float32), reach, known=known[box])
    out = rgb.copy()
    out[box] = np.where(hole[box][..., None], plate, rgb[box])
    return out
