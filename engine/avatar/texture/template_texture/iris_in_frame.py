"""Where an iris is in a frame: nobody looks straight ahead all the time, and a fitted eye is off by a millimetre."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from engine.performances.modelling.eyes import IRIS_RADIUS

SEARCH_RADIUS_METRES, SEARCH_STEP_METRES = 0.55 * IRIS_RADIUS, 0.1 * IRIS_RADIUS
"""Metres to either side within which an iris is looked for, and between places that are tried."""
IRIS_RADII, WHITE_RADII = 0.8, (1.15, 1.7)
"""Radii of the iris within which it is dark, and between which the white about it is light."""
MIN_IRIS_SAMPLE_COUNT = 12
"""Samples of each, without which a place is not tried."""
REACH_CONTRAST_LOSS_SHARE = 0.05
"""Of the contrast, what a place at the end of the reach has less for it: of two alike the nearer is it."""


def iris_centre(places: NDArray[np.floating], lightness: NDArray[np.floating]) -> NDArray[np.float64]:
    """(2,) metres from straight ahead to where an iris is: where within it is darker than about it by most.

    `places` (N, 2) metres across an eyeball of the radius of `engine.performances.modelling.eyes`, those that a frame shows,
    with their `lightness` (N,).
    """
    steps = np.arange(-SEARCH_RADIUS_METRES, SEARCH_RADIUS_METRES + SEARCH_STEP_METRES / 2, SEARCH_STEP_METRES)
    best, found = 0.0, np.zeros(2)
    for centre in np.stack(np.meshgrid(steps, steps), -1).reshape(-1, 2):
        off = np.hypot(*(places - centre).T) / IRIS_RADIUS
        dark, light = lightness[off < IRIS_RADII], lightness[(off > WHITE_RADII[0]) & (off < WHITE_RADII[1])]
        if min(len(dark), len(light)) < MIN_IRIS_SAMPLE_COUNT:
            continue
        contrast = (light.mean() - dark.mean()) * (
            1 - REACH_CONTRAST_LOSS_SHARE * float(centre @ centre) / SEARCH_RADIUS_METRES**2
        )
        if contrast > best:
            best, found = contrast, centre
    return found
