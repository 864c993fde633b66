"""Where the 68 face landmarks lie on the skin: a canonical face mesh is laid on it, and lips have those on their own lines."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from engine.body.body_space import BodySpace
from engine.body.face.face_points import lay_canonical_face
from engine.body.template import Template, vertex_mask
from engine.geometry.mesh.adjacency import neighbours
from engine.geometry.mesh.surface import vertex_normals
from engine.perception.face.landmarks import fiducials

FRONT_COSINE = 0.1
"""Of the angle between a normal and straight ahead, beyond which a vertex is seen from the front, as landmarks of faces are."""
UPPER_LIP_BORDER_POINTS, LOWER_LIP_BORDER_POINTS = (49, 50, 51, 52, 53), (55, 56, 57, 58, 59)
"""Landmarks on the border of the lips' red, above and below."""
UPPER_LIP_LINE_POINTS, LOWER_LIP_LINE_POINTS = (61, 62, 63), (65, 66, 67)
"""Landmarks where the lips meet, above and below. The canonical face's lips are not as high as the template's."""
LINE_REACH_METRES = 0.002
"""Metres across within which vertices of a line are one place of it: the foremost is seen."""


def landmark_vertices(
    template: Template,
    space: BodySpace,
    vertices: NDArray[np.intp],
    triangles: NDArray[np.int32],
    shown: NDArray[np.bool_],
    touching: tuple[NDArray[np.intp], NDArray[np.intp]],
) -> NDArray[np.intp]:
    """(68,) numbers of the skin's vertices, all of them seen from the front, in the mean body.

    `vertices` (S,) of the template that are the skin, `triangles` (T, 3), what is `shown` (S,), and what of the upper and of the
    lower lip is `touching` the other.
    """
    mean = space.mean[vertices].astype(np.float64)
    ahead = shown & (vertex_normals(mean, triangles)[:, 2] > FRONT_COSINE)
    face, laid = lay_canonical_face(template, space)
    known = fiducials(laid).astype(np.float64)
    candidates = np.flatnonzero(ahead & np.isin(vertices, face))
    found = candidates[cKDTree(mean[candidates]).query(known)[1]]
    red = vertex_mask(template, "lips")[vertices] > 0.5
    border = red & ahead & (neighbours(triangles, len(red)) @ (~red).astype(np.float64) > 0)
    middle = float(mean[np.concatenate(touching), 1].mean())
    for landmarks, line in (
        (UPPER_LIP_BORDER_POINTS, np.flatnonzero(border & (mean[:, 1] > middle))),
        (LOWER_LIP_BORDER_POINTS, np.flatnonzero(border & (mean[:, 1] < middle))),
        (UPPER_LIP_LINE_POINTS, touching[0]),
        (LOWER_LIP_LINE_POINTS, touching[1]),
    ):
        for landmark in landmarks:
            found[landmark] = _foremost(mean, line, float(known[landmark, 0]))
    return np.asarray(found, np.intp)


def _foremost(places: NDArray[np.float64], line: NDArray[np.intp], across: float) -> int:
    """Of the vertices of a `line`, those that lie `across` (x, metres), the one that is farthest ahead."""
    off = np.abs(places[line, 0] - across)
    near = line[off < off.min() + LINE_REACH_METRES]
    return int(near[np.argmax(places[near, 2])])
