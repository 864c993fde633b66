"""Catmull-Clark subdivision as sparse matrices: built once for a mesh, applied to every shape it takes.

Source: E. Catmull, J. Clark, Recursively generated B-spline surfaces on arbitrary topological meshes, 1978;
borders follow the cubic B-spline curve of their own points.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray

from engine.geometry.mesh.adjacency import unique_edges


@dataclass(frozen=True)
class Subdivision:
    """`points` (V', V) sparse: fine vertices are `points @ vertices`. `quads` (4F, 4) int32 the fine faces.

    The children of face `f` are the fine faces `4f` to `4f + 3`; child `4f + k` holds the corner `k`.
    """

    points: sp.csr_array
    quads: NDArray[np.int32]


def catmull_clark(quads: NDArray[np.integer], vertex_count: int, smooth: bool = True) -> Subdivision:
    """One step of subdivision of a quad mesh.

    Fine vertices are, in this order: the old vertices, one for each edge, one for each face.
    `smooth=False` only splits the faces (bilinear), as texture coordinates need it.
    """
    faces = np.asarray(quads, np.int64)
    count = len(faces)
    sides = np.stack([faces, np.roll(faces, -1, 1)], 2)  # (F, 4, 2): side k runs from corner k to corner k + 1
    edges, edge_of = unique_edges(sides.reshape(-1, 2))
    edge_of = edge_of.reshape(count, 4)
    shared = np.bincount(edge_of.ravel(), minlength=len(edges))
    mean_of_face = _rows(np.arange(count).repeat(4), faces.ravel(), 0.25, (count, vertex_count))
    middle = _rows(np.arange(len(edges)).repeat(2), edges.ravel(), 0.5, (len(edges), vertex_count))
    keep = sp.eye_array(vertex_count, format="csr")
    edge_points, vertex_points = middle, keep
    if smooth:
        faces_at_edge = _rows(edge_of.ravel(), np.arange(count).repeat(4), 1.0, (len(edges), count))
        inner = sp.diags_array((shared == 2).astype(float))
        border = sp.diags_array((shared != 2).astype(float))
        edge_points = inner @ (0.5 * middle + 0.25 * faces_at_edge @ mean_of_face) + border @ middle
        vertex_points = _vertex_points(faces, edges, shared, mean_of_face, middle, vertex_count)
    points = sp.csr_array(sp.vstack([vertex_points, edge_points, mean_of_face]))
    edge_ids = vertex_count + edge_of
    face_ids = (vertex_count + len(edges) + np.arange(count))[:, None].repeat(4, 1)
    fine = np.stack([faces, edge_ids, face_ids, np.roll(edge_ids, 1, 1)], 2)
    # child k starts at corner k, turned so that every child keeps the sense of its parent
    return Subdivision(points, fine.reshape(-1, 4).astype(np.int32))


def _vertex_points(
    faces: NDArray[np.int64],
    edges: NDArray[np.int64],
    shared: NDArray[np.int64],
    mean_of_face: sp.csr_array,
    middle: sp.csr_array,
    vertex_count: int,
) -> sp.csr_array:
    """(Q + 2 R + (n - 3) P) / n inside; (L + 6 P + R) / 8 along a border; lone vertices stay."""
    count = len(faces)
    at_faces = _rows(faces.ravel(), np.arange(count).repeat(4), 1.0, (vertex_count, count))
    at_edges = _rows(edges.ravel(), np.arange(len(edges)).repeat(2), 1.0, (vertex_count, len(edges)))
    valence = np.bincount(edges.ravel(), minlength=vertex_count)
    border_edges = shared == 1
    on_border = np.bincount(edges[border_edges].ravel(), minlength=vertex_count) > 0
    inside = (valence > 0) & ~on_border & (np.bincount(faces.ravel(), minlength=vertex_count) == valence)
    n = np.maximum(valence, 1)
    curve = on_border & (np.bincount(edges[border_edges].ravel(), minlength=vertex_count) == 2)
    of_inside = (
        sp.diags_array(inside / n**2) @ at_faces @ mean_of_face
        + sp.diags_array(2 * inside / n**2) @ at_edges @ middle
        + sp.diags_array(inside * (n - 3) / n)
    )
    of_border = sp.diags_array(curve * 0.25) @ at_edges @ sp.diags_array(
        border_edges.astype(float)
    ) @ middle + sp.diags_array(curve * 0.5)
    of_rest = sp.diags_array((~inside & ~curve).astype(float))
    return sp.csr_array(of_inside + of_border + of_rest)


def _rows(
    rows: NDArray[np.integer], columns: NDArray[np.integer], value: float, shape: tuple[int, int]
) -> sp.csr_array:
    return sp.csr_array((np.full(len(rows), value), (rows, columns)), shape=shape)
