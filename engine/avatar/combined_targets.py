"""Morph targets that are mixtures of others: those that browsers' talking heads ask for beside ARKit's units and the visemes.

Names as Ready Player Me's avatars had them, for which most players of such avatars were written.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

COMBINED_TARGETS: Mapping[str, Mapping[str, float]] = {
    "mouthOpen": {"jawOpen": 1.0},
    "mouthSmile": {"mouthSmileLeft": 1.0, "mouthSmileRight": 1.0},
    "eyesClosed": {"eyeBlinkLeft": 1.0, "eyeBlinkRight": 1.0},
    "eyesLookUp": {"eyeLookUpLeft": 1.0, "eyeLookUpRight": 1.0},
    "eyesLookDown": {"eyeLookDownLeft": 1.0, "eyeLookDownRight": 1.0},
}
"""What each is made of."""


def with_combined_targets(displacements: Mapping[str, NDArray[np.float32]]) -> dict[str, NDArray[np.float32]]:
    """All displacements (V, 3) by name, and those of `COMBINED_TARGETS` after them."""
    combined = {
        name: sum((np.float32(weight) * displacements[unit] for unit, weight in parts.items()), start=np.float32(0))
        for name, parts in COMBINED_TARGETS.items()
    }
    return {**displacements, **{name: np.asarray(moved, np.float32) for name, moved in combined.items()}}
