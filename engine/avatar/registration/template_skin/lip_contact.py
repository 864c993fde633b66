"""Where the lips touch: what keeps a fitted mouth closed, whatever noise says of either lip."""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray
from scipy.sparse.linalg import splu

from engine.geometry.deformation.handles import surface_points
from engine.geometry.deformation.smooth_field import bending_of
from engine.geometry.mesh.closest_points import closest_points
from engine.geometry.mesh.surface import face_normals, vertex_normals

MAX_LIP_GAP_METRES = 0.001
"""Metres between the lips of the mean body, within which they touch: along one line on each, where the template leaves a slit."""
FACING_COSINE = -0.2
"""Cosine between normals of both lips below which they face each other."""
CLOSING_WEIGHT = 1e4
"""Of what is left between the lips, against a Laplacian of one edge."""
STAYING_WEIGHT = 0.05
"""Of how far all else moves as the mouth is closed."""


def lip_contact(
    vertices: NDArray[np.floating],
    triangles: NDArray[np.integer],
    lips: NDArray[np.bool_],
    lower: NDArray[np.bool_],
) -> sp.csr_array:
    """(C, S) sparse: each row is a vertex of one lip minus the point of the other that it touches, in weights of the skin's
    vertices. Times the places of the skin, it is by how much the mouth is open.

    `vertices` (S, 3) metres with the mouth closed as the template has it; `lips` (S,) those of both; `lower` (S,) what the jaw
    takes along.
    """
    places = np.asarray(vertices, np.float64)
    normals = vertex_normals(places, triangles)
    found = []
    for one, other in ((lips & ~lower, lips & lower), (lips & lower, lips & ~lower)):
        own = np.flatnonzero(one)
        opposite = triangles[other[triangles].all(1)]
        nearest = closest_points(places[own], places, opposite)
        facing = (normals[own] * face_normals(places, opposite)[nearest.triangle]).sum(1) < FACING_COSINE
        touching = np.flatnonzero((nearest.distance < MAX_LIP_GAP_METRES) & facing)
        points = surface_points(opposite, nearest.triangle[touching], nearest.barycentrics[touching], len(places))
        rows = np.arange(len(touching))
        here = sp.csr_array((np.ones(len(touching)), (rows, own[touching])), (len(touching), len(places)))
        found.append(here - points)
    return sp.csr_array(sp.vstack(found))


def closed_mouth(
    vertices: NDArray[np.floating], triangles: NDArray[np.integer], contact: sp.csr_array, moved: NDArray[np.bool_]
) -> NDArray[np.float64]:
    """The skin (S, 3) with its mouth closed: both lips come as far as it takes to each other, and what else is `moved` (S,) comes
    along, as smoothly as can be."""
    places = np.asarray(vertices, np.float64)
    closing = sp.csr_array(CLOSING_WEIGHT * (contact.T @ contact))
    staying = STAYING_WEIGHT * sp.eye_array(len(places))
    system = sp.csr_array(bending_of(triangles, len(places)) + closing + staying)[moved]
    out = places.copy()
    out[moved] += splu(sp.csc_array(system[:, moved])).solve(-(closing[moved] @ places))
    return out
