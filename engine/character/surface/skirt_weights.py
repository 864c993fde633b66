"""Cloth round both legs is moved by both: from one to the other what moves it goes over, rather than tear between them.

Beyond the paper, which carries the template's skinning weights over: those of two legs.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import gaussian_filter1d

from engine.body.rig import MIN_SKIN_WEIGHT, Rig
from engine.character.parts.free_cloth import FADE_LENGTH_FACTOR, FreeCloth
from engine.character.surface.front_and_back import Layer
from engine.character.surface.part_surface import Surface

LEG_BLEND_SHARE = 0.8
"""Share of the width over which cloth goes over from one leg to the other: with all of it, it stretches least; with less,
legs come out of a hem where they are."""
MIN_LEG_BLEND_SHARE = 0.3
"""Share of the width over which cloth goes over from one leg to the other, at least: where legs stand close."""
MIN_LEG_PIXELS = 0.5
"""Pixels of a row that each leg moves where both begin to move cloth."""
LEG_JOINT_NAMES = ("Leg", "Foot", "Toe")
"""What is in the names of the legs' joints."""


def moved_by_both(body: Layer, cloth: FreeCloth, rig: Rig) -> Layer:
    """The body whose cloth goes with both legs: a skirt from the waist on, what goes on in trousers from the crotch on.
    Where legs come from under it they begin to."""
    left, right = (
        np.array([name.startswith(side) and any(part in name for part in LEG_JOINT_NAMES) for name in rig.names])
        for side in ("Left", "Right")
    )
    front, back = body.front.weights.copy(), body.back.weights.copy()
    mean = np.array([np.concatenate([one[ring.row, ring.first : ring.last + 1] for one in (front, back)]).mean(0)
                     for ring in cloth.rings])  # fmt: skip
    mean = gaussian_filter1d(mean, cloth.even, axis=0, mode="nearest")
    both = mean[:, left | right].sum(1, keepdims=True)
    by_left, by_right = (both * _share_of(mean, own, rig.index(thigh))
                         for own, thigh in ((left, "LeftUpLeg"), (right, "RightUpLeg")))  # fmt: skip
    mean[:, left | right] = 0
    towards = _towards(body, cloth, left, right)
    middle, steep = _between_legs(cloth, towards)

    def span(k: int, row: int, columns: NDArray[np.intp], share: float) -> None:
        across = cloth.rings[k].across(columns) - middle[k]
        to_left = np.clip(0.5 + towards * across * steep[k] / 2, 0, 1)[:, None]
        whole = mean[k] + to_left * by_left[k] + (1 - to_left) * by_right[k]
        for one in (front, back):
            one[row, columns] += share * (whole - one[row, columns])

    share = cloth.begins(0 if cloth.hangs else cloth.above)
    for k, row, columns in cloth.rows():
        span(k, row, columns, share[k])
    if not cloth.goes_on and not cloth.parted:
        first, fading = cloth.rings[-1].row + 1, FADE_LENGTH_FACTOR * cloth.even
        for row in range(first, min(first + round(fading), len(body.mask))):
            legs = np.flatnonzero(cloth.worn[row] & ~cloth.lower[row])
            span(len(cloth.rings) - 1, row, legs, 1 - (row - first) / fading)
    return replace(body, front=Surface(body.front.depth, front), back=Surface(body.back.depth, back))


def _between_legs(cloth: FreeCloth, towards: float) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """For each ring (n,) where between its ends, from -1 to 1, it goes over from leg to leg, and how steeply: at the hem between
    the legs, so that each moves the cloth around it. Where they have changed sides there, as of somebody who strides and is
    seen from their side, it goes with both alike: it is wide enough for them, and would be turned inside out."""
    rows = np.arange(len(cloth.rings))
    ends = np.array([(ring.first, ring.last) for ring in cloth.rings])
    half = np.maximum((ends[:, 1] - ends[:, 0]) / 2, 1)
    legs = (np.array([ring.legs for ring in cloth.rings]) - ends.mean(1)[:, None]) / half[:, None]
    seen = np.isfinite(legs).all(1)
    middle, steep = np.zeros(len(rows)), np.full(len(rows), 1 / LEG_BLEND_SHARE)
    if not seen.any():
        return middle, steep
    left, right = (gaussian_filter1d(np.interp(rows, rows[seen], legs[seen, side]), cloth.even, mode="nearest")
                   for side in (0, 1))  # fmt: skip
    down = np.clip((rows - cloth.above) / max(len(rows) - 1 - cloth.above, 1), 0, 1)
    if towards * (left - right)[-1] < 0:
        return middle, (1 - down) * steep
    reach = np.clip(
        abs(left - right) / 2, LEG_BLEND_SHARE + down * (MIN_LEG_BLEND_SHARE - LEG_BLEND_SHARE), LEG_BLEND_SHARE
    )
    return down * np.clip((left + right) / 2, -1, 1), 1 / reach


def _share_of(weights: NDArray[np.floating], own: NDArray[np.bool_], otherwise: int) -> NDArray[np.floating]:
    """Which shares joints have in what their `own` (J,) move together (n, J); all of it `otherwise` where they move nothing."""
    chosen = np.where(own, weights, 0.0)
    chosen[:, otherwise] += MIN_SKIN_WEIGHT
    return np.asarray(chosen / chosen.sum(1, keepdims=True))


def _towards(body: Layer, cloth: FreeCloth, left: NDArray[np.bool_], right: NDArray[np.bool_]) -> float:
    """1 where the left leg begins at the viewer's right, as with those who face them; -1 otherwise. Beneath, legs may cross."""
    rows = slice(cloth.rings[0].row, cloth.rings[-1].row + 1)
    weights, across = body.front.weights[rows] * body.mask[rows, :, None], np.arange(body.mask.shape[1])
    columns = np.stack([weights[..., own].sum(2) for own in (left, right)])
    begins = np.flatnonzero((columns.sum(2) > MIN_LEG_PIXELS).all(0))[: round(FADE_LENGTH_FACTOR * cloth.even)]
    if not len(begins):
        return 1.0
    at = [(one * across).sum() / one.sum() for one in columns[:, begins]]
    return 1.0 if at[0] >= at[1] else -1.0
