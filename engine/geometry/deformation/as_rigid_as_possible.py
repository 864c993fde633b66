"""Surfaces that are pulled at some of their points: the surroundings of each stay as rigid as they can.

Made ready and called as a `LaplacianDeformation` is: for a surface and its handles once, with any targets then.
"""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray

from engine.geometry.deformation.cotangent_laplacian import cotangent_edges, edge_differences
from engine.geometry.deformation.handles import Handles, HeldSystem
from engine.geometry.nearest_rotations import nearest_rotations

MAX_ROUNDS = 100
"""Rounds of an as-rigid-as-possible deformation, at most."""
MIN_ENERGY_DECREASE_SHARE = 1e-5
"""Share of the energy by which a round has to lessen it for another round to follow."""


class AsRigidAsPossible:
    """Keeps the surroundings of each vertex as rigid as the targets allow.

    Minimises the sum over vertices and their edges of weight / 2 * |edge - R * edge at rest|^2, plus what soft targets cost.
    Each vertex has a rotation R of its own. Vertices are solved for by rotations and rotations by vertices, in turns; the
    energy never rises. Weights are cotangents and without unit.

    Source: O. Sorkine, M. Alexa, As-rigid-as-possible surface modeling, SGP 2007.
    """

    def __init__(
        self,
        rest: NDArray[np.floating],
        triangles: NDArray[np.integer],
        handles: Handles,
        stiffness: NDArray[np.floating] | None = None,
    ):
        """Make ready.

        Parameters
        ----------
        rest, triangles : the surface, (V, 3) in any unit and (T, 3). Doubled vertices along seams of a texture are
            apart here: weld them first.
        stiffness : (V,) > 0, factors on the weights of the edges about each vertex, 1 by default: what has more keeps
            its shape sooner than others.

        Raises ValueError where a piece of the surface has no handle.
        """
        self._edges, weights = cotangent_edges(rest, triangles)
        if stiffness is not None:
            weights = weights * np.asarray(stiffness, np.float64)[self._edges].mean(1)
        self._weights = weights
        count = len(rest)
        self._differences = edge_differences(self._edges, count)
        self._about = sp.csr_array(abs(self._differences).T)
        self._spread = sp.csr_array(self._differences.T @ sp.diags_array(weights))
        self._system = HeldSystem(rest, self._spread @ self._differences, handles)
        self._at_rest = self._differences @ self._system.rest

    def __call__(
        self,
        held_at: NDArray[np.floating] | None = None,
        drawn_to: NDArray[np.floating] | None = None,
        start: NDArray[np.floating] | None = None,
        iterations: int = MAX_ROUNDS,
    ) -> NDArray[np.float64]:
        """The vertices (V, 3) float64 for the targets of the handles: `held_at` (H, 3), `drawn_to` (S, 3).

        Parameters
        ----------
        start : (V, 3) from where the search begins, as the frame before; by default the surface carried along with its
            targets. Held vertices need not be at their targets there.
        iterations : rounds at most, the first of which goes from `start`.

        Raises ValueError where targets are missing or not finite.
        """
        hard, soft = self._system.targets(held_at, drawn_to)
        if start is None:
            moved, rotations = self._system.carried(hard, soft)
        else:
            rotations = self._rotations(np.asarray(start, np.float64))
        before = np.inf
        for _ in range(max(iterations, 1)):
            turned = rotations[self._edges].mean(1)
            moved = self._system.solve(self._spread @ _apply(turned, self._at_rest), hard, soft, self._system.rest)
            rotations = self._rotations(moved)
            now = self._energy(moved, rotations, soft)
            if before - now <= MIN_ENERGY_DECREASE_SHARE * now:
                break
            before = now
        return moved

    def energy(self, moved: NDArray[np.floating], drawn_to: NDArray[np.floating] | None = None) -> float:
        """What is made least, of vertices (V, 3) with the best rotations, in the square of their unit."""
        vertices = np.asarray(moved, np.float64)
        _, soft = self._system.targets(vertices[self._system.handles.held], drawn_to)
        return self._energy(vertices, self._rotations(vertices), soft)

    def _energy(self, moved: NDArray[np.float64], rotations: NDArray[np.float64], soft: NDArray[np.float64]) -> float:
        edges = self._differences @ moved
        bent = sum(
            self._weights @ ((edges - _apply(rotations[self._edges[:, end]], self._at_rest)) ** 2).sum(1)
            for end in (0, 1)
        )
        handles = self._system.handles
        return float(bent / 2 + handles.weights @ ((handles.drawn @ moved - soft) ** 2).sum(1))

    def _rotations(self, moved: NDArray[np.float64]) -> NDArray[np.float64]:
        """(V, 3, 3) how each vertex's surroundings are turned from rest."""
        edges = self._differences @ moved
        products = self._weights[:, None, None] * self._at_rest[:, :, None] * edges[:, None, :]
        return nearest_rotations((self._about @ products.reshape(-1, 9)).reshape(-1, 3, 3))


def _apply(rotations: NDArray[np.float64], vectors: NDArray[np.float64]) -> NDArray[np.float64]:
    return np.asarray((rotations @ vectors[:, :, None])[:, :, 0])
