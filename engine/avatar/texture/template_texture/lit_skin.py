"""The skin around an eye as light as most of it is: a plane of colours through what is neither brow, lash nor shade.

What a shut lid is made of in `engine.face_animation.eyes.socket_skin`, where it is a curved surface of a picture.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from engine.face_animation.eyes.socket_skin import (
    LIT_CHEEK_SHARES,
    MIN_SKIN_DEVIATION_GREY_LEVELS,
    SKIN_RANGE_PERCENTILES,
)
from engine.face_animation.smoothstep import smoothstep
from engine.imaging.luminance import LUMINANCE_WEIGHTS

SLOPE_DOUBT = 0.02
"""Square of the eye widths over which colours are believed to change at all, beside how far around skin is seen."""
PLANE_ROUNDS = 6
"""Rounds of reweighted least squares."""


@dataclass(frozen=True)
class LitSkin:
    """plane : (4, 3) the colour at the origin, and by what it changes a width of the eye along x, y and z.
    range : (2, 3) between which colours stay.
    light : the luminance of skin.
    """

    plane: NDArray[np.float64]
    range: NDArray[np.float64]
    light: float

    @classmethod
    def around(cls, colours: NDArray[np.number], places: NDArray[np.floating], light: float) -> LitSkin:
        """That of texels with `colours` (M, 3) at `places` (M, 3), eye widths, around an eye below which skin has the luminance `light`."""
        shown, basis = np.asarray(colours, np.float64), _basis(places)
        skin = smoothstep(shown @ LUMINANCE_WEIGHTS / light, *LIT_CHEEK_SHARES)
        weights = skin
        for _ in range(PLANE_ROUNDS):
            level = SLOPE_DOUBT * weights.sum() * np.diag([0.0, 1.0, 1.0, 1.0])
            normal = basis.T @ (weights[:, None] * basis) + level + 1e-9 * np.eye(4)
            plane = np.linalg.solve(normal, basis.T @ (weights[:, None] * shown))
            away = np.linalg.norm(shown - basis @ plane, axis=1)
            usual = float(np.median(away[skin > 0.5])) if (skin > 0.5).any() else 0.0
            weights = skin / (1 + (away / (2 * max(usual, MIN_SKIN_DEVIATION_GREY_LEVELS))) ** 2) ** 2
        return cls(plane, np.percentile(shown[skin >= min(0.5, skin.max())], SKIN_RANGE_PERCENTILES, axis=0), light)

    def at(self, places: NDArray[np.floating]) -> NDArray[np.float64]:
        """(N, 3) the colours of skin at `places` (N, 3), eye widths."""
        return np.clip(_basis(places) @ self.plane, *self.range)

    def trust(self, colours: NDArray[np.number]) -> NDArray[np.float64]:
        """(N,) from 0 to 1, how far `colours` (N, 3) are of skin."""
        return smoothstep(np.asarray(colours) @ LUMINANCE_WEIGHTS / self.light, *LIT_CHEEK_SHARES)


def _basis(places: NDArray[np.floating]) -> NDArray[np.float64]:
    return np.concatenate([np.ones((len(places), 1)), np.asarray(places, np.float64)], 1)
