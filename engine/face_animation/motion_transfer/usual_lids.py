"""How far a driver's eyes are usually open, and shut: what a gap between lids is told from.

One frame does not tell. A driver whose eyes are narrower than usual in its neutral frame stares in every other one measured by that, and shuts its eyes
half. And a tracker sees lids that meet as a slit, wider under glare. A clip tells both: its eyes are usually as far open as in the median of the frames
that show them open, and they meet in its blinks.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import maximum_filter1d, minimum_filter1d

from engine.perception.face.landmarks import eye_opening

SHUT_SHARE = 0.3
"""Share of its usual gap below which an eye counts as shut: a tracker never reports none."""
SHUT_SHARE_RANGE = (SHUT_SHARE, 0.55)
"""Shares of the usual gap between which a clip's blinks may end: lids seen further apart are lowered."""
OPENS_OVER_SHARE = 0.3
"""Share of the usual gap above that of a shut eye, over which a gap comes to be carried as it is."""
OPEN_SHARE_OF_WIDEST, WIDE_QUANTILE = 0.5, 0.9
"""Share of the gap of wide eyes from which on a frame shows them open, and the quantile of all gaps that wide eyes have."""
USUAL_RANGE = (0.67, 1.5)
"""Multiples of the neutral frame's gap between which the usual one is: a person is at rest there."""
BLINK_DEPTH_SHARE = 0.35
"""Share of the usual gap by which lids fall and rise in a blink, at least."""
BLINK_FALLS_SECONDS, BLINK_RISES_SECONDS = 0.2, 0.4
"""Seconds within which lids fall, and rise again, in a blink: twice what they take (`driver_tracking.lid_speed`). Who squints or looks down takes longer."""


@dataclass(frozen=True)
class UsualLids:
    """A driver's lids, in multiples of the gap that its neutral frame has.

    opening : the usual gap. shut : that of lids that meet. opened : from which on a gap is carried as it is.
    """

    opening: float = 1.0
    shut: float = SHUT_SHARE
    opened: float = SHUT_SHARE + OPENS_OVER_SHARE


AS_AT_REST = UsualLids()
"""Of a driver of whom no more is known than its face at rest."""


def usual_lids(meshes: NDArray[np.floating], neutral: int, fps: float) -> UsualLids:
    """Those of a clip's meshes (N, 478, 2 or 3), both eyes together, against its `neutral` frame."""
    gaps = eye_opening(meshes).mean(axis=1)
    gaps = gaps / max(float(gaps[neutral]), 1e-6)
    seen_open = gaps[gaps >= OPEN_SHARE_OF_WIDEST * np.quantile(gaps, WIDE_QUANTILE)]
    opening = float(np.clip(np.median(seen_open), *USUAL_RANGE))
    bottoms = blink_bottoms(gaps / opening, fps)
    share = float(np.clip(np.median(bottoms), *SHUT_SHARE_RANGE)) if len(bottoms) else SHUT_SHARE
    opened = min((share + OPENS_OVER_SHARE) * opening, 1.0)  # the neutral frame's eyes are open
    return UsualLids(opening, opened * share / (share + OPENS_OVER_SHARE), opened)


def blink_bottoms(gaps: NDArray[np.floating], fps: float) -> NDArray[np.float64]:
    """(K,) the least gap in each of K blinks of lids with these `gaps` (N,), shares of the usual one."""
    fall, rise = (max(1, round(seconds * fps)) for seconds in (BLINK_FALLS_SECONDS, BLINK_RISES_SECONDS))
    least = gaps == minimum_filter1d(gaps, 2 * fall + 1, mode="nearest")
    least[1:] &= gaps[1:] != gaps[:-1]  # lids that stay shut for a while count once
    before = maximum_filter1d(gaps, fall + 1, origin=fall // 2, mode="nearest")
    after = maximum_filter1d(gaps, rise + 1, origin=-((rise + 1) // 2), mode="nearest")
    least &= (gaps <= SHUT_SHARE_RANGE[1]) & (np.minimum(before, after) - gaps >= BLINK_DEPTH_SHARE)
    return np.asarray(gaps[least], np.float64)
