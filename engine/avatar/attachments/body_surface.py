"""The fitted skin, from which things stand off."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from engine.geometry.mesh.closest_points import closest_points
from engine.geometry.mesh.surface import vertex_normals


@dataclass(frozen=True)
class BodySurface:
    """The fitted skin.

    vertices : (S, 3) metres.
    triangles : (T, 3), closed, counter-clockwise from outside.
    own : (S,) bool, the skin that stays by itself, since it has models of its own: hands and feet.
    face : (S,) bool, brows and what is below, to both sides as far as the ears.
    head : (S,) bool, all of the head.
    """

    vertices: NDArray[np.float64]
    triangles: NDArray[np.int32]
    own: NDArray[np.bool_]
    face: NDArray[np.bool_]
    head: NDArray[np.bool_]

    def without_own(self) -> BodySurface:
        """The skin without the triangles of what stays by itself: no hand hides the hip that it hangs beside, and none moves it."""
        return replace(self, triangles=self.triangles[~self.own[self.triangles].any(1)])

    def distances(self, points: NDArray[np.floating]) -> NDArray[np.float64]:
        """(N,) metres from the skin to `points` (N, 3), negative within it."""
        asked = np.asarray(points, np.float64)
        near = closest_points(asked, self.vertices, self.triangles)
        foot, normal = (
            near.interpolated(of, self.triangles)
            for of in (self.vertices, vertex_normals(self.vertices, self.triangles))
        )
        inside = np.einsum("nd,nd->n", asked - foot, normal) < 0
        return np.where(inside, -near.distance, near.distance)

    def beside_head(self, points: NDArray[np.floating]) -> NDArray[np.bool_]:
        """(N,) which of the `points` (N, 3) have the head's skin nearest."""
        return self.head[self.nearest(points)]

    def nearest(self, points: NDArray[np.floating]) -> NDArray[np.intp]:
        """(N,) which vertex of the skin is nearest to each of the `points` (N, 3)."""
        return np.asarray(cKDTree(self.vertices).query(points)[1], np.intp)
