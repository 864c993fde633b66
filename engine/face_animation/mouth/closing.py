"""Parted lips that close as a whole: each lip with its thickness, and the skin around them with it.

Pressed together at their inner edges alone lips swell, and what was between them shows as dots.
"""

from __future__ import annotations

from functools import cache

import numpy as np
from numpy.typing import NDArray

from engine.face_animation.mouth.lip_contours import LOWER_INNER_LIP, UPPER_INNER_LIP
from engine.face_animation.mouth.lips_and_skin import LIP_COLUMNS
from engine.face_animation.mouth.skin_around_lips import with_lips
from engine.face_animation.smoothstep import smoothstep
from engine.perception.face.landmarks import mouth_opening

UPPER_SHARE = 0.6
"""Of the gap, that the upper lip goes down: teeth that a smile bares are the upper ones."""
PARTED_OPENINGS = (0.04, 0.08)
"""Openings of a mouth, its gap over its width, up to which its lips count as closed, and from which on as parted."""
PARTED_SHARES = (0.2, 0.6)
"""Shares of a target's opening up to which its driver's mouth counts as closed beside it, and from which on as parted, too."""
LIP_GAP_SHARES = (0.15, 0.5)
"""Shares of its usual gap at which a mouth whose lips are usually parted has closed, and begins to."""


class ClosingLips:
    """A target's lips, which close where its driver's do.

    Where the `target` (478, 3) has parted lips and the driver's `rest` (478, 3), which stands for it, closed ones, the
    target's are closed at rest, too. Everything it acts begins there. Where both are parted they close with one
    another.
    """

    def __init__(self, rest: NDArray[np.floating], target: NDArray[np.floating]):
        own, drivers = float(mouth_opening(target)), float(mouth_opening(rest))
        self._usual = max(drivers, PARTED_OPENINGS[0])
        parted = smoothstep(own, *PARTED_OPENINGS)
        self._at_rest = parted * (1 - smoothstep(drivers / max(own, 1e-6), *PARTED_SHARES))
        self._meets = max(parted, smoothstep(drivers, *PARTED_OPENINGS))
        top, bottom = _inner_edges()
        self._gap = np.linalg.norm(target[bottom].astype(float) - target[top], axis=-1)

    def met(self, meshes: NDArray[np.floating]) -> NDArray[np.float64]:
        """(N,) how far the lips of the driver's meshes (N, 478, 3) have met; 0 where they and the target's are closed at rest."""
        left = np.asarray(mouth_opening(meshes)) / self._usual
        return np.asarray(self._meets * (1 - smoothstep(left, *LIP_GAP_SHARES)))

    def close(self, positions: NDArray[np.floating], meshes: NDArray[np.floating], strength: float) -> None:
        """Close the lips of the target at `positions` (N, 478, 3) as those of the driver's `meshes` (N, 478, 3) are, in place; `strength` in [0, 1]."""
        top, bottom = _inner_edges()
        gap = positions[:, bottom] - positions[:, top]
        left = 1 - np.clip(self._at_rest * self._gap / np.maximum(np.linalg.norm(gap, axis=-1), 1e-6), 0, 1)
        share = strength * (1 - (1 - self.met(meshes)[:, None]) * left)
        upper, lower = lip_influence()
        positions += np.einsum("vk,nkd->nvd", UPPER_SHARE * upper - (1 - UPPER_SHARE) * lower, share[..., None] * gap)


@cache
def lip_influence() -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """(478, 9) each, how much a vertex goes along with each of nine columns of the upper lip, and of the lower: all of it in the lip itself,
    none at the other one's."""
    columns = np.array(LIP_COLUMNS).reshape(-1, len(LIP_COLUMNS[0][0]))
    vertices = columns.ravel()
    upper, lower = np.split(with_lips(vertices, np.repeat(np.eye(len(columns)), columns.shape[1], axis=0)), 2, axis=1)
    return upper, lower


def _inner_edges() -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """(9,) each, the vertices, column by column, of the inner edges of the upper and the lower lip."""
    return np.array(UPPER_INNER_LIP[1:-1]), np.array(LOWER_INNER_LIP[1:-1])
