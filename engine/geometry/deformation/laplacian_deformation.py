"""Surfaces that are pulled at some of their points: the rest follows smoothly.

A deformation is made ready once for a surface and its handles, and then called with any targets: the one system that it
solves is factorised when it is made ready. It carries each piece of the surface along with its targets first, so
that targets that are moved rigidly move the surface so. Vertices of no triangle stay where they are, but for their
own targets.
"""

from __future__ import annotations

from typing import Literal

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray

from engine.geometry.deformation.cotangent_laplacian import cotangent_laplacian
from engine.geometry.deformation.handles import Handles, HeldSystem
from engine.geometry.mesh.surface import vertex_areas


class LaplacianDeformation:
    """Spreads smoothly over the surface what its targets ask for beyond a rigid motion.

    The displacement d from the surface carried along with its targets minimises an energy plus what soft targets cost.
    With `order` 1 that is d' L d: harmonic, in the middle of what surrounds it, with creases at single targets. With
    `order` 2 it is d' L M^-1 L d: biharmonic, smooth there, too. L has cotangent weights; M are the vertices' areas as
    shares of their mean, so that weights of soft targets are without unit.

    Source: M. Botsch, O. Sorkine, On linear variational surface deformation methods, IEEE TVCG 14, 2008 (sections 3, 4).
    """

    def __init__(
        self,
        rest: NDArray[np.floating],
        triangles: NDArray[np.integer],
        handles: Handles,
        order: Literal[1, 2] = 2,
    ):
        """`rest` (V, 3) in any unit, `triangles` (T, 3). Raises ValueError where a piece of the surface has no handle."""
        stiffness = cotangent_laplacian(rest, triangles)
        if order == 2:
            areas = vertex_areas(rest, triangles)
            mean = float(areas[areas > 0].mean()) if (areas > 0).any() else 1.0
            shares = np.maximum(areas / mean, 1e-3)  # vertices of triangles without area count a little
            stiffness = sp.csr_array(stiffness @ sp.diags_array(1 / shares) @ stiffness)
        self._system = HeldSystem(rest, stiffness, handles)

    def __call__(
        self, held_at: NDArray[np.floating] | None = None, drawn_to: NDArray[np.floating] | None = None
    ) -> NDArray[np.float64]:
        """The vertices (V, 3) float64 for the targets of the handles: `held_at` (H, 3), `drawn_to` (S, 3).

        Raises ValueError where targets are missing or not finite.
        """
        system = self._system
        hard, soft = system.targets(held_at, drawn_to)
        carried, _ = system.carried(hard, soft)
        left = hard - carried[system.handles.held], soft - system.handles.drawn @ carried
        nothing = np.zeros_like(carried)
        moved = carried + system.solve(nothing, *left, idle=nothing)
        moved[system.handles.held] = hard
        return moved
