"""Rings around a head that hair makes, row by row: how wide it is seen to be, and how deep it is before and behind what it hides."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import binary_closing, gaussian_filter1d

HAIR_CLEARANCE_PIXELS = 1.5
"""Pixels by which it is before and behind what it hides."""
MAX_BACK_HAIR_SHARE, MAX_FRONT_HAIR_SHARE = 0.35, 0.75
"""How far hair stands off behind, and how far before the head's middle it is at most, as shares of the head's depth."""
CROWN_SHARE = 0.12
"""How far below the skull's top, as a share of its height, hair begins to close above it."""
MIN_FRONT_COSINE = 0.3
"""Cosine to the viewer of what is seen of hair up to which it says how far before the middle hair is."""
HAIR_ROW_SMOOTHING, DEPTH_ROW_SMOOTHING = 1.5, 4.0
"""Rows over which its outline and its depth are smoothed."""
USUAL_FRONT_SHARE, MIN_FRONT_SHARE = 0.25, 0.1
"""How far before the head's middle hair is where nothing tells, and at least, as shares of the head's depth."""
FRONT_QUANTILE = 0.9
"""Quantile of how far before the middle the pixels of a row need hair to be."""
MAX_BARE_SHARE = 0.9
"""How far aside hair is on a side that shows none, as a share of half of the head's width at most: within its outline."""
CLOSING_ROWS = 4
"""Rows from the crown on in which hair is laid clear of what is beneath it more and more."""
MAX_EAR_SHARE = 0.35
"""Height of an ear among hair, at most, as a share of the head's."""
MIN_RADIUS_PIXELS = 0.3
"""Of a ring, where it closes."""
OUTERMOST_PIXELS = 1.5
"""Pixels by which something else may show further out than hair where hair is a side's outline."""


@dataclass(frozen=True)
class HairRings:
    """Of each row of hair, (R,) each but for the last two.

    rows : where it is.
    left, right : its outline.
    near, far : how deep it is in front and behind, z of picture space.
    outermost : (2, R) bool, whether hair is the outline on the left and on the right, or above and below an ear.
    axis, middle : the column and the depth of the head's middle, of all rows.
    """

    rows: NDArray[np.float64]
    left: NDArray[np.float64]
    right: NDArray[np.float64]
    near: NDArray[np.float64]
    far: NDArray[np.float64]
    outermost: NDArray[np.bool_]
    axis: float
    middle: float

    def places(self, angles: NDArray[np.float64]) -> NDArray[np.float64]:
        """Where hair is (R, N, 3) so many radians (N,) from the front around to the right: ellipses of four quarters."""
        across, along = np.sin(angles), np.cos(angles)
        wide = np.where(across > 0, (self.right - self.axis)[:, None], (self.axis - self.left)[:, None])
        deep = np.where(along > 0, (self.near - self.middle)[:, None], (self.middle - self.far)[:, None])
        rows = np.broadcast_to(self.rows[:, None], wide.shape)
        return np.stack([self.axis + wide * across, rows, self.middle + deep * along], 2)


@dataclass(frozen=True)
class _Skull:
    """Of a head: the least and the greatest of its places (3,), the column of its middle, and the row above which hair closes over it."""

    low: NDArray[np.float64]
    high: NDArray[np.float64]
    axis: float
    crown: float

    @property
    def half(self) -> float:
        return float(self.high[0] - self.low[0]) / 2

    @property
    def middle(self) -> float:
        return float(self.low[2] + self.high[2]) / 2

    @property
    def depth(self) -> float:
        return float(self.high[2] - self.low[2])


def hair_rings(
    hair: NDArray[np.bool_],
    skull: NDArray[np.float64],
    front: NDArray[np.float32],
    back: NDArray[np.float32],
    nape: float,
) -> HairRings:
    """The rings of `hair` (h, w) around the vertices of a `skull` (N, 3), picture space, down to the `nape`'s row at least.

    `front`, `back` (h, w): how near and how far what is shown of the person besides reaches, infinite where nothing is.
    """
    first, last = np.flatnonzero(hair.any(1))[[0, -1]]
    rows = np.arange(max(first - 1, 0), min(max(last, round(nape)), len(hair) - 1) + 1)
    low, high = skull.min(0), skull.max(0)
    head = _Skull(low, high, float(np.median(skull[:, 0])), float(low[1] + CROWN_SHARE * (high[1] - low[1])))
    outer = _outline(hair[rows], head.axis)
    bare = np.array([_reach(np.isfinite(row), round(head.axis)) for row in front[rows]], np.float64).T
    aside = np.stack([head.axis - outer[0], outer[1] - head.axis])
    outermost = np.isfinite(outer) & ((rows > high[1]) | (aside > bare - OUTERMOST_PIXELS))
    ear = np.ones(max(round(MAX_EAR_SHARE * float(high[1] - low[1])), 1), np.bool_)
    outermost = np.stack([binary_closing(np.pad(one, len(ear)), ear)[len(ear) : -len(ear)] for one in outermost])
    outermost |= rows < head.crown  # above, hair is all around
    within = np.clip(bare - 1, 1, MAX_BARE_SHARE * head.half)
    left, right = (
        gaussian_filter1d(np.where(there, own, head.axis + sign * inner), HAIR_ROW_SMOOTHING)
        for there, own, inner, sign in zip(np.isfinite(outer), outer, within, (-1, 1), strict=True)
    )
    wide = _known(np.fmax(np.fmax(*aside), 0.5), head.half)
    near = _near(hair[rows], front[rows], rows, head)
    both = _known(np.fmax(np.fmin(*aside), 0.5), head.half)  # hair that falls to one side stands off no back
    far = _far(back[rows], rows, both, head, hangs=bool((outermost & (rows > high[1])).any(1).all()))
    closed = _closing(rows, wide, head)
    near, far = (head.middle + closed * (one - head.middle) for one in (near, far))
    for ring, centre in ((left, head.axis), (right, head.axis), (near, head.middle), (far, head.middle)):
        ring[0] = centre + MIN_RADIUS_PIXELS * np.sign(ring[0] - centre)
    return HairRings(rows.astype(np.float64), left, right, near, far, outermost, head.axis, head.middle)


def _outline(hair: NDArray[np.bool_], axis: float) -> NDArray[np.float64]:
    """The columns (2, R) at which hair (R, w) ends outwards on the left and on the right of an `axis`, nan where a side has none."""
    columns = np.arange(hair.shape[1])
    left, right = hair & (columns < axis), hair & (columns > axis)
    first, last = left.argmax(1) - 0.5, hair.shape[1] - right[:, ::-1].argmax(1) - 0.5
    return np.stack([np.where(left.any(1), first, np.nan), np.where(right.any(1), last, np.nan)])


def _near(
    hair: NDArray[np.bool_], front: NDArray[np.float32], rows: NDArray[np.intp], head: _Skull
) -> NDArray[np.float64]:
    """How near (R,) hair (R, w) is: below the chin before all that it is seen to hide, whose `front` is known (R, w). Beside the head it is laid
    clear of that."""
    need = np.full(len(rows), np.nan)
    need[rows <= head.high[1]] = USUAL_FRONT_SHARE * head.depth
    for k in np.flatnonzero((rows > head.high[1]) & hair.any(1)):
        own = np.flatnonzero(hair[k])
        radius = np.maximum(np.where(own < head.axis, head.axis - own[0], own[-1] - head.axis) + 0.5, 1)
        cosine = np.sqrt(np.clip(1 - ((own - head.axis) / radius) ** 2, 0, 1))
        told = np.isfinite(front[k, own]) & (cosine > MIN_FRONT_COSINE)
        if told.any():
            before = front[k, own][told] + HAIR_CLEARANCE_PIXELS - head.middle
            need[k] = np.quantile(before / cosine[told], FRONT_QUANTILE)
    least, most = MIN_FRONT_SHARE * head.depth, MAX_FRONT_HAIR_SHARE * head.depth
    found = np.clip(_known(need, USUAL_FRONT_SHARE * head.depth), least, most)
    return np.asarray(head.middle + gaussian_filter1d(found, DEPTH_ROW_SMOOTHING, mode="nearest"))


def _far(
    back: NDArray[np.float32], rows: NDArray[np.intp], wide: NDArray[np.float64], head: _Skull, *, hangs: bool
) -> NDArray[np.float64]:
    """How far (R,) hair is: as far behind the head as it is `wide` (R,) of it on both sides, and closer and closer to what is behind it, whose `back` is known
    (R, w). From the chin down it `hangs`; else it keeps to the head from the ears down."""
    span = np.abs(np.arange(back.shape[1]) - head.axis) < head.half
    there = np.isfinite(back) & span & (rows >= head.crown)[:, None]
    behind = np.where(there.any(1), np.where(there, back, np.inf).min(1), np.nan)
    behind = _known(behind, float(head.low[2]))
    start = head.high[1] if hangs else (head.low[1] + head.high[1]) / 2
    closer = np.clip((rows - start) / max(rows[-1] - start, 1), 0, 1)
    stands_off = (1 - closer) * np.clip(wide - head.half, 0, MAX_BACK_HAIR_SHARE * head.depth)
    found = (np.minimum.accumulate(behind) if hangs else behind) - gaussian_filter1d(stands_off, DEPTH_ROW_SMOOTHING)
    clear = HAIR_CLEARANCE_PIXELS * np.clip(np.arange(len(rows)) / CLOSING_ROWS, 0, 1)
    return np.asarray(gaussian_filter1d(found, DEPTH_ROW_SMOOTHING, mode="nearest") - clear)


def _closing(rows: NDArray[np.intp], wide: NDArray[np.float64], head: _Skull) -> NDArray[np.float64]:
    """How deep (R,) hair is above the crown, as a share of how deep it is there: as its outline closes, and as a dome does."""
    count = int((rows < head.crown).sum())
    dome = np.sqrt(1 - (1 - np.arange(count) / max(count, 1)) ** 2)
    as_wide = wide[:count] / wide[min(count, len(wide) - 1)]
    return np.concatenate([np.clip(np.minimum(as_wide, dome), 0.02, 1), np.ones(len(rows) - count)])


def _reach(there: NDArray[np.bool_], column: int) -> tuple[int, int]:
    """For how many pixels a row (w,) goes on to the left and to the right of a column."""
    left, right = there[column::-1], there[column:]
    return tuple(int(len(one) if one.all() else one.argmin()) for one in (left, right))  # type: ignore[return-value]


def _known(values: NDArray[np.float64], otherwise: float) -> NDArray[np.float64]:
    """Values (R,) with those that are missing between their neighbours; all of them `otherwise` where none is known."""
    there = np.isfinite(values)
    at = np.arange(len(values))
    return np.interp(at, at[there], values[there]) if there.any() else np.full(len(values), otherwise)
