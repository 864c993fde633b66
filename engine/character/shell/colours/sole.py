"""How dark the line is at which a shoe's upper meets its sole, and what is below it: shoes that are seen from before hardly show it."""

from __future__ import annotations

from functools import cache

import numpy as np
from numpy.typing import NDArray

from engine.body.garments.shoes import sole_bottom, sole_thickness
from engine.character.fit.template_fit import load_human
from engine.character.shell.extremities import in_shoes, shoe_shapes
from engine.character.shell.template_mesh import template_mesh

SEAM_METRES = 0.0022
"""Metres: standard deviation across the line."""
SEAM_SHADE_SHARE, SOLE_SHADE_SHARE = 0.4, 0.12
"""Share of the light that the line lacks, and that the sole lacks below it."""
BESIDE_SHOES_METRES = 1.0
"""Metres above a sole that stand for no shoe."""


@cache
def above_the_sole() -> NDArray[np.float32]:
    """Metres (V,) by which each vertex of the mesh is above its shoe's sole, on the mean body; once for the process."""
    mesh = template_mesh()
    places = in_shoes(load_human().space.mean[mesh.ids])
    skin, above = np.flatnonzero(~mesh.eye), np.full(len(places), BESIDE_SHOES_METRES)
    for mask in shoe_shapes()[0]:
        foot = skin[mask]
        height, along = places[foot, 1] - places[foot, 1].min(), places[foot, 2]
        length = np.ptp(along)
        share = (along - along.min()) / length
        above[foot] = height - length * (sole_bottom(share) + sole_thickness(share))
    return above.astype(np.float32)


def sole_shade(above: NDArray[np.floating]) -> NDArray[np.float32]:
    """Share of the light (...) that is left so many metres `above` a sole."""
    seam = np.exp(-0.5 * (above / SEAM_METRES) ** 2)
    below = np.clip(0.5 - above / SEAM_METRES, 0, 1)
    return np.asarray((1 - SEAM_SHADE_SHARE * seam) * (1 - SOLE_SHADE_SHARE * below), np.float32)
