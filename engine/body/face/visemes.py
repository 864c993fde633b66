"""Forms of the mouth for sounds, from ARKit's face units: the fifteen visemes of Oculus' lip synchronisation.

What each looks like is told, with pictures, in the documentation of Oculus' lip synchronisation (Viseme reference); the
weights here are this project's.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray


def _both(name: str, weight: float) -> dict[str, float]:
    return {f"{name}Left": weight, f"{name}Right": weight}


VISEMES: Mapping[str, Mapping[str, float]] = {
    "viseme_sil": {},
    "viseme_PP": {**_both("mouthPress", 0.6), "mouthRollLower": 0.3, "mouthRollUpper": 0.3},
    "viseme_FF": {"jawOpen": 0.1, "mouthRollLower": 0.6, **_both("mouthUpperUp", 0.3), "mouthShrugLower": 0.2},
    "viseme_TH": {"jawOpen": 0.2, **_both("mouthLowerDown", 0.2), "tongueOut": 0.4},
    "viseme_DD": {"jawOpen": 0.15, **_both("mouthUpperUp", 0.2), **_both("mouthLowerDown", 0.3)},
    "viseme_kk": {"jawOpen": 0.2, **_both("mouthStretch", 0.15), **_both("mouthUpperUp", 0.15)},
    "viseme_CH": {"jawOpen": 0.1, "mouthFunnel": 0.5, **_both("mouthLowerDown", 0.2), **_both("mouthUpperUp", 0.2)},
    "viseme_SS": {"jawOpen": 0.05, **_both("mouthStretch", 0.3), **_both("mouthLowerDown", 0.25)},
    "viseme_nn": {"jawOpen": 0.15, **_both("mouthLowerDown", 0.2), **_both("mouthUpperUp", 0.1)},
    "viseme_RR": {"jawOpen": 0.15, "mouthFunnel": 0.3, "mouthPucker": 0.2},
    "viseme_aa": {"jawOpen": 0.6, **_both("mouthLowerDown", 0.2)},
    "viseme_E": {"jawOpen": 0.3, **_both("mouthStretch", 0.3), **_both("mouthLowerDown", 0.2)},
    "viseme_I": {"jawOpen": 0.2, **_both("mouthSmile", 0.25), **_both("mouthStretch", 0.3)},
    "viseme_O": {"jawOpen": 0.35, "mouthFunnel": 0.6},
    "viseme_U": {"jawOpen": 0.15, "mouthPucker": 0.7, "mouthFunnel": 0.2},
}
"""The weights of face units in each viseme, by its name in characters made for them. Silence is the face at rest."""


def viseme_displacements(
    units: Mapping[str, NDArray[np.floating]], vertex_count: int
) -> dict[str, NDArray[np.float32]]:
    """(V, 3) float32 metres by viseme, from the displacements (V, 3) of face units by name.

    Raises KeyError where a face unit is missing.
    """
    found = {}
    for name, weights in VISEMES.items():
        total = np.zeros((vertex_count, 3), np.float32)
        for unit, weight in weights.items():
            total += np.float32(weight) * units[unit].astype(np.float32)
        found[name] = total
    return found
