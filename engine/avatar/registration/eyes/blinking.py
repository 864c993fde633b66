"""Where the lids of the fitted face meet as a blink ends."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from engine.avatar.registration.template_skin.skin import Skin
from engine.body.template import Template

EYE_OF_BLINK_UNIT: Mapping[str, str] = {"eyeBlinkLeft": "left_eye", "eyeBlinkRight": "right_eye"}
"""The face units of a closed eye, and which it is."""


@dataclass(frozen=True)
class MeetingRims:
    """Where the U vertices `upper` of an upper lid's rim end in a blink: between two of the lower lid's, `between` (U, 2), by
    `shares` (U,) from the first to the second. All are the template's vertices."""

    upper: NDArray[np.intp]
    between: NDArray[np.intp]
    shares: NDArray[np.float64]

    def gap(self, vertices: NDArray[np.floating]) -> NDArray[np.float64]:
        """(U, 3) from where the lower rim has the places to where the upper has them, for the template's `vertices` (V, 3)."""
        return np.asarray(vertices[self.upper] - self.lower(vertices))

    def lower(self, vertices: NDArray[np.floating]) -> NDArray[np.float64]:
        """(U, 3) the places on the lower lid's rim."""
        first, second = (np.asarray(vertices, np.float64)[self.between[:, k]] for k in (0, 1))
        return np.asarray(first + self.shares[:, None] * (second - first))


def meeting_rims(template: Template, skin: Skin, blink: str) -> MeetingRims:
    """Where the lids of one eye meet: each place of the upper lid's rim, between the corners, above the lower's, as they are in the
    template."""
    rim = skin.vertices[skin.regions[f"{EYE_OF_BLINK_UNIT[blink]}_rim"]]
    rim = rim[np.argsort(template.vertices[rim, 0])]
    across, height, _ = template.vertices[rim].astype(np.float64).T
    upper = height > np.interp(across, across[[0, -1]], height[[0, -1]])
    below, upper = np.flatnonzero(~upper), np.flatnonzero(upper)
    after = np.clip(np.searchsorted(across[below], across[upper]), 1, len(below) - 1)
    between = np.stack([below[after - 1], below[after]], 1)
    width = np.maximum(across[between[:, 1]] - across[between[:, 0]], 1e-9)
    return MeetingRims(rim[upper], rim[between], (across[upper] - across[between[:, 0]]) / width)
