"""Seams between patches that were copied side by side, healed in the gradient domain.

Where two neighbours come from different places their colours may jump although neither place shows an edge. The picture is
put together anew from the gradients of the places that its pixels come from (Pérez et al., "Poisson image editing", 2003;
so do Darabi et al., "Image melding", 2012). Jumps that no source shows spread out to nothing; edges and grain that a source
shows stay.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from engine.compiled import njit
from engine.imaging.filling.poisson import membrane

SEAM_V_CYCLES = 3
"""Multigrid cycles on the finest grid: what is left of a seam cannot be seen."""


def heal_seams(picture: NDArray[np.float32], field: NDArray[np.int32], mask: NDArray[np.bool_]) -> NDArray[np.float32]:
    """The `picture` (H, W, 3), float32 grey levels, with its gradients inside `mask` (H, W) those of its sources.

    `field` (H, W, 2) int32 is where (y, x) in the picture each masked pixel was copied from.
    """
    divergence = np.zeros_like(picture)
    _divergence(np.ascontiguousarray(picture), field, mask, divergence)
    healed = membrane(picture, mask, SEAM_V_CYCLES, divergence)
    return np.where(mask[..., None], healed, picture).astype(np.float32)


@njit(fastmath=True, nogil=True)
def _divergence(picture, field, mask, divergence):  # type: ignore[no-untyped-def]
    height, width = mask.shape
    for y in range(height):
        for x in range(width):
            if not mask[y, x]:
                continue
            py, px = field[y, x, 0], field[y, x, 1]
            for k in range(4):
                dy, dx = (-1, 0) if k == 0 else (1, 0) if k == 1 else (0, -1) if k == 2 else (0, 1)
                qy, qx = y + dy, x + dx
                if qy < 0 or qx < 0 or qy >= height or qx >= width:
                    continue
                share = 0.5 if mask[qy, qx] else 1.0  # both ends have a say
                if 0 <= py + dy < height and 0 <= px + dx < width:
                    for c in range(3):
                        divergence[y, x, c] += share * (picture[py + dy, px + dx, c] - picture[py, px, c])
                if mask[qy, qx]:
                    sy, sx = field[qy, qx, 0], field[qy, qx, 1]
                    if 0 <= sy - dy < height and 0 <= sx - dx < width:
                        for c in range(3):
                            divergence[y, x, c] += 0.5 * (picture[sy, sx, c] - picture[sy - dy, sx - dx, c])
