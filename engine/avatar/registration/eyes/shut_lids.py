"""An upper lid's skin as it lies on the eyeball of a shut eye, and the eyeball that draws back before it.

Lids slide on a ball, and a morph target moves along straight lines, which cut it. An eye draws back by one or two millimetres
as it blinks (C. Evinger et al., Blinking and associated eye movements in humans, guinea pigs, and rabbits, Journal of
Neurophysiology 52, 1984). So does an avatar's, by as much as those lines need.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from engine.avatar.registration.eyes.eyeballs import sphere
from engine.avatar.registration.eyes.tucked_lids import LidColumns
from engine.face_animation.smoothstep import smoothstep

SHUT_LID_METRES = 0.0008
"""Metres from the eyeball to the skin of a lid before it."""
THIN_RIM_SHARE, ON_EYEBALL_SHARE = 0.2, 0.6
"""Of a lid's skin from its rim to its fold, the share over which it gets as thick as it is, and the share from which on it
leaves the eyeball for the fold."""
BLINK_GAP_METRES = 0.0002
"""Metres that are left before an eyeball at any moment of a blink."""
MAX_DRAWN_BACK_METRES = 0.002
"""By which eyes draw back, at most."""
BLINK_STEPS = 16
"""Moments of a blink that are looked at."""


def shut_lid(
    places: NDArray[np.floating], rim: NDArray[np.floating], ends: NDArray[np.floating], eyeball: NDArray[np.floating]
) -> NDArray[np.float64]:
    """(C, K, 3) where the columns of an upper lid, which are at `places` (C, K, 3) with the eye open, are with it shut; metres.

    The skin from the `rim` (R, 3) to the fold comes out of its tuck and is spread over the arc about the middle of the `eyeball`
    (E, 3) from the lower lid, where a column's rim `ends` (C, 3), to the fold. It lies on the ball as thick as a lid is, and
    turns up to the fold, which is its crease. What is beyond stays.
    """
    out = np.asarray(places, np.float64).copy()
    middle, radius = sphere(np.asarray(eyeball, np.float64))
    thick = radius + SHUT_LID_METRES
    for column, up, end in zip(out, LidColumns.of(places, rim).up(), np.asarray(ends, np.float64), strict=True):
        lid = up < 1
        share = up[lid]
        fold = np.array([np.interp(1, up, column[:, axis]) for axis in range(3)])
        first, last = np.linalg.norm(end - middle), np.linalg.norm(fold - middle)
        reach = thick + (first - thick) * (1 - smoothstep(share, 0, THIN_RIM_SHARE))
        reach += (last - thick) * smoothstep(share, ON_EYEBALL_SHARE, 1)
        column[lid] = middle + reach[:, None] * _arc((end - middle) / first, (fold - middle) / last, share)
    return out


def drawn_back(
    eyeball: NDArray[np.floating], rest: NDArray[np.floating], moved: NDArray[np.floating], way: NDArray[np.floating]
) -> float:
    """Metres by which an `eyeball` (E, 3) that looks along a unit `way` (3,) draws back in a blink, so that skin at `rest` (N, 3) stays
    before it with any share of its displacements `moved` (N, 3), and the ball with the same share of its own."""
    middle, radius = sphere(np.asarray(eyeball, np.float64))
    shares = np.arange(1, BLINK_STEPS + 1) / BLINK_STEPS
    away = rest + shares[:, None, None] * moved - middle
    ahead = away @ way
    room = (radius + BLINK_GAP_METRES) ** 2 - ((away**2).sum(2) - ahead**2)
    needed = np.where(room > 0, np.sqrt(np.maximum(room, 0)) - ahead, 0) / shares[:, None]
    return float(np.clip(needed.max(), 0, MAX_DRAWN_BACK_METRES))


def _arc(first: NDArray[np.float64], last: NDArray[np.float64], shares: NDArray[np.float64]) -> NDArray[np.float64]:
    """(N, 3) unit vectors at `shares` (N,) of the turn from one to the other."""
    angle = max(float(np.arccos(np.clip(first @ last, -1, 1))), 1e-6)
    along = np.sin((1 - shares) * angle)[:, None] * first + np.sin(shares * angle)[:, None] * last
    return np.asarray(along / np.sin(angle))
