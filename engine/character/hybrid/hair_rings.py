"""Rings around a head that hair makes, row by row: how wide it is seen to be, and how deep it is before and behind what it hides."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import gaussian_filter1d

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
BEHIND_THE_EAR_RADIANS, AT_THE_NAPE_RADIANS = 1.9, 2.7
"""Radians from the front at which hair begins on a side that shows none, at the ears' height, and at the chin's."""
USUAL_FRONT_SHARE, MIN_FRONT_SHARE = 0.25, 0.1
"""How far before the head's middle hair is where nothing tells, and at least, as shares of the head's depth."""
FRONT_QUANTILE = 0.9
"""Quantile of how far before the middle the pixels of a row need hair to be."""
MAX_BARE_SHARE = 0.9
"""How far aside hair is on a side that shows none, as a share of half of the head's width at most: within its outline."""
CLOSING_ROWS = 4
"""Rows from the crown on in which hair is laid clear of what is beneath it more and more."""


@dataclass(frozen=True)
class HairRings:
    """Of each row of hair, (R,) each.

    rows : where it is.
    left, right : its outline.
    inner_left, inner_right : where hair ends towards the face; nan on a side that shows none.
    ends : radians from the front at which hair begins on such a side.
    meets : radians from the front at which both sides meet: behind, or where a lock that falls on one side alone ends.
    near, far : how deep it is in front and behind, z of picture space.
    axis, middle : the column and the depth of the head's middle, of all rows.
    """

    rows: NDArray[np.float64]
    left: NDArray[np.float64]
    right: NDArray[np.float64]
    inner_left: NDArray[np.float64]
    inner_right: NDArray[np.float64]
    ends: NDArray[np.float64]
    meets: NDArray[np.float64]
    near: NDArray[np.float64]
    far: NDArray[np.float64]
    axis: float
    middle: float

    def half(self, right: bool) -> NDArray[np.float64]:
        """How far aside (R,) the outline is."""
        return np.asarray(self.right - self.axis if right else self.axis - self.left)

    def opening(self, right: bool) -> NDArray[np.float64]:
        """Radians from the front (R,) at which hair begins on a side."""
        inner = self.inner_right - self.axis if right else self.axis - self.inner_left
        share = np.clip(inner / np.maximum(self.half(right), 1.0), -1, 1)
        found = np.where(np.isfinite(inner), np.arcsin(share), self.ends)
        return np.asarray(gaussian_filter1d(found, HAIR_ROW_SMOOTHING))


def hair_rings(
    hair: NDArray[np.bool_],
    skull: NDArray[np.float64],
    front: NDArray[np.float32],
    back: NDArray[np.float32],
    face_column: float,
) -> HairRings:
    """The rings of `hair` (h, w) around the vertices of a `skull` (N, 3), picture space.

    `front`, `back` (h, w): how near and how far what is shown of the person besides reaches, infinite where nothing is. `face_column`: that of the
    face's middle, at which hair parts.
    """
    first, last = np.flatnonzero(hair.any(1))[[0, -1]]
    rows = np.arange(first, last + 1)
    low, high = skull.min(0), skull.max(0)
    axis, half = float(np.median(skull[:, 0])), float(high[0] - low[0]) / 2
    top = float(low[1] + CROWN_SHARE * (high[1] - low[1]))
    outer, inner = _sides(hair[rows], round(face_column))
    near, far = _depths(hair[rows], (front[rows], back[rows]), rows >= top, outer, (low, high), axis)
    bare = np.array([_reach(np.isfinite(row), round(axis)) for row in front[rows]]).T
    within = np.clip(bare - 1, 1, MAX_BARE_SHARE * half)
    left, right = (
        gaussian_filter1d(
            np.where(np.isfinite(outer[side]), outer[side], axis + sign * within[side]), HAIR_ROW_SMOOTHING
        )
        for side, sign in enumerate((-1, 1))
    )
    waist = float(np.median(skull[:, 1]))
    lower = np.clip((rows - waist) / max(float(high[1]) - waist, 1), 0, 1)
    ends = BEHIND_THE_EAR_RADIANS + lower * (AT_THE_NAPE_RADIANS - BEHIND_THE_EAR_RADIANS)
    meets = _meeting(np.isfinite(outer), rows > high[1])
    middle = float(low[2] + high[2]) / 2
    return HairRings(rows.astype(np.float64), left, right, inner[0], inner[1], ends, meets, near, far, axis, middle)


def _meeting(there: NDArray[np.bool_], below: NDArray[np.bool_]) -> NDArray[np.float64]:
    """Radians from the front (R,) at which the sides of rings meet, which have hair or not, `there` (2, R): `below` (R,) the chin a lock that falls
    on one side alone goes no further than that."""
    meets = np.full(len(below), np.pi)
    meets[below & there[1] & ~there[0]] = BEHIND_THE_EAR_RADIANS
    meets[below & there[0] & ~there[1]] = 2 * np.pi - BEHIND_THE_EAR_RADIANS
    return np.asarray(gaussian_filter1d(meets, DEPTH_ROW_SMOOTHING, mode="nearest"))


def _sides(hair: NDArray[np.bool_], centre: int) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """The columns (2, R) at which hair (R, w) ends outwards and towards the face, on the left and on the right of its `centre`, nan where a side
    has none."""
    outer, inner = np.full((2, 2, len(hair)), np.nan)
    for k, row in enumerate(hair):
        own = np.flatnonzero(row)
        left, right = own[own <= centre], own[own >= centre]
        if len(left):
            outer[0, k], inner[0, k] = left[0] - 0.5, centre if row[centre] else left[-1] + 0.5
        if len(right):
            outer[1, k], inner[1, k] = right[-1] + 0.5, centre if row[centre] else right[0] - 0.5
    return outer, inner


def _depths(
    hair: NDArray[np.bool_],
    shown: tuple[NDArray[np.float32], NDArray[np.float32]],
    beside: NDArray[np.bool_],
    outer: NDArray[np.float64],
    skull: tuple[NDArray[np.float64], NDArray[np.float64]],
    axis: float,
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """How near and how far (R,) hair is: before all that it is seen to hide, as far behind the head as it is wide of it, and hanging down from
    there. Above the skull, which is `beside` (R,) the others, it closes as its outline does."""
    low, high = skull
    middle, size, half = float(low[2] + high[2]) / 2, float(high[2] - low[2]), float(high[0] - low[0]) / 2
    columns = np.arange(hair.shape[1])
    need, behind = np.full((2, len(hair)), np.nan)
    for k in np.flatnonzero(beside & hair.any(1)):
        own = np.flatnonzero(hair[k])
        radius = np.maximum(np.where(own < axis, axis - own[0], own[-1] - axis) + 0.5, 1)
        cosine = np.sqrt(np.clip(1 - ((own - axis) / radius) ** 2, 0, 1))
        depth = shown[0][k, own]
        told = np.isfinite(depth) & (cosine > MIN_FRONT_COSINE)
        if told.any():
            need[k] = np.quantile((depth[told] + HAIR_CLEARANCE_PIXELS - middle) / cosine[told], FRONT_QUANTILE)
        span = (np.abs(columns - axis) < half) & np.isfinite(shown[1][k])
        if span.any():
            behind[k] = shown[1][k][span].min()
    wide = np.fmax(np.fmax(axis - outer[0], outer[1] - axis), 0.5)
    wide = _known(wide, half)
    stands_off = gaussian_filter1d(np.clip(wide - half, 0, MAX_BACK_HAIR_SHARE * size), DEPTH_ROW_SMOOTHING)
    near = middle + np.clip(_known(need, USUAL_FRONT_SHARE * size), MIN_FRONT_SHARE * size, MAX_FRONT_HAIR_SHARE * size)
    far = np.minimum.accumulate(_known(behind, float(low[2])) - stands_off)
    near, far = (gaussian_filter1d(one, DEPTH_ROW_SMOOTHING, mode="nearest") for one in (near, far))
    crown = int(np.argmax(beside)) if beside.any() else len(hair) - 1
    share = np.clip(wide[:crown] / wide[crown], 0.02, 1)
    near[:crown], far[:crown] = middle + share * (near[crown] - middle), middle + share * (far[crown] - middle)
    return near, far - HAIR_CLEARANCE_PIXELS * np.clip(np.arange(len(hair)) / CLOSING_ROWS, 0, 1)


def _reach(there: NDArray[np.bool_], column: int) -> tuple[int, int]:
    """For how many pixels a row (w,) goes on to the left and to the right of a column."""
    left, right = there[column::-1], there[column:]
    return tuple(int(len(one) if one.all() else one.argmin()) for one in (left, right))  # type: ignore[return-value]


def _known(values: NDArray[np.float64], otherwise: float) -> NDArray[np.float64]:
    """Values (R,) with those that are missing between their neighbours; all of them `otherwise` where none is known."""
    there = np.isfinite(values)
    at = np.arange(len(values))
    return np.interp(at, at[there], values[there]) if there.any() else np.full(len(values), otherwise)
