"""Ears as far forward as frames show them: under hair nothing else tells, and the skull's hair takes them along to the back."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from engine.avatar.registration.template_skin.skin import Skin
from engine.geometry.deformation.smooth_field import smooth_field
from engine.geometry.rigging.joint_names import SIDE_NAMES

EAR_LANDMARK_SIGMA_METRES = 0.008
"""Metres by which the landmark of an ear is off along the way that the face looks, usually: -1, 0, 3 and 8 mm of four ears in films of
360x640. It lies 15 mm above the ear's middle, and 20 mm within the head."""
EAR_SURROUNDINGS_METRES = 0.04
"""Metres about an ear within which the skin of the head comes along."""


def with_ears_seen(
    skin: Skin, vertices: NDArray[np.float64], seen: Mapping[str, NDArray[np.floating]], ahead: NDArray[np.floating]
) -> NDArray[np.float64]:
    """The skin (S, 3) with each ear of which a landmark was `seen` (3,), `LeftEar` or `RightEar`, brought there along `ahead` (3,), the
    unit vector along which the level head looks.

    The landmark says how far forward the ear's front edge is, and nothing else well. Of how far off it is, what may be noise is taken
    away (W. James, C. Stein, Estimation with quadratic loss, 1961): an ear that is nearer than that stays. The ear is moved as a whole,
    the skin about it smoothly.
    """
    out = vertices.copy()
    for side in SIDE_NAMES:
        if f"{side}Ear" not in seen:
            continue
        ear = skin.regions[f"{side.lower()}_ear"]
        off = float(seen[f"{side}Ear"] @ ahead - (vertices[ear] @ ahead).max())
        told = off * max(0.0, 1 - (EAR_LANDMARK_SIGMA_METRES / max(abs(off), 1e-9)) ** 2)
        away = np.linalg.norm(vertices[:, None] - vertices[ear][None, ::4], axis=2).min(1)
        around = skin.regions["head"] & (away < EAR_SURROUNDINGS_METRES) & ~ear
        out += smooth_field(skin.triangles, around, told * ear[:, None] * ahead)
    return out
