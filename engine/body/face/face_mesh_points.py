"""Where the vertices of the tracked face mesh lie on the template: those that tell what a face does.

The canonical face mesh is laid on the template's face, as for the 68 points, and each vertex takes the nearest of the
template's. Lips and lids touch at rest, and the nearest may be the other lip's: there only vertices are asked that move as
lips and lids do, which the template's own face units say.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from engine.body.body_space import BodySpace
from engine.body.face.face_points import lay_canonical_face
from engine.body.template import Template
from engine.perception.face.landmarks import (
    FACE_OVAL,
    LEFT_BROW,
    LEFT_EYE,
    LEFT_IRIS,
    LIPS_INNER,
    LIPS_OUTER,
    RIGHT_BROW,
    RIGHT_EYE,
    RIGHT_IRIS,
)

NOSE_REGION_VERTICES = (168, 6, 197, 195, 5, 4, 1, 2, 98, 327, 64, 294, 129, 358, 203, 423)
CHEEK_REGION_VERTICES = (50, 280, 205, 425, 187, 411, 36, 266, 101, 330, 118, 347, 192, 416)
LIP_CORNER_VERTICES = (61, 291, 78, 308)
UPPER_LIP_VERTICES = (*LIPS_OUTER[1:10], *LIPS_INNER[1:10])
LOWER_LIP_VERTICES = (*LIPS_OUTER[11:], *LIPS_INNER[11:])
UPPER_LID_VERTICES = (*RIGHT_EYE[2:7], *LEFT_EYE[2:7])
LOWER_LID_VERTICES = (*RIGHT_EYE[10:15], *LEFT_EYE[10:15])
EYE_CORNER_REGION_VERTICES = (*(RIGHT_EYE[k] for k in (0, 1, 7, 8, 9, 15)), *(LEFT_EYE[k] for k in (0, 1, 7, 8, 9, 15)))
OTHER_VERTICES = (
    *FACE_OVAL,
    *RIGHT_BROW,
    *LEFT_BROW,
    *NOSE_REGION_VERTICES,
    *CHEEK_REGION_VERTICES,
    *LIP_CORNER_VERTICES,
    *EYE_CORNER_REGION_VERTICES,
)

LIP_PARTING_METRES = 0.01
"""Metres by which an open jaw moves the lower lip at least, and the upper one at most."""
LID_PARTING_METRES = 0.002
"""Metres by which a blink moves the upper lid at least, and the lower one at most."""


@dataclass(frozen=True)
class FaceMeshPoints:
    """`mesh` (P,) int: vertices of the tracked face mesh. `template` (P,) int: the template's vertices that they are."""

    mesh: NDArray[np.intp]
    template: NDArray[np.intp]


def face_mesh_points(template: Template, space: BodySpace) -> FaceMeshPoints:
    """The correspondence, for brows, lids, irises, nose, cheeks, lips and the face's outline."""
    face, laid = lay_canonical_face(template, space)
    jaw = _travel(template, "jawOpen")[face]
    blink = _travel(template, "eyeBlinkLeft", "eyeBlinkRight")[face]
    skin = space.mean[face]
    groups = (
        (OTHER_VERTICES, np.ones(len(face), np.bool_)),
        (UPPER_LIP_VERTICES, jaw < LIP_PARTING_METRES),
        (LOWER_LIP_VERTICES, jaw > LIP_PARTING_METRES),
        (UPPER_LID_VERTICES, blink > LID_PARTING_METRES),
        (LOWER_LID_VERTICES, blink < LID_PARTING_METRES),
    )
    mesh, found = [], []
    for vertices, allowed in groups:
        mesh.append(np.array(vertices, np.intp))
        found.append(face[allowed][cKDTree(skin[allowed]).query(laid[list(vertices)])[1]])
    for iris, part in ((RIGHT_IRIS, "right_eye"), (LEFT_IRIS, "left_eye")):
        eyeball = template.vertices_of(part)
        mesh.append(np.array(iris[:1], np.intp))
        found.append(eyeball[[np.argmax(space.mean[eyeball, 2])]])
    return FaceMeshPoints(np.concatenate(mesh), np.concatenate(found).astype(np.intp))


def _travel(template: Template, *units: str) -> NDArray[np.float64]:
    """How far these face units together move each vertex, metres."""
    return np.asarray(np.linalg.norm(template.face_units.displacement(dict.fromkeys(units, 1.0)), axis=1), np.float64)
