"""Where ears are on the template, and how dark their folds: nobody who is seen from before shows them, and ears of one colour are flaps."""

from __future__ import annotations

from functools import cache

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray
from scipy.sparse.linalg import splu

from engine.character.fit.template_fit import load_human
from engine.character.shell.template_mesh import template_mesh
from engine.geometry.deformation.cotangent_laplacian import cotangent_laplacian
from engine.geometry.mesh.adjacency import neighbours
from engine.geometry.mesh.surface import vertex_areas, vertex_normals

EAR_SMOOTHING_ROUNDS = 12
"""Times that the surface is averaged with what is around: what lies below that is a fold."""
FOLD_DEPTH_METRES = 0.003
"""Metres below an ear's averaged surface from which on a fold is as dark as any."""
AURICLE_METRES = (0.005, 0.007)
"""Metres that a place stands off the head from which on it is more and more the ear's own, and wholly: below is the skin or the hair beside it."""
FOLD_SHADE_SHARE, RIDGE_LIGHT_SHARE = 0.55, 0.14
"""Share of the light that a fold lacks, and that a ridge has more."""


@cache
def auricles() -> NDArray[np.float32]:
    """How far each of the mesh's vertices (V,) is an ear's own, from 0 to 1: what stands off the head, which goes on beneath as smoothly as it
    can from what is around; once for the process."""
    mesh = template_mesh()
    places = load_human().space.mean[mesh.ids].astype(np.float64)
    laplacian = cotangent_laplacian(places, mesh.triangles)
    area = np.maximum(vertex_areas(places, mesh.triangles), np.finfo(np.float64).tiny)
    bending = sp.csr_array(laplacian @ sp.diags_array(1 / area) @ laplacian)
    ear, around = np.flatnonzero(mesh.ear), np.flatnonzero(~mesh.ear)
    beneath = splu(sp.csc_array(bending[ear][:, ear])).solve(-(bending[ear][:, around] @ places[around]))
    least, all_ = AURICLE_METRES
    off = np.linalg.norm(places[ear] - beneath, axis=1)
    share = np.zeros(len(places), np.float32)
    share[ear] = np.clip((off - least) / (all_ - least), 0, 1)
    return share


@cache
def ear_shade() -> NDArray[np.float32]:
    """Share of the light that each of the mesh's vertices (V,) has by the folds of its ears, 1 beside them; once for the process."""
    mesh = template_mesh()
    places = load_human().space.mean[mesh.ids].astype(np.float64)
    beside = neighbours(mesh.triangles, len(places))
    count = np.maximum(np.asarray(beside.sum(1)).ravel(), 1)
    smooth = places
    for _ in range(EAR_SMOOTHING_ROUNDS):
        smooth = (beside @ smooth) / count[:, None]
    height = ((places - smooth) * vertex_normals(places, mesh.triangles)).sum(1) / FOLD_DEPTH_METRES
    shade = 1 + np.clip(FOLD_SHADE_SHARE * height, -FOLD_SHADE_SHARE, RIDGE_LIGHT_SHARE)
    return np.where(mesh.ear, shade, 1).astype(np.float32)
