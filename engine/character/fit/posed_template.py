"""The fitted template on the grid on which a character is made: as it is pictured, and at rest."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from engine.character.fit.template_maps import SideMaps, side_maps


@dataclass(frozen=True)
class TemplateSides:
    """Some `triangles` (T, 3) of the template, seen from both sides."""

    triangles: NDArray[np.int32]
    front: SideMaps
    back: SideMaps


@dataclass(frozen=True)
class PosedTemplate:
    """The fitted template on the grid on which a character is made.

    vertices : (V, 3) metres in picture space.
    rest : (V, 3) metres in T-pose.
    triangles : (T, 3).
    joints : (J, 3) in picture space.
    rest_joints : (J, 3) in T-pose.
    """

    vertices: NDArray[np.float64]
    rest: NDArray[np.float32]
    triangles: NDArray[np.int32]
    joints: NDArray[np.float64]
    rest_joints: NDArray[np.float32]
    pixels_per_metre: float

    def covers(self, chosen: NDArray[np.bool_], shape: Sequence[int]) -> NDArray[np.bool_]:
        """The pixels (h, w) of a grid that `chosen` triangles (T,) cover."""
        return side_maps(self.vertices, self.triangles[chosen], (shape[0], shape[1]), "front").mask

    def shows(self, chosen: NDArray[np.bool_], shape: Sequence[int]) -> NDArray[np.bool_]:
        """The pixels (h, w) of a grid at which `chosen` triangles (T,) are nearest of all."""
        seen = side_maps(self.vertices, self.triangles, (shape[0], shape[1]), "front")
        return np.asarray(seen.mask & chosen[seen.raster.triangle])

    def sides(self, chosen: NDArray[np.bool_], shape: Sequence[int]) -> TemplateSides:
        """`chosen` triangles (T,) seen from both sides, on a grid (h, w)."""
        triangles, size = self.triangles[chosen], (shape[0], shape[1])
        front, back = (side_maps(self.vertices, triangles, size, side) for side in ("front", "back"))
        return TemplateSides(triangles, front, back)
