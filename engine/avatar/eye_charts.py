"""Where an avatar's surface lies on its texture: as the template's does, but with more room for the eyes.

MakeHuman gives an iris 36 of 4096 texels, in which it is a blot; there is free room on its texture for 144.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from engine.body.template import Template
from engine.geometry.mesh.surface import triangulate
from engine.geometry.texture_charts.texture_atlas import atlas_from_uv

EYE_SCALE = 4.0
"""By how much the charts of the fronts of both eyeballs are larger than the template has them."""
EYE_CENTRES = {"left_eye": (0.86, 0.06), "right_eye": (0.94, 0.06)}
"""Where the charts of the eyeballs' fronts lie on the texture, in places at which the template has nothing."""


def avatar_uv(template: Template) -> NDArray[np.float32]:
    """The template's places on the texture, (U, 2) float32 in [0, 1], with the fronts of the eyeballs enlarged."""
    uv = template.uv.astype(np.float32)
    for part, centre in EYE_CENTRES.items():
        faces = template.faces(part)
        corners = triangulate(template.uv_quads[faces])
        charts = atlas_from_uv(template.uv, corners).charts
        depth = template.vertices[triangulate(template.quads[faces])].mean(1)[:, 2]
        front = max(np.unique(charts), key=lambda chart: depth[charts == chart].mean())
        members = np.unique(corners[charts == front])
        middle = (uv[members].min(0) + uv[members].max(0)) / 2
        uv[members] = np.array(centre, np.float32) + np.float32(EYE_SCALE) * (uv[members] - middle)
    return uv
