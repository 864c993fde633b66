"""How films are taken: as they should be, or with one of the faults that people make, of which each has to be found out."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

Orbit = Literal["whole", "half", "none"]
WALK_START_SHARE = 0.45
"""Share of a film after which somebody who does not stay begins to walk."""
WALK_END_SHARE = 0.6
"""Share of a film after which somebody who walked stands again."""
COMPANY_METRES = (0.95, 0.0, -0.1)
"""Where a second person stands beside the first."""


@dataclass(frozen=True)
class Conditions:
    """What may differ from a good film."""

    hurry: float = 1.0
    """How many times as fast as it should be."""
    exposure_seconds: float = 1 / 50
    """Of each frame; as long as indoors."""
    exposure_moments: int = 4
    """Moments of an exposure that are drawn: the more, the longer the blur."""
    tremor: float = 1.0
    """How many times as much the hand trembles."""
    brightness: float = 1.0
    """Share of the light that should be."""
    orbit: Orbit = "whole"
    """How far round the camera goes."""
    walk_metres: float = 0.0
    """How far the subject goes away to its left in the middle of the film."""
    company: bool = False
    """Whether somebody else stands beside."""

    def round_about(self, degrees: NDArray[np.float64]) -> NDArray[np.float64]:
        """(N,) where the camera is instead of (N,) `degrees` round the subject: half an orbit goes to and fro."""
        if self.orbit == "none":
            return np.zeros_like(degrees)
        if self.orbit == "half":
            return np.asarray(90 * (1 - np.cos(np.radians(degrees / 2))))
        return degrees

    def walked(self, share: float) -> NDArray[np.float64]:
        """(3,) metres from where the subject should stand, at a share of the film."""
        t = float(np.clip((share - WALK_START_SHARE) / (WALK_END_SHARE - WALK_START_SHARE), 0, 1))
        return np.array([self.walk_metres * t * t * (3 - 2 * t), 0, 0])


NAMED_CONDITIONS = {
    "good": Conditions(),
    "no-orbit": Conditions(orbit="none"),
    "half-orbit": Conditions(orbit="half"),
    "too-fast": Conditions(hurry=10, exposure_moments=12),
    "blurred": Conditions(exposure_seconds=0.5, exposure_moments=24, tremor=12),
    "dark": Conditions(brightness=0.015),
    "walks-away": Conditions(walk_metres=1.6),
    "two-people": Conditions(company=True),
}
"""By name, the good ones first."""
