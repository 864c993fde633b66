"""A hem seen between legs that stand apart: what tells a skirt from trousers where its outline does not.

Beyond the paper, which knows no clothes. Cloth round both legs fills what is between them down to its hem, and ends there all at
once. Between the legs of trousers it ends little by little, or its colours go on beneath.
"""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.imaging.masks.mask_pieces import rows_apart

MIN_LEG_GAP_PIXELS, MIN_LEG_GAP_SHARE = 5, 0.1
"""Pixels that are between the legs at a hem, at least, and the share of the legs' own width."""
CLOSED_SHARE, OPEN_SHARE = 0.25, 0.7
"""Share of what is between the legs that is no cloth, up to which a row is closed, and from which on it is open."""
MIN_OPENING_PIXELS_PER_ROW = 4.5
"""Pixels between the legs for each row in which they come to be open, at a hem: trousers part in a wedge."""
WIDE_GAP_SHARE = 1.0
"""Share of the legs' own width that is between them, from which on no trousers fill it."""
MIN_HEM_COLOUR_CHANGE, HEM_CHANGE_FACTOR = 12.0, 2.2
"""CIELAB's distance of what is above a hem from what is beneath, at least; and to how much it changes above."""
HEM_COLOUR_BAND_SHARE = 0.025
"""Share of the person's height above and beneath a hem in which colours are compared."""
MIN_HEM_DEPTH_SHARE, MAX_HEM_DEPTH_SHARE = 0.1, 0.85
"""How far down the legs a hem may be: above it are shorts', beneath it shoes."""


def hem_between_legs(
    rgb: NDArray[np.uint8], cloth: NDArray[np.bool_], left: NDArray[np.bool_], right: NDArray[np.bool_]
) -> int | None:
    """The last row of cloth that goes round both legs; None where no hem is seen between them.

    Parameters
    ----------
    rgb : (h, w, 3) the picture.
    cloth : (h, w) which pixels may be cloth.
    left, right : (h, w) where the template's legs are.
    """
    rows = np.flatnonzero(left.any(1) & right.any(1))
    if not len(rows):
        return None
    gaps = [between_legs(left[row], right[row]) for row in rows]
    wide = np.array([gap.stop - gap.start for gap in gaps])
    own = (left | right)[rows].sum(1)
    bare = np.array([(~cloth[row, gap]).mean() if w > 0 else 0.0 for row, gap, w in zip(rows, gaps, wide, strict=True)])
    opened = np.flatnonzero((bare > OPEN_SHARE) & (wide >= MIN_LEG_GAP_PIXELS))
    closed = np.flatnonzero(bare[: opened[0]] < CLOSED_SHARE) if len(opened) else opened
    if not len(closed):
        return None
    last, first = int(closed[-1]), int(opened[0])
    depth = (rows[last] - rows[0]) / max(rows[-1] - rows[0], 1)
    at_once = wide[last] >= MIN_OPENING_PIXELS_PER_ROW * (rows[first] - rows[last])
    apart = wide[last] >= max(MIN_LEG_GAP_PIXELS, MIN_LEG_GAP_SHARE * own[last])
    if not (apart and at_once and MIN_HEM_DEPTH_SHARE <= depth <= MAX_HEM_DEPTH_SHARE):
        return None
    filled = wide[last] >= WIDE_GAP_SHARE * own[last]
    return (
        int(rows[last])
        if filled or _colours_change(rgb, cloth, left | right, int(rows[last]), int(rows[first]))
        else None
    )


def between_legs(left: NDArray[np.bool_], right: NDArray[np.bool_]) -> slice:
    """The columns between both legs in a row (w,) of each; none where they touch."""
    ends = sorted((int(np.flatnonzero(one)[0]), int(np.flatnonzero(one)[-1])) for one in (left, right))
    return slice(ends[0][1] + 1, max(ends[1][0], ends[0][1] + 1))


def _colours_change(
    rgb: NDArray[np.uint8], cloth: NDArray[np.bool_], legs: NDArray[np.bool_], last: int, first: int
) -> bool:
    """Whether what covers the `legs` (h, w) changes its colours between the `last` row above a hem and the `first` beneath, more
    than above it."""
    lab = cv2.cvtColor(rgb.astype(np.float32) / np.float32(255), cv2.COLOR_RGB2LAB)
    inner = legs & (cv2.erode(cloth.astype(np.uint8), np.ones((3, 3), np.uint8)) > 0)
    band = max(2, round(HEM_COLOUR_BAND_SHARE * rows_apart(cloth)))
    bands = [slice(max(end - band, 0), end) for end in (last - band, last - 1, first + 2 + band)]
    seen = [lab[rows][inner[rows]] for rows in bands]
    if not all(len(one) for one in seen):
        return False
    further, above, beneath = (np.median(one, axis=0) for one in seen)
    change = float(np.linalg.norm(above - beneath))
    return change >= max(MIN_HEM_COLOUR_CHANGE, HEM_CHANGE_FACTOR * float(np.linalg.norm(further - above)))
