"""What is known at some vertices of a surface, carried over to others as smoothly as can be."""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray
from scipy.sparse.linalg import splu

from engine.geometry.mesh.adjacency import neighbours


def smooth_field(
    triangles: NDArray[np.integer],
    free: NDArray[np.bool_],
    values: NDArray[np.floating],
    pull: NDArray[np.floating] | None = None,
) -> NDArray[np.float64]:
    """`values` (V, C) with those of the vertices that are `free` (V,) where the bi-Laplacian, all edges alike, is least.

    `pull` (V,), by default none: by how much free vertices keep to the values that they have, against a Laplacian of one edge.
    """
    bend = bending_of(triangles, len(free))
    own = np.zeros(len(free)) if pull is None else np.asarray(pull, np.float64)
    known = np.asarray(values, np.float64)
    system = sp.csc_array(bend[free][:, free] + sp.diags_array(own[free]))
    out = known.copy()
    out[free] = splu(system).solve(own[free, None] * known[free] - bend[free][:, ~free] @ known[~free])
    return out


def bending_of(triangles: NDArray[np.integer], count: int) -> sp.csr_array:
    """(V, V) sparse: the bi-Laplacian of a surface of `count` vertices, all edges alike."""
    beside = neighbours(triangles, count)
    laplacian = sp.csr_array(sp.diags_array(beside.sum(1)) - beside)
    return sp.csr_array(laplacian.T @ laplacian)
