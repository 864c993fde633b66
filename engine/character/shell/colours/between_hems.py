"""Colours of a garment's sides without folds, but for what begins or ends on all of its sides at one height."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from engine.imaging.filling.between_steps import smoothed_between, steps_of_all

HEM_WINDOW_METRES, MIN_HEM_LEVELS, HEM_SHADE_SHARE = 0.0125, 18.0, 0.5
"""Metres before and after a row over which its sides are compared, sRGB levels by which they step where one garment or stripe goes over
into the next, and the share in that of what is lighter or darker: cloth has folds."""
FOLD_METRES = 0.05
"""Metres over which folds average out between hems."""


def between_hems(
    values: NDArray[np.floating], sure: NDArray[np.bool_], row: float, soft: float = 0.0
) -> NDArray[np.float32]:
    """Values (A, S, C) of a garment's sides, the first three of them colours, sRGB levels, averaged over `FOLD_METRES` along it but over no
    hem, belt or stripe. `sure` (A, S): which are seen; `row`: metres of one; `soft`: metres on either side
    of a hem in which colours are mixed."""
    hues = values[..., :3] - (1 - HEM_SHADE_SHARE) * values[..., :3].mean(-1, keepdims=True)
    told = sure | ~sure.any(1, keepdims=True)
    steps = steps_of_all(hues, told, round(HEM_WINDOW_METRES / row), MIN_HEM_LEVELS)
    return smoothed_between(values, steps, FOLD_METRES / row, round(soft / row))
