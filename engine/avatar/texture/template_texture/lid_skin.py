"""The colours of a shut upper lid, whose skin no frame shows while the eye is open.

A smooth skin spans from the lower lid's to that above the fold: the membrane between two lines that change slowly is straight
from one to the other.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from engine.face_animation.eyes.socket_skin import LIT_CHEEK_SHARES
from engine.face_animation.smoothstep import smoothstep
from engine.imaging.luminance import LUMINANCE_WEIGHTS

KNOTS = 17
"""Places from corner to corner of an eye at which colours are told."""
KNOT_EYE_WIDTHS = 0.12
"""Widths of an eye over which colours are smoothed from corner to corner."""
DOUBT = 0.25
"""Share of the texels above a fold that have to be skin for their colours to count as much as the lower lid's."""


@dataclass(frozen=True)
class LidSkin:
    """below, above : (`KNOTS`, 3) colours from corner to corner, of the lower lid's skin and of what is above the fold, where that is
    skin.
    """

    below: NDArray[np.float64]
    above: NDArray[np.float64]

    @classmethod
    def between(
        cls,
        below: NDArray[np.number],
        below_across: NDArray[np.floating],
        above: NDArray[np.number],
        above_across: NDArray[np.floating],
    ) -> LidSkin:
        """That between texels with the colours `below` (N, 3) the eye and `above` (M, 3) its fold, which are `across` (N,), (M,) widths of
        the eye from its first corner. Brows, lashes and shade are told by their light, and left out: what is above is then that
        below."""
        light = float(np.median(below @ LUMINANCE_WEIGHTS))
        lower = _along(below, below_across, _lit(below, light), 0.0, np.median(below, axis=0))
        upper = _along(above, above_across, _lit(above, light), DOUBT, lower)
        return cls(lower, upper)

    def at(self, across: NDArray[np.floating], up: NDArray[np.floating]) -> NDArray[np.float64]:
        """(N, 3) the colours at places `across` (N,), and `up` (N,) of the way from the rim to the fold."""
        knots = np.linspace(0, 1, KNOTS)
        lower, upper = (
            np.stack([np.interp(across, knots, colours[:, k]) for k in range(3)], 1)
            for colours in (self.below, self.above)
        )
        return np.asarray(lower + np.clip(up, 0, 1)[:, None] * (upper - lower))


def _lit(colours: NDArray[np.number], light: float) -> NDArray[np.float64]:
    return smoothstep(colours @ LUMINANCE_WEIGHTS / max(light, 1.0), *LIT_CHEEK_SHARES)


def _along(
    colours: NDArray[np.number],
    across: NDArray[np.floating],
    trust: NDArray[np.float64],
    doubt: float,
    otherwise: NDArray[np.float64],
) -> NDArray[np.float64]:
    """(`KNOTS`, 3) the means of `colours` (N, 3) near each knot by their `trust` (N,), beside which those `otherwise` count by `doubt`."""
    near = np.exp(-(((np.linspace(0, 1, KNOTS)[:, None] - across) / KNOT_EYE_WIDTHS) ** 2) / 2)
    weights = near * trust / (near.sum(1, keepdims=True) + 1e-6)
    doubted = doubt + 1e-6
    return np.asarray(
        (weights @ np.asarray(colours, np.float64) + doubted * otherwise) / (weights.sum(1, keepdims=True) + doubted)
    )
