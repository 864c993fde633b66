"""The face's mesh made finer where it turns out of sight.

The outline of a head that turns runs along the edges of triangles of cheek and temple, a twelfth of the face long each: a line with corners.
So points are put between the vertices within a band inside the contour, which move on the smooth surface through them: by cubic Hermite interpolation along each
edge, with gradients that are fitted to each vertex's neighbours by least squares. All of it is linear in what the vertices do.
"""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_array, diags_array, eye_array, vstack

from engine.face_animation.warping.lip_edges import parting_edges
from engine.geometry.mesh.adjacency import edges
from engine.imaging.warping.constrained_delaunay import constrained_delaunay
from engine.perception.face.landmarks import FACE_OVAL, LEFT_EYE, LIPS_INNER, LIPS_OUTER, RIGHT_EYE, eye_distance

CHEEK_BAND_EYE_DISTANCES = 0.6
"""Width of the band inside the contour."""
SUBDIVISION_ROUNDS = 2
"""How often each edge is halved."""
MIN_EDGE_EYE_DISTANCES = 0.06
"""Edges shorter than this stay whole."""
CONTOUR_TOLERANCE_EYE_DISTANCES = 1e-3
"""Eye distances from the contour within which a point lies on it."""
FOLDING_VERTICES = (*LEFT_EYE, *RIGHT_EYE, *LIPS_OUTER, *LIPS_INNER)
"""Vertices at which a face moves by folds: nothing is rounded there."""


def points_between(face: NDArray[np.floating], usable: NDArray[np.integer]) -> tuple[NDArray[np.float64], csr_array]:
    """Of a face (478, 2) the points between its `usable` vertices (U,), (P, 2), and what they take of the offsets of these, (P, U), whose rows sum to one."""
    unit, oval = float(eye_distance(face[:, :2])), face[list(FACE_OVAL), :2].astype(np.float32)
    points, weights = np.asarray(face[usable, :2], np.float64), eye_array(len(usable), format="csr")
    apart = np.isin(usable, FOLDING_VERTICES)
    for _ in range(SUBDIVISION_ROUNDS):
        triangles = constrained_delaunay(points, parting_edges(usable))
        depth = np.array([cv2.pointPolygonTest(oval, (float(x), float(y)), True) for x, y in points]) / unit
        pairs = edges(triangles)
        step = points[pairs[:, 1]] - points[pairs[:, 0]]
        chosen = (depth[pairs] > -CONTOUR_TOLERANCE_EYE_DISTANCES).all(axis=1) & (
            depth[pairs] < CHEEK_BAND_EYE_DISTANCES
        ).all(axis=1)
        chosen &= (depth[pairs] > CONTOUR_TOLERANCE_EYE_DISTANCES).any(axis=1) & ~apart[pairs].any(axis=1)
        chosen &= np.linalg.norm(step, axis=1) > MIN_EDGE_EYE_DISTANCES * unit
        pairs, step = pairs[chosen], step[chosen]
        slopes = _gradients(points, edges(triangles))
        bend = sum(diags_array(step[:, k]) @ (slopes[k][pairs[:, 0]] - slopes[k][pairs[:, 1]]) for k in range(2))
        rows = np.arange(len(pairs)).repeat(2)
        middle = csr_array((np.full(len(rows), 0.5), (rows, pairs.ravel())), shape=(len(pairs), len(points)))
        points = np.concatenate([points, middle @ points])
        weights = csr_array(vstack([weights, (middle + bend / 8) @ weights]))
        apart = np.concatenate([apart, np.zeros(len(pairs), bool)])
    return points[len(usable) :], weights[len(usable) :]


def _gradients(points: NDArray[np.float64], pairs: NDArray[np.integer]) -> list[csr_array]:
    """Along x and y, (V, V) each: what the gradient at each of the points (V, 2) takes of the values at all, by least squares over the edges `pairs` (E, 2)
    that end there."""
    ends = np.concatenate([pairs, pairs[:, ::-1]])
    step = points[ends[:, 1]] - points[ends[:, 0]]
    squares = np.zeros((len(points), 2, 2))
    np.add.at(squares, ends[:, 0], step[:, :, None] * step[:, None, :])
    share = np.einsum("ekl,el->ek", np.linalg.inv(squares)[ends[:, 0]], step)
    there = [csr_array((share[:, k], ends.T), shape=(len(points), len(points))) for k in range(2)]
    return [csr_array(one - diags_array(one.sum(axis=1))) for one in there]
