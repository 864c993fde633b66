"""From offsets of sparse control points to a dense warp: section 4, "confidence-aware warping".

The paper triangulates the control points, interpolates their offsets piecewise linearly over the whole
image, and blurs that field with a disk whose radius grows away from the face. All of it is linear in the
offsets and fixed on the neutral frame. So it is done once, to a matrix: a few hundred offsets in, the
offsets of the vertices of a mesh out, fine on the face and coarse where the field is smooth. A frame then
costs one small product and one rasterisation of that mesh, which is the inverse mapping.
"""

from __future__ import annotations

import cv2
import numpy as np
import scipy.sparse as sparse
from numpy.typing import NDArray
from scipy.spatial import Delaunay, cKDTree

from engine.perception.landmarks import FACE_OVAL
from engine.portrait.warp_mesh import WarpMesh

DISKS = 10
"""Section 4: "10 different blurring kernels"."""
LARGEST_DISK = 0.05
"""Section 4: radii in [0, 0.05 of the image's diagonal]."""
FALLOFF = 0.15
"""Distance from the face, in diagonals, where the largest disk is reached. The paper leaves it open."""
CELLS = 64
"""Vertices of the mesh's regular part along the diagonal; finer ones change the field by < 0.1 px."""


def disk_radii(face: NDArray[np.floating], points: NDArray[np.floating], shape: tuple[int, int]) -> NDArray[np.float64]:
    """Radius of the smoothing disk at each point, pixels: 0 on the face, growing away from it, in `DISKS` steps.

    Parameters
    ----------
    face : (478, 2) target mesh. points : (N, 2). shape : (height, width).
    """
    diagonal = float(np.hypot(*shape))
    oval = face[list(FACE_OVAL), :2].astype(np.float32)
    outside = np.array([-cv2.pointPolygonTest(oval, (float(x), float(y)), True) for x, y in points])
    level = np.clip(outside / (FALLOFF * diagonal), 0, 1)
    return np.round(level * (DISKS - 1)) / (DISKS - 1) * LARGEST_DISK * diagonal


def interpolation_matrix(
    control: NDArray[np.floating], points: NDArray[np.floating], triangulation: Delaunay | None = None
) -> sparse.csr_matrix:
    """Piecewise-linear interpolation over the Delaunay triangulation: (N, C), rows sum to one.

    Points outside the control points' hull take the value of the nearest control point.
    """
    triangulation = triangulation or Delaunay(control)
    simplex = triangulation.find_simplex(points)
    inside = simplex >= 0
    transform = triangulation.transform[simplex[inside]]
    first = np.einsum("nij,nj->ni", transform[:, :2], points[inside] - transform[:, 2])
    weights = np.column_stack([first, 1 - first.sum(axis=1)])
    columns = triangulation.simplices[simplex[inside]]
    rows = np.repeat(np.flatnonzero(inside), 3)
    outside = np.flatnonzero(~inside)
    nearest = ((points[outside, None] - control[None]) ** 2).sum(axis=2).argmin(axis=1) if len(outside) else outside
    return sparse.csr_matrix(
        (
            np.concatenate([weights.ravel(), np.ones(len(outside))]),
            (np.concatenate([rows, outside]), np.concatenate([columns.ravel(), nearest])),
        ),
        shape=(len(points), len(control)),
    )


def build_warp_mesh(
    control: NDArray[np.floating],
    face: NDArray[np.floating],
    shape: tuple[int, int],
    smoothing: str = "confidence",
    usable: NDArray[np.bool_] | None = None,
) -> WarpMesh:
    """Triangulate, interpolate and smooth, once for a target.

    Parameters
    ----------
    control : (C, 2) rest positions of the control points in the target, pixels, the face mesh first.
    face : (478, 2) the target's face mesh.
    shape : (height, width) of the target.
    usable : (C,) points that take part; others are ignored (their offsets move nothing).
    smoothing : "confidence" (the paper's), "none" or "constant" (its figure 3, for comparison).
    """
    height, width = shape
    diagonal = float(np.hypot(height, width))
    spacing = diagonal / CELLS
    used = np.arange(len(control)) if usable is None else np.flatnonzero(usable)
    on_face = used[used < len(face)]
    vertices = np.concatenate([face[on_face, :2].astype(float), _grid_around(face, shape, spacing)])
    samples_x = np.linspace(0, width - 1, int(np.ceil(2 * width / spacing)) + 1)
    samples_y = np.linspace(0, height - 1, int(np.ceil(2 * height / spacing)) + 1)
    samples = np.stack(np.meshgrid(samples_x, samples_y), axis=-1).reshape(-1, 2)
    triangulation = Delaunay(control[used])
    select = sparse.csr_matrix((np.ones(len(used)), (np.arange(len(used)), used)), shape=(len(used), len(control)))
    around = interpolation_matrix(control[used], vertices[len(on_face) :], triangulation)
    operator = sparse.vstack([sparse.eye(len(control), format="csr")[on_face], around @ select], format="csr")
    if smoothing != "none":
        radii = (
            disk_radii(face, vertices, shape)
            if smoothing == "confidence"
            else np.full(len(vertices), LARGEST_DISK * diagonal / 2)
        )
        field = interpolation_matrix(control[used], samples, triangulation) @ select
        on_border = ((vertices <= 0) | (vertices >= np.array([width - 1, height - 1]))).any(axis=1)
        keep = sparse.diags(((radii < spacing / 2) | on_border).astype(float))
        smooth = _disk_average(vertices, radii, samples, spacing) @ field
        operator = keep @ operator + (sparse.eye(len(vertices)) - keep) @ smooth
    triangles = Delaunay(vertices).simplices
    matrix = sparse.csr_matrix(operator).astype(np.float32)
    return WarpMesh(
        vertices.astype(np.float32), triangles.astype(np.int32), matrix.indptr, matrix.indices, matrix.data, shape
    )


def _grid_around(face: NDArray[np.floating], shape: tuple[int, int], spacing: float) -> NDArray[np.float64]:
    """A regular grid outside the face's contour that reaches the image's corners."""
    height, width = shape
    xs = np.linspace(0, width - 1, int(np.ceil(width / spacing)) + 1)
    ys = np.linspace(0, height - 1, int(np.ceil(height / spacing)) + 1)
    grid = np.stack(np.meshgrid(xs, ys), axis=-1).reshape(-1, 2)
    oval = face[list(FACE_OVAL), :2].astype(np.float32)
    distance = np.array([cv2.pointPolygonTest(oval, (float(x), float(y)), True) for x, y in grid])
    return grid[distance < -0.4 * spacing]


def _disk_average(
    vertices: NDArray[np.float64], radii: NDArray[np.float64], samples: NDArray[np.float64], spacing: float
) -> sparse.csr_matrix:
    """(V, S): each vertex's mean over the samples within its disk; samples beyond the image count as the border's."""
    neighbours = cKDTree(samples).query_ball_point(vertices, np.maximum(radii, 0.75 * spacing))
    rows = np.repeat(np.arange(len(vertices)), [len(n) for n in neighbours])
    columns = np.concatenate([np.asarray(n, int) for n in neighbours])
    counts = np.array([len(n) for n in neighbours], float)
    return sparse.csr_matrix((1 / counts[rows], (rows, columns)), shape=(len(vertices), len(samples)))
