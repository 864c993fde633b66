"""How dark the folds of ears are: nobody who is seen from before shows them, and ears of one colour are flaps."""

from __future__ import annotations

from functools import cache

import numpy as np
from numpy.typing import NDArray

from engine.character.fit.template_fit import load_human
from engine.character.shell.template_mesh import template_mesh
from engine.geometry.mesh.adjacency import neighbours
from engine.geometry.mesh.surface import vertex_normals

EAR_SMOOTHING_ROUNDS = 12
"""Times that the surface is averaged with what is around: what lies below that is a fold."""
FOLD_DEPTH_METRES = 0.003
"""Metres below an ear's averaged surface from which on a fold is as dark as any."""
FOLD_SHADE_SHARE, RIDGE_LIGHT_SHARE = 0.55, 0.14
"""Share of the light that a fold lacks, and that a ridge has more."""


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
