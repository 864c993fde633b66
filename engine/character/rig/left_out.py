"""What the outline shows of a person and the character has not: a held thing, a strap, hair. Nothing is dropped in silence."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.imaging.masks.mask_pieces import bounding_box, mask_height, pieces_by_area

WHOLE_OVERLAP_SHARE = 0.98
"""Overlap of the character's silhouette with the outline from which it is said to be whole."""
OUTLINE_TOLERANCE_SHARE = 0.004
"""Half the width of what is no more than the outline's own uncertainty, as a share of the person's height."""
MIN_LOST_PIECE_SHARE = 0.002
"""Share of the outline's pixels from which a piece is told of."""


@dataclass(frozen=True)
class LeftOut:
    """A piece of the outline that the character does not cover: its `box` in the picture (x, y, width, height), pixels, and
    its `share` of the outline."""

    box: tuple[int, int, int, int]
    share: float


def left_out(mask: NDArray[np.bool_], drawn: NDArray[np.bool_]) -> list[LeftOut]:
    """The pieces of an outline (H, W) that what is `drawn` (H, W) leaves out, the largest first."""
    if not mask.any():
        return []
    radius = max(1, round(OUTLINE_TOLERANCE_SHARE * mask_height(mask)))
    disk = cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (2 * radius + 1, 2 * radius + 1))
    thick = cv2.morphologyEx((mask & ~drawn).astype(np.uint8), cv2.MORPH_OPEN, disk) > 0
    area = int(mask.sum())
    found = []
    for piece in pieces_by_area(thick, MIN_LOST_PIECE_SHARE * area, connectivity=8):
        rows, columns = bounding_box(piece)
        box = (columns.start, rows.start, columns.stop - columns.start, rows.stop - rows.start)
        found.append(LeftOut(box, float(piece.sum() / area)))
    return found


def warn_of_silhouette(overlap: float, pieces: list[LeftOut], warn: Callable[[str, str], None]) -> None:
    """Say what the character leaves out, and where it differs otherwise. `overlap`: intersection over union of both silhouettes."""
    if pieces:
        places = "; ".join(
            f"{one.share:.1%} at x {one.box[0]} to {sum(one.box[::2])}, y {one.box[1]} to {one.box[1] + one.box[3]}"
            for one in pieces[:3]
        )
        warn(
            "piece_left_out",
            f"The character does not have all that the outline shows: {places}. If it is the person's, paint it with the part"
            " that it belongs to (labels); if not, take it off the outline (mask).",
        )
    if overlap < WHOLE_OVERLAP_SHARE:
        warn(
            "silhouette_differs",
            f"As pictured, the character's silhouette overlaps the outline by {overlap:.1%}: less than {WHOLE_OVERLAP_SHARE:.0%}.",
        )
