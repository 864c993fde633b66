"""Pixels beside a border that have no colour of their part: mixed ones, the shadow of a hand on a thigh, the wall
between two legs.

Seen, they pass. Left behind on the thigh when the hand is gone, they are a scar.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from engine.character.parts.border_colours import (
    LIKE_NEITHER,
    LIKE_THE_OTHER,
    core_of,
    judged_colours,
    pixels_beside,
    smoothed_lab,
)
from engine.character.parts.labels import ARM_LABELS, LEG_LABELS, TRUNK_LABEL
from engine.imaging.masks.mask_distance import distance_inside

WALL_MIXED_PIXELS = 2.0
"""Pixels within the outline in which colours are mixed with the wall's, and are like nobody's."""


def strange_colours(rgb: NDArray[np.uint8], labels: NDArray[np.integer]) -> NDArray[np.bool_]:
    """The pixels (h, w) of a picture (h, w, 3) whose colours are not those of their part in `labels` (h, w). They are
    close to a limb that is not theirs, or of a limb and close to what is not its. No colour of their part's inside is
    around them. Theirs is one of what is beside it, a mixture of both, or a darker one: the print on a shirt has none
    of these. Where a part has no inside nearby nothing is said; nor of heads, nor where legs come out of the trunk: a
    hem and a belt are seen always."""
    lab = smoothed_lab(rgb)
    found, within = np.zeros(labels.shape, np.bool_), distance_inside(labels >= 0) > WALL_MIXED_PIXELS
    for part in (TRUNK_LABEL, *ARM_LABELS, *LEG_LABELS):
        own = labels == part
        others = (labels >= 0) & ~own
        if part not in ARM_LABELS:
            others = np.isin(labels, [limb for limb in (*ARM_LABELS, *LEG_LABELS) if limb != part])
        if part == TRUNK_LABEL:
            others = np.isin(labels, ARM_LABELS)
        beside = pixels_beside(own, others)
        if part in ARM_LABELS:
            beside &= within
            found |= np.isin(judged_colours(lab, beside, core_of(own), ~own), (LIKE_THE_OTHER, LIKE_NEITHER))
        elif beside.any():
            found |= np.isin(judged_colours(lab, beside, own & ~beside, ~own), (LIKE_THE_OTHER, LIKE_NEITHER))
    return found
