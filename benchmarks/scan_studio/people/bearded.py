"""A beard on a person of the template: a moustache and a full chin, dark and centimetre-thick, whose shape is known."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from benchmarks.scan_studio.camera.noise import space_noise
from benchmarks.scan_studio.people.subject import Subject, room_light
from engine.body.body_space import load_body_space
from engine.body.face.face_points import face_points
from engine.body.template import load_template
from engine.geometry.mesh.surface import vertex_normals
from engine.geometry.texture_charts.texture_atlas import atlas_from_uv
from engine.render.rasterisation.attributes import interpolate
from engine.render.textures.texture_bake import texel_raster

BEARD_METRES = 0.012
"""Metres by which the beard stands off the skin."""
BEARD_REACH_METRES = 0.055
"""Metres from the lower lip within which it grows."""
BARE_LIP_METRES, BEARD_EDGE_METRES = 0.003, 0.006
"""Metres from the lips within which nothing grows, and over which the beard rises to its height."""
MOUTH_HOLE_METRES = 0.03
"""Metres about the mouth within which what lies behind the lips is its inside."""
BEARD_RGB = (44, 31, 24)
BEARD_CELL_METRES = (0.0015, 0.004)
"""Metres of the cells of its noise."""


def with_beard(subject: Subject, name: str) -> Subject:
    """A subject of the template with a beard, under another name."""
    template = load_template()
    skin = np.isin(np.arange(len(subject.vertices)), template.vertices_of("body"))
    height = np.where(skin, _height(subject.vertices, face_points(template, load_body_space())), 0.0)
    normals = vertex_normals(subject.vertices, subject.triangles)
    vertices = subject.vertices + height[:, None] * normals
    raster = texel_raster(atlas_from_uv(subject.uv, subject.uv_triangles), len(subject.texture))
    on = raster.triangle >= 0
    share = np.clip(interpolate(height[:, None], subject.triangles, raster)[on] / (BEARD_METRES / 3), 0, 1)
    places = interpolate(vertices, subject.triangles, raster)[on]
    noise = space_noise(places, BEARD_CELL_METRES, np.random.default_rng(len(name)))
    hair = np.array(BEARD_RGB) * np.clip(1 + 0.3 * noise, 0.3, 1.7)[:, None]
    texture = subject.texture.copy()
    texture[on] = np.clip(texture[on] + share * (hair - texture[on]) + 0.5, 0, 255).astype(np.uint8)
    shade = room_light(vertex_normals(vertices, subject.triangles))
    return replace(subject, name=name, vertices=vertices, texture=texture, shade=shade)


def _height(vertices: NDArray[np.float64], points: NDArray[np.integer]) -> NDArray[np.float64]:
    """(V,) metres of beard over each vertex (V, 3); `points` (68,) are those of the face."""
    face = vertices[points]
    lips = np.concatenate([np.linspace(a, b, 8) for a, b in pairwise(face[48:60])])
    off_lips = np.asarray(cKDTree(lips).query(vertices)[0]) - BARE_LIP_METRES
    inside = BEARD_REACH_METRES - np.linalg.norm(vertices - face[57], axis=1)
    below_nose = face[33, 1] - vertices[:, 1]
    edge = np.clip(np.minimum(np.minimum(off_lips, inside), below_nose) / BEARD_EDGE_METRES, 0, 1)
    mouth = np.linalg.norm((vertices - face[57])[:, :2], axis=1) < MOUTH_HOLE_METRES
    behind_lips = mouth & (vertices[:, 2] < face[60:68, 2].min() - BARE_LIP_METRES)
    return np.where(behind_lips, 0.0, BEARD_METRES * edge * edge * (3 - 2 * edge))
