"""Cloth that goes round both legs: a skirt or the tails of a coat hang as a bell does, also towards the viewer and away.

Beyond the paper, whose depth comes from the template's normals: two legs under a sheet, which from the side is as thin as
the legs and drawn in at the hem.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import cv2
import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import gaussian_filter1d

from engine.character.labels import PARTS
from engine.character.part_surface import Surface
from engine.character.sheets import Layer

CLOSE, FREE = 1.12, 1.5
"""How much wider than the template cloth is that still follows the legs, and that hangs freely."""
ROUND = 0.68
"""Depth of free cloth as a share of its width: about that of hips."""
EVEN = 0.012
"""Share of the person's height over which cloth changes along the body."""
WAIST, FADE = 0.65, 4.0
"""How far down the trunk cloth may begin to hang freely, and over how much of `EVEN` it does."""
HEM, LATELY = 0.85, 16
"""It ends where it is narrower than this share of what it was within so many rows."""
STEEPEST = 0.7
"""By how much half of the depth may grow with a step down."""
TROUSERS = 0.75
"""Share of the width that goes on beneath the last piece around both legs, from which on it was trousers' or a jumper's."""
UNEVEN = 0.1
"""Share of the height by which a hem may hang lower beside the legs."""
SHOE = 0.03
"""Share of the height by which shoes reach above the ankles."""
BOXY = 2.2
"""Exponent of the cross-section, a superellipse: of 2 it would be an ellipse."""


@dataclass(frozen=True)
class _Ring:
    """The cloth in one row of pixels: its `first` and `last` column, the `middle` of its depth and `half` of it, in pixels,
    and how freely it hangs, `share` in [0, 1]."""

    row: int
    first: int
    last: int
    middle: float
    half: float
    share: float

    @property
    def width(self) -> int:
        return self.last - self.first + 1


def drape(
    body: Layer,
    cloth: NDArray[np.bool_],
    shown: NDArray[np.integer],
    nearest: NDArray[np.floating],
    furthest: NDArray[np.floating],
    parting: NDArray[np.bool_],
    ankles: float,
) -> Layer:
    """The body with its free cloth about as deep as it is wide.

    `cloth` (h, w): which of the body's pixels may be cloth; `shown` (h, w): the part that the template's body shows, -1
    beside it; `nearest` and `furthest` (h, w): its depths there; `parting` (h, w): where the picture shows that one leg ends
    and the other begins, and so no cloth goes round both; `ankles`: the row of the higher one, beneath which shoes are.
    """
    rings = _rings(cloth, shown, nearest, furthest, parting)
    if len(rings) < 2:
        return body
    high = np.ptp(np.flatnonzero(body.mask.any(1)))
    along = EVEN * high
    middle, half, share = (
        np.array([getattr(ring, name) for ring in rings], np.float64) for name in ("middle", "half", "share")
    )
    half = _hanging(half, STEEPEST)
    middle, half, share = (gaussian_filter1d(one, along, mode="nearest") for one in (middle, half, share))
    step = np.clip(np.arange(len(rings)) / (FADE * along), 0, 1)
    share = share * step
    last = rings[-1]
    beneath = cloth[last.row + round(FADE * along) :].sum(1)[: round(FADE * along)]
    if len(beneath) and np.median(beneath) > TROUSERS * last.width:
        share = share * step[::-1]
    depths = body.front.depth.copy(), body.back.depth.copy()

    def bulge(k: int, row: int, columns: NDArray[np.intp]) -> None:
        ring = rings[k]
        across = np.abs(2 * (columns - ring.first) / max(ring.last - ring.first, 1) - 1).clip(0, 1)
        height = half[k] * (1 - across**BOXY) ** (1 / BOXY)
        for depth, towards in zip(depths, (1, -1), strict=True):
            own = depth[row, columns]
            depth[row, columns] = own + share[k] * (middle[k] + towards * height - own)

    for k, ring in enumerate(rings):
        bulge(k, ring.row, np.arange(ring.first, ring.last + 1))
    legs = np.isin(shown, [PARTS.index(name) for name in ("left_leg", "right_leg")]).astype(np.uint8)
    of_legs = cv2.dilate(legs, np.ones((1, 2 * round(along) + 1), np.uint8)) > 0
    for row in range(last.row + 1, int(min(last.row + UNEVEN * high, ankles - SHOE * high))):
        bulge(-1, row, np.flatnonzero(cloth[row] & ~of_legs[row]))
    front, back = (Surface(depth, side.weights) for depth, side in zip(depths, (body.front, body.back), strict=True))
    return replace(body, front=front, back=back)


def _hanging(half: NDArray[np.float64], steepest: float) -> NDArray[np.float64]:
    """Depths (n,) that do not shrink downwards, for cloth hangs, nor grow by more than `steepest` from row to row."""
    hung = np.maximum.accumulate(half)
    rows = np.arange(len(hung))
    return np.asarray(np.minimum.accumulate(hung - steepest * rows) + steepest * rows)


def _rings(
    cloth: NDArray[np.bool_],
    shown: NDArray[np.integer],
    nearest: NDArray[np.floating],
    furthest: NDArray[np.floating],
    parting: NDArray[np.bool_],
) -> list[_Ring]:
    """From the waist down, row by row as long as one piece goes round all that the template has there."""
    trunk, left, right = (shown == PARTS.index(name) for name in ("torso", "left_leg", "right_leg"))
    rings: list[_Ring] = []
    if not (trunk.any() and left.any() and right.any()):
        return rings
    rows = np.flatnonzero(trunk.any(1))
    for row in range(int(rows[0] + WAIST * (rows[-1] - rows[0])), len(cloth)):
        if not (trunk[row].any() or (left[row].any() and right[row].any())):
            break
        there = np.flatnonzero((trunk | left | right)[row])
        piece = _piece(cloth[row], (there[0] + there[-1]) // 2)
        if piece is None:
            break
        width, least = piece[1] - piece[0] + 1, there[-1] - there[0] + 1
        share = float(np.clip((width / least - CLOSE) / (FREE - CLOSE), 0, 1))
        legs_part = parting[row, piece[0] : piece[1] + 1].any() and share < 0.5
        ends = rings and width < HEM * max(ring.width for ring in rings[-LATELY:]) and rings[-1].share > 0
        if legs_part or ends:
            break
        near, far = float(np.nanmax(nearest[row, there])), float(np.nanmin(furthest[row, there]))
        rings.append(_Ring(row, *piece, (near + far) / 2, max((near - far) / 2, ROUND * width / 2), share))
    return rings


def _piece(row: NDArray[np.bool_], column: int) -> tuple[int, int] | None:
    """The first and last column of the piece of a row (w,) that a column is in."""
    if not row[column]:
        return None
    gaps = np.flatnonzero(~row)
    before, after = gaps[gaps < column], gaps[gaps > column]
    return (int(before[-1]) + 1 if len(before) else 0), (int(after[0]) - 1 if len(after) else len(row) - 1)
