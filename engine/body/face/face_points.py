"""Where the 68 face points (iBUG) lie on the template: a canonical face mesh, on which they are known, is laid on its face."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree
from scipy.spatial.transform import Rotation

from engine.body.body_space import BodySpace
from engine.body.template import Template
from engine.perception.face.head_pose import canonical_face
from engine.perception.face.landmarks import fiducials

PICTURE_TO_TEMPLATE = np.diag([1.0, -1.0, -1.0])
"""From the axes of pictures (y down, z away) to the template's."""
CANONICAL_FACE_ROUNDS = 12
"""Rounds in which the canonical face is laid on the template's."""
EYE_CORNER_FACE_POINTS = {"RightEyeOuter": 36, "RightEyeInner": 39, "LeftEyeInner": 42, "LeftEyeOuter": 45}
MOUTH_CORNER_FACE_POINTS = {"MouthRight": 48, "MouthLeft": 54}
"""Landmarks of the body that are face points, by their numbers."""


def face_points(template: Template, space: BodySpace) -> NDArray[np.intp]:
    """(68,) the template's vertices at which the face points are."""
    face, laid = lay_canonical_face(template, space)
    return np.asarray(face[cKDTree(space.mean[face].astype(np.float64)).query(fiducials(laid))[1]], np.intp)


def lay_canonical_face(template: Template, space: BodySpace) -> tuple[NDArray[np.intp], NDArray[np.float64]]:
    """The template's vertices (F,) that are its face, and the canonical face mesh (478, 3) as it lies on them in the mean
    body, metres."""
    mesh = space.mean.astype(np.float64)
    left, right = (mesh[template.vertices_of(f"{side}_eye")].mean(0) for side in ("left", "right"))
    middle, unit = (left + right) / 2, float(np.linalg.norm(left - right))
    body = template.vertices_of("body")
    near = body[np.linalg.norm(mesh[body] - middle, axis=1) < 2.5 * unit]
    face = near[mesh[near, 2] > middle[2] - 0.6 * unit]
    laid = canonical_face().astype(np.float64) @ PICTURE_TO_TEMPLATE * unit + middle
    laid += mesh[nose_tip(template, space)] - laid[1]
    tree = cKDTree(mesh[face])
    for _ in range(CANONICAL_FACE_ROUNDS):
        laid = _similar(laid, mesh[face][tree.query(laid)[1]])
    return face.astype(np.intp), laid


def nose_tip(template: Template, space: BodySpace) -> int:
    """The vertex that lies furthest in front in the middle of the face, below the eyes."""
    mesh, body = space.mean, template.vertices_of("body")
    height = mesh[np.concatenate([template.vertices_of(f"{side}_eye") for side in ("left", "right")]), 1].mean()
    face = body[(np.abs(mesh[body, 0]) < 0.01) & (mesh[body, 1] < height) & (mesh[body, 1] > height - 0.07)]
    return int(face[np.argmax(mesh[face, 2])])


def _similar(points: NDArray[np.float64], target: NDArray[np.float64]) -> NDArray[np.float64]:
    """Points moved, turned and scaled onto their targets, with the scale that both spreads give alike (B. Horn, Closed-form
    solution of absolute orientation using unit quaternions, 1987): one that is fitted shrinks in rounds of closest points."""
    a, b = points - points.mean(0), target - target.mean(0)
    turn = Rotation.align_vectors(b, a)[0]
    scale = np.sqrt((b**2).sum() / (a**2).sum())
    return np.asarray(scale * turn.apply(a) + target.mean(0))
