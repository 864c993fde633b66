"""Where around a head there is hair: as it is seen in front, and elsewhere as hair grows.

In front each pixel says it: a hairline, a fringe and an ear among hair are where the picture has them. Around the back hair goes on from
where it is a side's outline. On a side whose outline is skin it begins behind the ear, and ends at the nape.
"""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.character.hair.rings import HairRings
from engine.imaging.filling.nearest import nearest_values
from engine.imaging.masks.mask_pieces import without_small_pieces

BEHIND_THE_EAR_RADIANS, AT_THE_NAPE_RADIANS = 1.9, 2.7
"""Radians from the front at which hair begins on a side that shows none, at the ears' height, and at the chin's."""
EDGE_RADIANS, EDGE_ROWS = 0.25, 3.0
"""Radians and rows in which it begins and ends where no picture says it: the slope of what is cut at zero."""
SIDE_COSINES = (0.0, 0.2)
"""Cosines to the viewer between which what a side is like goes over into what each pixel shows."""
HAIR_EDGE_SIGMA_PIXELS, SIDE_SMOOTHING_ROWS = 0.8, 2.0
"""Pixels over which the border of what is seen is smoothed, and rows over which it is what a side is like."""
MIN_GAP_PIXELS = 12
"""Pixels of a gap in hair through which something else is seen."""
BACK_RADIANS = (1.7, 2.6)
"""Radians from the front between which the length of a side goes over into that of the back."""


@dataclass(frozen=True)
class HeadLevels:
    """The rows of a head in the picture: its `ears`, its `nape` and its `chin`."""

    ears: float
    nape: float
    chin: float


def hair_extent(
    hair: NDArray[np.bool_],
    shown: NDArray[np.bool_],
    of: HairRings,
    places: NDArray[np.float64],
    angles: NDArray[np.float64],
    levels: HeadLevels,
) -> NDArray[np.float64]:
    """How surely there is hair (R, N) at the `places` (R, N, 3) so many radians (N,) from the front around to the right: above 0 there is.

    `hair`, `shown` (h, w): the pixels that show it, and those that show anything of the person.
    """
    within = np.where(shown, ~without_small_pieces(shown & ~hair, MIN_GAP_PIXELS), hair).astype(np.float32)
    around = nearest_values(within, shown | hair)
    soft = cv2.GaussianBlur(around, (0, 0), HAIR_EDGE_SIGMA_PIXELS)
    x, y = (places[..., k].astype(np.float32) for k in (0, 1))
    seen = cv2.remap(soft, x, y, cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE) - 0.5
    least, most = SIDE_COSINES
    share = np.clip((np.cos(angles) - least) / (most - least), 0, 1)
    return np.asarray(
        share * seen + (1 - share) * np.minimum(_beside(of, angles, levels), _above_the_end(hair, of, angles, levels))
    )


def _beside(of: HairRings, angles: NDArray[np.float64], levels: HeadLevels) -> NDArray[np.float64]:
    """How surely there is hair (R, N) beside and behind, of any length."""
    lower = np.clip((of.rows - levels.ears) / max(levels.chin - levels.ears, 1), 0, 1)
    begins = BEHIND_THE_EAR_RADIANS + lower * (AT_THE_NAPE_RADIANS - BEHIND_THE_EAR_RADIANS)
    behind = np.clip((np.abs(angles) - begins[:, None]) / EDGE_RADIANS, -0.5, 0.5)
    left, right = (_along_rows(one.astype(np.float64)) - 0.5 for one in of.outermost)
    side = np.where(angles > 0, right[:, None], left[:, None])
    return np.maximum(side, behind)


def _above_the_end(
    hair: NDArray[np.bool_], of: HairRings, angles: NDArray[np.float64], levels: HeadLevels
) -> NDArray[np.float64]:
    """How far above its end hair is (R, N), as a share of what it ends in: each side as long as it is seen, the back as the shorter of both,
    and down to the nape where that is above the chin."""
    ends = []
    for own in of.outermost:
        rows = of.rows[own]
        ends.append(max(float(rows[-1]) if len(rows) else levels.nape, levels.nape))
    back = min(ends) if min(ends) > levels.chin else levels.nape
    share = np.clip((np.abs(angles) - BACK_RADIANS[0]) / (BACK_RADIANS[1] - BACK_RADIANS[0]), 0, 1)
    share = share * share * (3 - 2 * share)
    side = np.where(angles > 0, ends[1], ends[0])
    end = side + share * (back - side)
    return np.clip((end[None] - of.rows[:, None]) / EDGE_ROWS, -0.5, 0.5)


def _along_rows(values: NDArray[np.float64]) -> NDArray[np.float64]:
    flat = np.ascontiguousarray(values[:, None], np.float32)
    return np.asarray(
        cv2.GaussianBlur(flat, (1, 0), 1, sigmaY=SIDE_SMOOTHING_ROWS, borderType=cv2.BORDER_REPLICATE), np.float64
    )[:, 0]
