"""Cloth that goes round both legs: a skirt, a dress, the tails of a coat, found row by row of the picture.

Beyond the paper, which knows no clothes.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.body.parts import BODY_PARTS
from engine.character.parts.hem_between_legs import between_legs
from engine.imaging.masks.mask_pieces import rows_apart

CLOSE_FIT_WIDTH_RATIO, FREE_HANGING_WIDTH_RATIO = 1.12, 1.5
"""How much wider than the template cloth is that still follows the legs, and that hangs freely."""
CLOTH_DEPTH_RATIO = 0.68
"""Depth of free cloth as a share of its width: about that of hips."""
MIN_FREE_CLOTH_SHARE = 0.5
"""From which share on cloth is no trousers' whose legs touch."""
WAIST_TRUNK_SHARE = 0.65
"""How far down the trunk cloth may begin to hang freely."""
OVERLAPPING_LEGS_SHARE = 0.25
"""Share of the legs' width in which one hides the other. From there on cloth is loose only if it is wider than the
hips: trousers of legs that are seen from the side are wide for one shin."""
HEM_NARROWING_RATIO, HEM_WINDOW_ROWS = 0.85, 16
"""Cloth ends where it is narrower than this share of what it was within so many rows."""
CLOTH_SMOOTHING_SHARE, FADE_LENGTH_FACTOR = 0.012, 4.0
"""Share of the person's height over which cloth changes along the body, and over how much of that it begins."""
HEM_UNEVENNESS_SHARE = 0.1
"""Share of the height by which a hem may hang lower beside the legs."""
HEM_SEARCH_SHARE = 0.05
"""Share of the height beneath a cloth's end over which is looked what goes on."""
TROUSERS_LOOSENESS_SHARE = 0.75
"""Share of cloth's looseness that goes on beneath its end, from which on it was trousers' or a jumper's."""


@dataclass(frozen=True)
class Ring:
    """The cloth in one row of pixels: its `first` and `last` column, the `middle` of its depth and `half` of it, in pixels,
    and how freely it hangs, `share` in [0, 1]. `legs`: the columns of the left and the right leg in it; NaN where one is not seen."""

    row: int
    first: int
    last: int
    middle: float
    half: float
    share: float
    legs: tuple[float, float]

    @property
    def width(self) -> int:
        return self.last - self.first + 1

    def across(self, columns: NDArray[np.intp]) -> NDArray[np.float64]:
        """Where columns are in it, from -1 at the viewer's left to 1."""
        return np.clip(2 * (columns - self.first) / max(self.last - self.first, 1) - 1, -1, 1)


@dataclass(frozen=True)
class FreeCloth:
    """What is `worn` (h, w), and its `rings`, row by row from the waist down, the first `above` of them above the
    crotch. It `hangs` if it is loose and ends in a hem or at the ground; otherwise it is close, a jumper's or
    trousers', and may `go_on` in legs.

    lower : (h, w) what hangs beneath the last ring between and beside the legs.
    even : pixels over which cloth changes along the body.
    legs : (h, w) the leg, an index of `BODY_PARTS`, that comes out from under it there, -1 elsewhere; None where none
        is apart from it.
    before : of these the one that passes before the other, None where neither does.
    """

    worn: NDArray[np.bool_]

    rings: tuple[Ring, ...]
    above: int
    hangs: bool
    goes_on: bool
    lower: NDArray[np.bool_]
    even: float
    legs: NDArray[np.int8] | None = None
    before: int | None = None

    @property
    def parted(self) -> bool:
        """Whether legs that come out from under it are apart from it."""
        return self.legs is not None and bool((self.legs >= 0).any())

    def rows(self) -> Iterator[tuple[int, int, NDArray[np.intp]]]:
        """Each row of it: the index of its ring, the row, its columns. What is lower is of the last ring."""
        for k, ring in enumerate(self.rings):
            yield k, ring.row, np.arange(ring.first, ring.last + 1)
        for row in np.flatnonzero(self.lower.any(1)):
            yield len(self.rings) - 1, int(row), np.flatnonzero(self.lower[row])

    def begins(self, first: int = 0) -> NDArray[np.float64]:
        """From 0 to 1 over the first rings from the one of index `first` on, and to 0 over the last if it goes on."""
        count = len(self.rings)
        step = np.clip((np.arange(count) - first) / (FADE_LENGTH_FACTOR * self.even), 0, 1)
        return np.minimum(step, np.arange(count)[::-1] / (FADE_LENGTH_FACTOR * self.even)) if self.goes_on else step


def free_cloth(
    cloth: NDArray[np.bool_],
    shown: NDArray[np.integer],
    nearest: NDArray[np.floating],
    furthest: NDArray[np.floating],
    parting: NDArray[np.bool_],
    overlap: NDArray[np.bool_] | None = None,
    hem: int | None = None,
) -> FreeCloth | None:
    """Find it: in each row one piece, round all that the template has there. None where nothing goes round it.

    Parameters
    ----------
    cloth : (h, w) which pixels may be cloth.
    shown : (h, w) the part that the template's body shows, -1 beside it.
    nearest, furthest : (h, w) its depths there.
    parting : (h, w) where one leg meets the other.

    There close cloth is trousers, unless it gets loose further down and ends in a hem. `overlap` (h, w): where one of
    the template's legs hides the other. `hem`: the last row of cloth that goes round both legs, if it is known
    (`engine.character.parts.hem_between_legs`).
    """
    trunk, left, right = (shown == BODY_PARTS.index(name) for name in ("torso", "left_leg", "right_leg"))
    if not (cloth.any() and trunk.any() and left.any() and right.any()):
        return None
    overlap = np.zeros_like(cloth) if overlap is None else overlap
    high = rows_apart(cloth)
    far = max(2, round(HEM_SEARCH_SHARE * high))
    around = (trunk, left, right), overlap, nearest, furthest
    rings = [] if hem is None else _rings(_filled(cloth, left, right, hem), *around, hem)
    hangs, goes_on = bool(rings) and rings[-1].row == hem, False
    if not hangs:
        rings = _rings(cloth, *around)
        hangs, goes_on = _hem(rings, cloth, trunk | left | right, far)
    if not hangs:
        parts = np.array(
            [
                ring.share < MIN_FREE_CLOTH_SHARE and parting[ring.row, ring.first : ring.last + 1].any()
                for ring in rings
            ]
        )
        many = [k for k in np.flatnonzero(parts) if parts[k : k + far // 2].mean() > 0.5]
        if many:
            rings, goes_on = rings[: many[0]], True
    if len(rings) < 2:
        return None
    even = CLOTH_SMOOTHING_SHARE * high
    beside = cv2.dilate((left | right).astype(np.uint8), np.ones((1, 2 * round(even) + 1), np.uint8)) > 0
    first = rings[-1].row + 1
    lower = np.zeros_like(cloth)
    within = slice(first, round(first + HEM_UNEVENNESS_SHARE * high))
    lower[within] = np.logical_and.accumulate((cloth & ~beside)[within], axis=0)
    crotch = np.flatnonzero(trunk.any(1))[-1]
    above = sum(ring.row < crotch for ring in rings)
    return FreeCloth(cloth, tuple(rings), above, hangs, goes_on, lower, even)


def _filled(cloth: NDArray[np.bool_], left: NDArray[np.bool_], right: NDArray[np.bool_], hem: int) -> NDArray[np.bool_]:
    """Cloth (h, w) without cracks between the legs down to its hem: it goes round both."""
    whole = cloth.copy()
    for row in np.flatnonzero(left[: hem + 1].any(1) & right[: hem + 1].any(1)):
        whole[row, between_legs(left[row], right[row])] = True
    return whole


def _hem(rings: Sequence[Ring], cloth: NDArray[np.bool_], template: NDArray[np.bool_], far: int) -> tuple[bool, bool]:
    """Whether rings hang, and if not, whether as loose cloth is `far` rows beneath. `template` (h, w): trunk and legs. Where
    nothing is beneath, they reach the ground or the picture's edge, and hang if they are loose there."""
    if not rings:
        return False, False
    end, shares = rings[-1].row + 1, [ring.share for ring in rings]
    above = _looseness(cloth, template, max(end - far // 2, 0), end)
    beneath = _looseness(cloth, template, end + far, end + 2 * far)
    goes_on = beneath > TROUSERS_LOOSENESS_SHARE * above
    loose = max(shares) if beneath > 0 else float(np.median(shares[-far:]))
    return not goes_on and loose > MIN_FREE_CLOTH_SHARE, goes_on


def _rings(
    cloth: NDArray[np.bool_],
    template: tuple[NDArray[np.bool_], NDArray[np.bool_], NDArray[np.bool_]],
    overlap: NDArray[np.bool_],
    nearest: NDArray[np.floating],
    furthest: NDArray[np.floating],
    hem: int | None = None,
) -> list[Ring]:
    """From the waist down, row by row as long as one piece goes round all that the `template` has there, its trunk and its left and
    right leg (h, w) each, which may `overlap` (h, w). Down to the `hem`, if it is known: what narrows above the legs
    is a jacket's, and a skirt begins there."""
    trunk, left, right = template
    both = np.asarray((left.any(1) & right.any(1)) | overlap.any(1))
    as_one = overlap.sum(1) > OVERLAPPING_LEGS_SHARE * (left | right).sum(1)
    rings: list[Ring] = []
    rows = np.flatnonzero(trunk.any(1))
    widest = 0
    for row in range(int(rows[0] + WAIST_TRUNK_SHARE * (rows[-1] - rows[0])), len(cloth) if hem is None else hem + 1):
        if not (trunk[row].any() or both[row]):
            break
        there = np.flatnonzero((trunk | left | right)[row])
        piece = _piece(cloth[row], (there[0] + there[-1]) // 2)
        if piece is None:
            break
        width, least = piece[1] - piece[0] + 1, there[-1] - there[0] + 1
        widest = max(widest, least)
        least = widest if as_one[row] else least
        share = float(
            np.clip((width / least - CLOSE_FIT_WIDTH_RATIO) / (FREE_HANGING_WIDTH_RATIO - CLOSE_FIT_WIDTH_RATIO), 0, 1)
        )
        if (
            rings
            and share < MIN_FREE_CLOTH_SHARE
            and width < HEM_NARROWING_RATIO * max(ring.width for ring in rings[-HEM_WINDOW_ROWS:])
        ):
            if hem is None:
                break
            if row < rows[-1]:
                rings.clear()
        near, far = float(np.nanmax(nearest[row, there])), float(np.nanmin(furthest[row, there]))
        legs = _middle(left[row]), _middle(right[row])
        rings.append(
            Ring(row, *piece, (near + far) / 2, max((near - far) / 2, CLOTH_DEPTH_RATIO * width / 2), share, legs)
        )
    return rings


def _middle(row: NDArray[np.bool_]) -> float:
    """The mean column of a row (w,); NaN where it is empty."""
    return float(np.flatnonzero(row).mean()) if row.any() else float("nan")


def _looseness(cloth: NDArray[np.bool_], template: NDArray[np.bool_], first: int, end: int) -> float:
    """How many times as wide as the template cloth is in the rows from `first` to `end`; 0 where either is not there."""
    wide, least = cloth[first:end].sum(1), template[first:end].sum(1)
    there = least > 0
    return float(np.median(wide[there] / least[there])) if there.any() else 0.0


def _piece(row: NDArray[np.bool_], column: int) -> tuple[int, int] | None:
    """The first and last column of the piece of a row (w,) that a column is in."""
    if not row[column]:
        return None
    gaps = np.flatnonzero(~row)
    before, after = gaps[gaps < column], gaps[gaps > column]
    return (int(before[-1]) + 1 if len(before) else 0), (int(after[0]) - 1 if len(after) else len(row) - 1)
