"""How far what lies in a face has to be set back, so that its skin covers it whatever it does."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from engine.geometry.rigging.joint_names import SIDE_NAMES
from engine.persona.puppet import Puppet
from engine.persona.results.face_units import FaceUnits
from engine.render.rasterisation.rasteriser import depth_map

PIXELS_PER_EYE_DISTANCE = 64
"""Of an eye distance, in the pictures in which it is looked at."""
HALF_EXTENT_EYE_DISTANCES = 2.5
"""Eye distances from between the eyes that the pictures show."""
SKIN_CLEARANCE_EYE_DISTANCES = 0.015
"""Eye distances by which everything stays behind the skin: a millimetre."""


class BehindSkin:
    """Of a `puppet` with openings: its face at rest, and as each of its `units` moves it, those of both sides together, too."""

    def __init__(self, puppet: Puppet, units: FaceUnits):
        self._puppet, self._units = puppet, units

    def needed(self, vertices: NDArray[np.floating], moved: Mapping[str, NDArray[np.float64]]) -> NDArray[np.float64]:
        """(V,) eye distances by which `vertices` (V, 3), of a head from the front, have to go back, that face units move by `moved`
        (V, 3)."""
        needed = np.zeros(len(vertices))
        for units, depths in zip(self._faces, self._depths, strict=True):
            places = vertices + sum((moved[unit] for unit in units if unit in moved), np.zeros((1, 3)))
            columns, rows = np.rint((places[:, :2] + HALF_EXTENT_EYE_DISTANCES) * PIXELS_PER_EYE_DISTANCE).astype(int).T
            inside = (rows >= 0) & (rows < len(depths)) & (columns >= 0) & (columns < len(depths))
            skin = np.where(inside, depths[rows.clip(0, len(depths) - 1), columns.clip(0, len(depths) - 1)], np.inf)
            covered = np.isfinite(skin)
            needed[covered] = np.maximum(needed[covered], (skin + SKIN_CLEARANCE_EYE_DISTANCES - places[:, 2])[covered])
        return needed

    @cached_property
    def _faces(self) -> list[tuple[str, ...]]:
        names = self._units.names
        both = {name.removesuffix(SIDE_NAMES[0]) for name in names if name.endswith(SIDE_NAMES[0])}
        return [
            (),
            *((name,) for name in names),
            *(tuple(f"{name}{side}" for side in SIDE_NAMES) for name in sorted(both)),
        ]

    @cached_property
    def _depths(self) -> list[NDArray[np.float32]]:
        """(H, W) of each face, infinite where there is no skin."""
        rest = self._puppet.vertices(self._puppet.persona.neutral)
        side = round(2 * HALF_EXTENT_EYE_DISTANCES * PIXELS_PER_EYE_DISTANCE)
        found = []
        for units in self._faces:
            skin = rest + self._puppet.finer(self._units.doing(dict.fromkeys(units, 1.0)) + np.zeros((478, 3)))
            skin[:, :2] = (skin[:, :2] + HALF_EXTENT_EYE_DISTANCES) * PIXELS_PER_EYE_DISTANCE
            found.append(depth_map(skin, self._puppet.surface.triangles, (side, side)))
        return found
