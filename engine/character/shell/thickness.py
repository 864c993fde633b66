"""How thick a displaced template is: what clothes add at the rims, they add in front and behind, too."""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray
from scipy.sparse.linalg import splu

from engine.character.figure.silhouette import GRID_HEIGHT_PIXELS
from engine.character.shell.displacement import Displaced
from engine.character.shell.template_mesh import TemplateMesh
from engine.geometry.deformation.cotangent_laplacian import cotangent_laplacian
from engine.geometry.mesh.surface import vertex_areas, vertex_normals

BENDING_WEIGHT, RIM_DEPTH_WEIGHT = 20.0, 0.3
"""What bending of the thickness costs, and how much what a rim says of it counts."""
PIXEL_THICKENING_WEIGHT, HAND_THICKENING_WEIGHT, FOOT_THICKENING_WEIGHT, FACE_THICKENING_WEIGHT = (
    1e-4,
    0.01,
    0.002,
    0.05,
)
"""What a square pixel of surface costs for being thicker than the template: everywhere, and of hands, feet and the face."""
MAX_THINNING_SHARE, MAX_THICKENING_SHARE = 0.02, 0.025
"""By how much at most, as a share of the person's height."""
DEPTH_SMOOTHING_SHARE = 0.02
"""Over how much surface depth changes evenly, as a share of the height: ears, nostrils and lips have normals of all directions."""


def thickened(mesh: TemplateMesh, template: NDArray[np.float64], displaced: Displaced) -> NDArray[np.float64]:
    """The displaced vertices (V, 3), moved towards the viewer or away by as much as rims near them went outwards, as smoothly
    as that permits. `template` (V, 3): where they were; the face keeps its depth."""
    count = len(template)
    normals = -vertex_normals(template, mesh.triangles).astype(np.float64)
    moved = (displaced.vertices - template)[displaced.matched, :2]
    outwards = (moved * normals[displaced.matched, :2]).sum(1)
    laplacian = cotangent_laplacian(template, mesh.triangles)
    area = vertex_areas(template, mesh.triangles)
    area = np.maximum(area, 0.02 * np.median(area))
    face = (mesh.head > 0.4) & (template[:, 2] > np.median(template[mesh.head > 0.9, 2]))
    stays = (
        PIXEL_THICKENING_WEIGHT
        + HAND_THICKENING_WEIGHT * (mesh.hand > 0.5)
        + FOOT_THICKENING_WEIGHT * (mesh.foot > 0.5)
        + FACE_THICKENING_WEIGHT * face
    )
    known = np.bincount(displaced.matched, np.full(len(outwards), RIM_DEPTH_WEIGHT), count).astype(np.float64)
    system = BENDING_WEIGHT * (laplacian @ sp.diags_array(1 / area) @ laplacian) + sp.diags_array(stays * area + known)
    factor = splu(sp.csc_array(system), permc_spec="MMD_AT_PLUS_A", options={"SymmetricMode": True})
    more = factor.solve(np.bincount(displaced.matched, RIM_DEPTH_WEIGHT * outwards, count).astype(np.float64))
    deeper = (
        np.clip(more, -MAX_THINNING_SHARE * GRID_HEIGHT_PIXELS, MAX_THICKENING_SHARE * GRID_HEIGHT_PIXELS)
        * normals[:, 2]
    )
    diffusion = sp.csc_array(sp.diags_array(area) + (DEPTH_SMOOTHING_SHARE * GRID_HEIGHT_PIXELS) ** 2 * laplacian)
    thick = displaced.vertices.copy()
    thick[:, 2] += splu(diffusion, permc_spec="MMD_AT_PLUS_A", options={"SymmetricMode": True}).solve(area * deeper)
    return thick
