"""Cloth round both legs is moved by both: from one to the other what moves it goes over, rather than tear between them.

Beyond the paper, which carries the template's skinning weights over: those of two legs.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import gaussian_filter1d

from engine.body.rig import TINY, Rig
from engine.character.free_cloth import FADE, FreeCloth
from engine.character.part_surface import Surface
from engine.character.sheets import Layer

SPAN = 0.8
"""Share of the width over which cloth goes over from one leg to the other: with all of it, it stretches least; with less,
legs come out of a hem where they are."""
LEG = ("Leg", "Foot", "Toe")
"""What is in the names of the legs' joints."""


def moved_by_both(body: Layer, cloth: FreeCloth, rig: Rig) -> Layer:
    """The body whose cloth goes with both legs: a skirt from the waist on, what goes on in trousers from the crotch on.
    Where legs come from under it they begin to."""
    left, right = (
        np.array([name.startswith(side) and any(part in name for part in LEG) for name in rig.names])
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

    def span(k: int, row: int, columns: NDArray[np.intp], share: float) -> None:
        to_left = np.clip(0.5 + towards * cloth.rings[k].across(columns) / (2 * SPAN), 0, 1)[:, None]
        whole = mean[k] + to_left * by_left[k] + (1 - to_left) * by_right[k]
        for one in (front, back):
            one[row, columns] += share * (whole - one[row, columns])

    share = cloth.begins(0 if cloth.hangs else cloth.above)
    for k, row, columns in cloth.rows():
        span(k, row, columns, share[k])
    if not cloth.goes_on:
        first, fading = cloth.rings[-1].row + 1, FADE * cloth.even
        for row in range(first, min(first + round(fading), len(body.mask))):
            legs = np.flatnonzero(cloth.worn[row] & ~cloth.lower[row])
            span(len(cloth.rings) - 1, row, legs, 1 - (row - first) / fading)
    return replace(body, front=Surface(body.front.depth, front), back=Surface(body.back.depth, back))


def _share_of(weights: NDArray[np.floating], own: NDArray[np.bool_], otherwise: int) -> NDArray[np.floating]:
    """Which shares joints have in what their `own` (J,) move together (n, J); all of it `otherwise` where they move nothing."""
    chosen = np.where(own, weights, 0.0)
    chosen[:, otherwise] += TINY
    return np.asarray(chosen / chosen.sum(1, keepdims=True))


def _towards(body: Layer, cloth: FreeCloth, left: NDArray[np.bool_], right: NDArray[np.bool_]) -> float:
    """1 where the left leg is at the viewer's right, as with those who face them; -1 otherwise. Within the cloth, since
    beneath it legs may cross."""
    rows = slice(cloth.rings[0].row, cloth.rings[-1].row + 1)
    weights, across = body.front.weights[rows] * body.mask[rows, :, None], np.arange(body.mask.shape[1])
    legs = [weights[..., own].sum((0, 2)) for own in (left, right)]
    at = [(columns * across).sum() / max(columns.sum(), TINY) for columns in legs]
    return 1.0 if at[0] >= at[1] else -1.0
