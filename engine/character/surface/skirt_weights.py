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
STRIDE_DEGREES = 35.0
"""Degrees by which a thigh swings in a long stride."""
MIN_FOLLOWING_SHARE = 0.3
"""How far the widest cloth goes with the legs: a bell swings as its wearer walks."""
MAX_FOLLOWING_RISE = 0.6
"""By how much more cloth may go with the legs at its hem than further up: a hem that went with legs far apart alone would trail."""
HIPS_ABOVE_CROTCH_FACTOR = 4.0
"""How far the hips' joints are above the crotch, in units of the length over which cloth changes."""
INNER_CLOTH_SHARE = 0.7
"""Share of a ring's width, about its middle, in which is measured how far it stands off: at its ends front and back meet."""
LEG_JOINT_NAMES = ("Leg", "Foot", "Toe")
"""What is in the names of the legs' joints."""


def moved_by_both(body: Layer, cloth: FreeCloth, rig: Rig, bare: Layer) -> Layer:
    """The body whose cloth goes with both legs: a skirt from the waist on, what goes on in trousers from the crotch on.
    Where legs come from under it they begin to. `bare`: the body before its cloth was draped."""
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
    follows = following(body, bare, cloth) if cloth.hangs else np.ones((len(mean), 2))
    mean[:, left | right] = 0
    towards, hips = _towards(body, cloth, left, right), rig.index("Hips")
    middle, steep = _between_legs(cloth, towards)

    def span(k: int, row: int, columns: NDArray[np.intp], share: float) -> None:
        across = cloth.rings[k].across(columns) - middle[k]
        to_left = np.clip(0.5 + towards * across * steep[k] / 2, 0, 1)[:, None]
        aside = (cloth.rings[k].across(columns)[:, None] + 1) / 2
        follow = (1 - aside) * follows[k, 0] + aside * follows[k, 1]
        whole = mean[k] + follow * (to_left * by_left[k] + (1 - to_left) * by_right[k])
        whole[:, hips] += (1 - follow[:, 0]) * both[k]
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


def following(body: Layer, bare: Layer, cloth: FreeCloth) -> NDArray[np.float64]:
    """How far (n, 2), from 0 to 1, each ring goes with the legs at its first and its last column: so far that they stay in it in
    a stride of `STRIDE_DEGREES`. A leg comes forward by its drop beneath the hips times the stride's sine; what cloth
    stands off need not go with it, and goes with the hips. `bare`: the body before its cloth was draped."""
    slack = np.zeros((len(cloth.rings), 2))
    for k, row, columns in list(cloth.rows())[: len(cloth.rings)]:
        ring = cloth.rings[k]
        inner = columns[np.abs(ring.across(columns)) < INNER_CLOTH_SHARE]
        leg, deep = (
            float(np.nanmean(one.front.depth[row, inner] - one.back.depth[row, inner])) / 2 for one in (bare, body)
        )
        beside = np.array([np.fmin(*ring.legs) - ring.first, ring.last - np.fmax(*ring.legs)]) - leg
        slack[k] = np.fmin(deep - leg, beside)
    drop = np.maximum(np.arange(len(slack)) - cloth.above, 0) + HIPS_ABOVE_CROTCH_FACTOR * cloth.even
    reach = drop * np.sin(np.radians(STRIDE_DEGREES))
    share = np.clip(1 - np.nan_to_num(slack) / reach[:, None], MIN_FOLLOWING_SHARE, 1)
    rise = MAX_FOLLOWING_RISE * np.arange(len(share))[:, None] / len(share)
    share = np.minimum.accumulate(share - rise) + rise
    return np.asarray(gaussian_filter1d(share, FADE_LENGTH_FACTOR * cloth.even, axis=0, mode="nearest"))


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
