"""Lids and lips that meet where the driver's do: how far two sides of an opening are apart is carried over by itself.

A factor for each point (`engine.persona.motion.deformation_transfer`) lets them nearly meet: it is denoised, and those
of an upper and a lower lip are not told together. Here the gap between the two vertices that face each other is a share
of what it is at rest, on the puppet as on the driver. What the mesh lacks to it is added as smoothly as the mesh bends.
"""

from __future__ import annotations

from functools import cache

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray
from scipy.sparse.linalg import splu

from engine.geometry.mesh.adjacency import neighbours
from engine.perception.face.face_tessellation import face_triangles
from engine.perception.face.landmarks import LEFT_EYE, LIPS_INNER, RIGHT_EYE

MESH_VERTICES = 478
REST_GAP_EYE_DISTANCES = 0.01
"""Eye distances: openings that are narrower at rest are shut then, and stay as they are."""
ANCHOR_STIFFNESS = 0.3
"""How much a vertex is held in its place, beside a bending of one: half of a correction is gone a few vertices away."""
LOWER_LID_WEIGHT = 4.0
"""How much more lower lids and upper lips are held: lids shut from above, and jaws from below."""


def corrected(
    moved: NDArray[np.floating],
    factors: NDArray[np.floating],
    deformation: NDArray[np.floating],
    driver: NDArray[np.floating],
    puppet: NDArray[np.floating],
) -> NDArray[np.float64]:
    """(478, 3) the puppet's movements `moved` (478, 3), changed so that its openings are as far shut as the driver's.

    deformation : (478, 3) the driver's movements. factors : (478,) or (478, 1), by which they were made longer. driver, puppet : (478, 3)
        both faces at rest, from the front, in eye distances.
    """
    upper, lower, spread = _openings()
    before, own = driver[lower] - driver[upper], puppet[lower] - puppet[upper]
    now = before + deformation[lower] - deformation[upper]
    squares = (before**2).sum(axis=1) + REST_GAP_EYE_DISTANCES**2
    open_share = np.clip(((now * before).sum(axis=1) + REST_GAP_EYE_DISTANCES**2) / squares, 0, 1)[:, None]
    longer = np.reshape(factors, (len(factors), 1))
    wanted = open_share * own + (longer[upper] + longer[lower]) / 2 * (now - open_share * before)
    return np.asarray(moved + spread @ (wanted - own - (moved[lower] - moved[upper])), np.float64)


@cache
def _openings() -> tuple[NDArray[np.intp], NDArray[np.intp], NDArray[np.float64]]:
    """(P,) the upper and (P,) the lower vertices that face each other, and (478, P) what each gap's change is spread
    by. That is the smoothest movement, of least bending, after which all gaps are as much wider as is asked."""
    pairs = [
        (contour[place], contour[-place])
        for contour in (LIPS_INNER, RIGHT_EYE, LEFT_EYE)
        for place in range(1, len(contour) // 2)
    ]
    upper, lower = np.array(pairs).T
    beside = neighbours(face_triangles(), MESH_VERTICES)
    bending = sp.diags_array(beside.sum(axis=1)) - beside
    weight = np.full(MESH_VERTICES, ANCHOR_STIFFNESS**2)
    weight[np.concatenate([upper[: len(LIPS_INNER) // 2 - 1], lower[len(LIPS_INNER) // 2 - 1 :]])] *= LOWER_LID_WEIGHT
    gaps = np.zeros((len(pairs), MESH_VERTICES))
    gaps[np.arange(len(pairs)), lower], gaps[np.arange(len(pairs)), upper] = 1, -1
    easy = splu(sp.csc_array(bending @ bending + sp.diags_array(weight))).solve(np.ascontiguousarray(gaps.T))
    return upper, lower, np.asarray(easy @ np.linalg.inv(gaps @ easy), np.float64)
