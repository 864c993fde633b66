"""What no camera sees of the head's skin, the mouth's inside and the sockets, brought along with what it sees."""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray
from scipy.sparse.csgraph import connected_components
from scipy.sparse.linalg import splu

from engine.avatar.registration.skin import Skin
from engine.geometry.adjacency import neighbours
from engine.geometry.winding_number import winding_numbers

SHRINK_STEP, MIN_SHARE = 0.03, 0.4
"""By how much of itself a piece that sticks out is shrunk at a time, and to what share of itself at least."""
FULL_DEPTH = 0.02
"""Metres behind its rim from which on a piece is shrunk fully; at the rim it stays."""
RIM_DEPTH = 0.006
"""Metres from the rim's middle within which lips may hold what is inside out."""
MIN_PIECE = 20
"""Vertices of a piece that could stick out."""


def inner_skin(skin: Skin, before: NDArray[np.floating], after: NDArray[np.floating]) -> NDArray[np.float64]:
    """The skin `after` (S, 3) the fit, with what of the mouth is not seen set anew, from where it was `before` (S, 3).

    It moves as smoothly as its rim asks for (the bi-Laplacian of the displacement). Then it is shrunk towards the rim's
    middle until it lies inside of the head.
    """
    inner = skin.regions["inner"]
    beside = neighbours(skin.triangles, len(inner))
    laplacian = sp.csr_array(sp.diags_array(beside.sum(1)) - beside)
    bend = sp.csr_array(laplacian.T @ laplacian)[inner]
    moved = np.asarray(after, np.float64) - before
    out = np.array(after, np.float64)
    out[inner] = before[inner] + splu(sp.csc_array(bend[:, inner])).solve(-(bend[:, ~inner] @ moved[~inner]))
    numbers = np.flatnonzero(inner)
    count, piece = connected_components(beside[numbers][:, numbers], directed=False)
    for k in range(count):
        own = numbers[piece == k]
        if len(own) >= MIN_PIECE:
            out[own] = _shrunk_inside(skin, out, own, _rim(beside, own, inner))
    return out


def _rim(beside: sp.csr_array, own: NDArray[np.intp], inner: NDArray[np.bool_]) -> NDArray[np.intp]:
    """The vertices that are seen and next to a piece."""
    around = np.asarray(beside[own].sum(0)).ravel() > 0
    return np.flatnonzero(around & ~inner)


def _shrunk_inside(
    skin: Skin, vertices: NDArray[np.float64], own: NDArray[np.intp], rim: NDArray[np.intp]
) -> NDArray[np.float64]:
    """The places (M, 3) of a piece's vertices `own` (M,) as large as they fit into the head's visible skin."""
    middle, full = vertices[rim].mean(0), vertices[own]
    depth = np.linalg.norm(full - middle, axis=1)
    share = np.clip(depth / FULL_DEPTH, 0, 1)[:, None]
    outside_counts = depth > RIM_DEPTH
    hull = skin.triangles[skin.visible & skin.regions["head"][skin.triangles].any(1)]
    for scale in np.arange(1, MIN_SHARE - 1e-9, -SHRINK_STEP):
        places = middle + (full - middle) * (1 - (1 - scale) * share)
        if (winding_numbers(places[outside_counts], vertices, hull) > 0.5).all():
            break
    return places
