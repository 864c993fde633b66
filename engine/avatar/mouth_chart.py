"""The bag behind the lips, which has a chart of its own on the template's texture: its rim is where closed lips meet."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from engine.body.template import Template
from engine.geometry.mesh.surface import triangulate
from engine.geometry.texture_charts.texture_atlas import atlas_from_uv

MOUTH_RADIUS_METRES = 0.04
"""Metres from the middle of the tongue, along each axis, within which the mouth's bag lies."""


def mouth_faces(template: Template) -> NDArray[np.bool_]:
    """(F,) which of the faces of the template's part `body` are the mouth's inside."""
    faces = template.faces("body")
    quads = template.quads[faces]
    places = template.vertices.astype(np.float64)
    away = np.abs(places[quads].mean(1) - places[template.vertices_of("tongue")].mean(0)).max(1)
    chart = atlas_from_uv(template.uv, triangulate(template.uv_quads[faces])).charts[: len(faces)]
    near = np.bincount(chart[away < MOUTH_RADIUS_METRES], minlength=int(chart.max()) + 1)
    return np.asarray((2 * near > np.bincount(chart))[chart])
