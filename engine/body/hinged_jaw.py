"""What a jaw that opens does to the skin: the mandible turns about its hinges before the ears, and the skin over it goes along.

The lower teeth of the template's `jawOpen` turn so, by 21 degrees, but its skin is drawn by hand: the chin becomes a wedge, and the
lower lip a V. Here the skin of the chin and of the jaw's edge goes where the teeth go, that of the skull stays, and between
them skin goes by a share that changes as little as it can: a linear blend skinning whose weights are a bi-Laplacian field (O. Sorkine
et al., Laplacian surface editing, 2004, for such fields).
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from engine.body.mouth_skin import MouthSkin
from engine.geometry.deformation.smooth_field import smooth_field

MANDIBLE_WEIGHT = 0.7
"""What the jaw's bone has at least of the skin over the chin and the jaw's edge, which goes with it wholly."""
CHEEK_METRES = 0.016
"""Metres about the rims of the lips in which no skin goes wholly with the jaw: from there on it passes to the corners."""
SKULL_SHARE = 0.04
"""Skin that the template's drawn `jawOpen` takes along by less, as a share of where the jaw goes, stays with the skull."""
CORNER_SHARE = 0.4
"""Share of the jaw's motion that the corners of the mouth have."""
CLOSED_LIPS_SHARE = 0.15
"""Share of the jaw's motion that lips have which are closed while the jaw is open."""
CLOSING_METRES = 0.04
"""Metres about the rims of the lips in which skin of the chin is drawn up by lips that close over an open jaw."""


def hinged_jaw(
    skin: MouthSkin, drawn: NDArray[np.floating], turned: NDArray[np.floating]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """What opens the jaw, and what then closes the lips: displacements (S, 3) each, metres.

    `drawn` (S, 3) is what opened the jaw before, and `turned` (S, 3) where all of the skin would go with the lower teeth.
    """
    count = len(skin.vertices)
    within = skin.within()
    upper, lower = skin.rims()
    rims = np.concatenate([upper, lower])
    away = cKDTree(skin.vertices[rims]).query(skin.vertices)[0]
    whole = (skin.jaw > MANDIBLE_WEIGHT) & (away > CHEEK_METRES) & ~within
    stays = ((drawn * turned).sum(1) < SKULL_SHARE * (turned**2).sum(1)) & ~within & ~whole
    opened, closed = whole.astype(np.float64), whole.astype(np.float64)
    aside = np.abs(skin.vertices[:, 0]) / np.abs(skin.vertices[rims, 0]).max()
    height = np.sqrt(np.clip(1 - aside**2, 0, 1))  # an ellipse's: an open mouth is round at its corners
    opened[upper] = CORNER_SHARE * (1 - height[upper])
    opened[lower] = CORNER_SHARE + (1 - CORNER_SHARE) * height[lower]
    rim = np.isin(np.arange(count), rims)
    shut = rim | skin.lips
    closed[shut] = CLOSED_LIPS_SHARE
    drawn_up = whole & (away < CLOSING_METRES) & ~shut
    opened = smooth_field(skin.triangles, ~(whole | stays | rim), opened[:, None])
    closed = smooth_field(skin.triangles, drawn_up | ~(whole | stays | shut), closed[:, None])
    return opened * turned, (closed - opened) * turned
