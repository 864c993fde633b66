"""What a smile does to the cheeks: the skin beside the lips goes along smoothly, and what it leaves no room for bulges.

The template's smiles are drawn by hand, and end in a ledge above the corners of the mouth that stands like a line in any light. Lips
keep what was drawn. The skin about them keeps what is broad of it: a bi-Laplacian field that is drawn to it (O. Sorkine et al.,
Laplacian surface editing, 2004, for such fields). Soft tissue keeps its volume, so that where the skin grows narrower it
comes out (M. Teschner et al., A versatile and robust model for geometrically complex deformable solids, 2004, for this constraint).
"""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray
from scipy.sparse.linalg import splu
from scipy.spatial import cKDTree

from engine.body.mouth_skin import MouthSkin
from engine.geometry.deformation.smooth_field import bending_of, smooth_field
from engine.geometry.mesh.surface import vertex_normals

DRAWN_PULL = 2.0
"""Weight of the drawn smile against the bi-Laplacian of one edge, which is 4 mm long: ledges narrower than 4 cm go."""
STILL_METRES = 0.001
"""Metres by which a drawn smile moves skin at least that is to move."""
TISSUE_THICKNESS_METRES = 0.008
"""Metres of soft tissue beneath the skin of a cheek, which keeps its volume."""
BULGE_REACH_EDGES = 5.0
"""Edges of the skin over which tissue spreads that comes out."""
MOUTH_FOLD_METRES = 0.014
"""Metres from the lips to the fold between nose and mouth: within, no cheek comes out."""


def with_cheeks(skin: MouthSkin, drawn: NDArray[np.floating]) -> NDArray[np.float64]:
    """A smile (S, 3) metres from the `drawn` one (S, 3)."""
    within = skin.within()
    lips = skin.lips.copy()
    lips[np.concatenate(skin.rims())] = True
    still = (np.linalg.norm(drawn, axis=1) < STILL_METRES) & ~within & ~lips
    wanted = np.where(still[:, None], 0, drawn)
    moved = smooth_field(skin.triangles, ~(lips | still), wanted, np.full(len(drawn), DRAWN_PULL))
    away = cKDTree(skin.vertices[lips]).query(skin.vertices)[0]
    cheek = ~(lips | still | within) & (away > MOUTH_FOLD_METRES)
    narrowed = np.where(lips | still | within, 0, 1 - _areas(skin, moved) / _areas(skin))
    out = _spread(skin, np.clip(narrowed, 0, None) * TISSUE_THICKNESS_METRES, cheek)
    return np.asarray(moved + out[:, None] * vertex_normals(skin.vertices, skin.triangles))


def _spread(skin: MouthSkin, heights: NDArray[np.float64], where: NDArray[np.bool_]) -> NDArray[np.float64]:
    """(S,) `heights` (S,) spread smoothly over the skin that is `where` (S,), with the volume that they have."""
    bend = bending_of(skin.triangles, len(heights))[where][:, where] * (BULGE_REACH_EDGES**2 / 6) ** 2
    out = np.zeros(len(heights))
    out[where] = np.clip(splu(sp.csc_array(sp.eye_array(int(where.sum())) + bend)).solve(heights[where]), 0, None)
    areas = _areas(skin)
    return np.asarray(out * (areas @ heights) / (areas @ out))


def _areas(skin: MouthSkin, moved: NDArray[np.floating] | float = 0.0) -> NDArray[np.float64]:
    """(S,) square metres of the triangles about each vertex, a third of each, with the vertices `moved` (S, 3)."""
    a, b, c = (skin.vertices + moved)[skin.triangles].transpose(1, 0, 2)
    areas = np.linalg.norm(np.cross(b - a, c - a), axis=1) / 6
    return np.asarray(np.bincount(skin.triangles.ravel(), np.repeat(areas, 3), len(skin.vertices)), np.float64)
