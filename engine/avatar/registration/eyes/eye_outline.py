"""Where lids end, as seen from straight ahead: between what outlines the template's rims lie, and where they lie between others.

Coordinates are of an eye: outwards (from the nose), up and ahead, in metres or in radii of the eyeball.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import PchipInterpolator

from engine.avatar.landmarks.spatial import LID_POINT_COUNT

ROUND_ENDS_WIDTH_SHARE = 0.12
"""Of the width at either corner, over which rims keep the template's rounding: landmarks of lids meet there in a point."""
OUTLINE_WIDTH_SHARE = 0.8
"""Of the width from the outer corner, within which the template's rims are the outline; farther in is flesh."""
OUTLINE_SHARES = np.linspace(ROUND_ENDS_WIDTH_SHARE, 1 - ROUND_ENDS_WIDTH_SHARE, 9)
"""Shares of the width at which outlines are compared."""


@dataclass(frozen=True)
class EyeOutline:
    """Where lids end, outwards and up.

    outer : (2,) the outer corner.
    inner : (2,) the inner corner.
    upper : (N, 2) the upper lid, from the outer to the inner corner.
    lower : (N, 2) the lower lid, likewise.
    """

    outer: NDArray[np.float64]
    inner: NDArray[np.float64]
    upper: NDArray[np.float64]
    lower: NDArray[np.float64]

    @property
    def width(self) -> float:
        """From corner to corner, outwards."""
        return float(self.outer[0] - self.inner[0])

    def share(self, outwards: NDArray[np.floating]) -> NDArray[np.float64]:
        """(N,) of the way from the outer corner to the inner one."""
        return np.asarray((self.outer[0] - outwards) / self.width)

    def level(self, share: NDArray[np.floating]) -> NDArray[np.float64]:
        """(N,) how high the line from corner to corner is there."""
        return np.asarray(self.outer[1] + share * (self.inner[1] - self.outer[1]))

    def lids(self, share: NDArray[np.floating]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """(N,) and (N,): how high the lower and the upper lid are there."""
        found = []
        for points in (self.lower, self.upper):
            line = np.stack([self.outer, *points, self.inner])
            across = self.share(line[:, 0])
            kept = np.concatenate([[True], np.diff(np.maximum.accumulate(across)) > 1e-6])
            found.append(np.asarray(PchipInterpolator(across[kept], line[kept, 1])(np.clip(share, 0, 1))))
        return found[0], found[1]


def outline_of_landmarks(lids: NDArray[np.floating]) -> EyeOutline:
    """The outline of landmarks (16, 2), outwards and up."""
    half = LID_POINT_COUNT // 2
    at = np.asarray(lids, np.float64)
    return EyeOutline(at[0], at[half], at[1:half], at[:half:-1])


def outline_of_rim(rim: NDArray[np.floating], inner: NDArray[np.floating]) -> EyeOutline:
    """The outline of the loop of vertices (R, 2) that is a rim, and of the `inner` corner (2,)."""
    at, tip = np.asarray(rim, np.float64), np.asarray(inner, np.float64)
    outer = at[np.argmax(at[:, 0])]
    share = (outer[0] - at[:, 0]) / (outer[0] - tip[0])
    own = (share > 0) & (share < OUTLINE_WIDTH_SHARE)
    above = at[:, 1] > outer[1] + share * (tip[1] - outer[1])
    by_share = np.argsort(share)
    upper, lower = (at[[k for k in by_share if own[k] and above[k] == side]] for side in (True, False))
    return EyeOutline(outer, tip, upper, lower)


def within(rim: NDArray[np.floating], own: EyeOutline, other: EyeOutline) -> NDArray[np.float64]:
    """(R, 2) where a rim (R, 2), whose outline is its `own`, lies in the `other`. It is scaled with the width, and
    moved up and down as the lids are apart. Corners stay as round as they were."""
    share = own.share(rim[:, 0])
    scale = other.width / own.width
    low, high = own.lids(share)
    height = np.clip((rim[:, 1] - low) / np.maximum(high - low, 1e-9), 0, 1)
    raised = []
    for mine, theirs in zip(own.lids(OUTLINE_SHARES), other.lids(OUTLINE_SHARES), strict=True):
        off = (theirs - other.level(OUTLINE_SHARES)) - scale * (mine - own.level(OUTLINE_SHARES))
        raised.append(np.interp(share, [0, *OUTLINE_SHARES, 1], [0, *off, 0]))
    up = other.level(share) + scale * (rim[:, 1] - own.level(share))
    return np.stack([other.outer[0] - share * other.width, up + raised[0] + height * (raised[1] - raised[0])], 1)
