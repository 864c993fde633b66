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
from numpy.typing import NDArray

from engine.compiled import njit
from engine.face_animation.warping.contour_rings import contour_rings, rings_end
from engine.face_animation.warping.lip_edges import parted_lips, parting_edges
from engine.face_animation.warping.round_cheeks import points_between
from engine.face_animation.warping.warp_mesh import WarpMesh
from engine.imaging.warping.constrained_delaunay import constrained_delaunay
from engine.imaging.warping.delaunay import delaunay
from engine.perception.face.landmarks import FACE_OVAL

BLUR_KERNEL_COUNT = 10
"""Section 4: "10 different blurring kernels"."""
LARGEST_DISK_DIAGONALS = 0.05
"""Section 4: radii in [0, 0.05 of the image's diagonal]."""
FALLOFF_DIAGONALS = 0.15
"""Distance from the face, in diagonals, where the largest disk is reached. The paper leaves it open."""
VERTICES_ON_DIAGONAL = 64
"""Vertices of the mesh's regular part along the diagonal; finer ones change the field by < 0.1 px."""
MESH_MARGIN_DIAGONALS = 0.5
"""Diagonals by which the mesh reaches beyond the image."""
INSIDE_TOLERANCE = 1e-9
"""Pixels and weights by which a point may lie beside a triangle and still counts as inside."""


def disk_radii(face: NDArray[np.floating], points: NDArray[np.floating], shape: tuple[int, int]) -> NDArray[np.float64]:
    """Radius of the smoothing disk at each point, pixels: 0 on the face, growing away from it, in `BLUR_KERNEL_COUNT` steps.

    Parameters
    ----------
    face : (478, 2) target mesh. points : (N, 2). shape : (height, width).
    """
    diagonal = float(np.hypot(*shape))
    oval = face[list(FACE_OVAL), :2].astype(np.float32)
    outside = np.array([-cv2.pointPolygonTest(oval, (float(x), float(y)), True) for x, y in points])
    level = np.clip(outside / (FALLOFF_DIAGONALS * diagonal), 0, 1)
    return np.round(level * (BLUR_KERNEL_COUNT - 1)) / (BLUR_KERNEL_COUNT - 1) * LARGEST_DISK_DIAGONALS * diagonal


def interpolation(
    control: NDArray[np.floating], triangles: NDArray[np.int32], points: NDArray[np.floating]
) -> tuple[NDArray[np.int32], NDArray[np.float64]]:
    """Piecewise-linear interpolation over triangles (T, 3) of control points (C, 2).

    Returns
    -------
    For each of the points (N, 2) the three control points around it, (N, 3), and their weights, (N, 3), which sum to
    one. Points outside the control points' hull take the value of the nearest control point.
    """
    order = np.argsort(points[:, 1], kind="stable")
    corners, weights = np.zeros((len(points), 3), np.int32), np.zeros((len(points), 3))
    _locate(control, triangles, points[order, 0], points[order, 1], order, corners, weights)
    outside = np.flatnonzero(weights.sum(axis=1) == 0)
    if len(outside):
        nearest = ((points[outside, None] - control[None]) ** 2).sum(axis=2).argmin(axis=1)
        corners[outside], weights[outside, 0] = nearest[:, None], 1
    return corners, weights


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
    spacing = diagonal / VERTICES_ON_DIAGONAL
    used = np.arange(len(control)) if usable is None else np.flatnonzero(usable)
    on_face, face = used[used < len(face)], parted_lips(face)
    around = contour_rings(face, shape), _grid_around(face, shape, spacing)
    vertices = np.concatenate([face[on_face, :2].astype(float), *around])
    triangles = delaunay(control[used])
    corners, weights = interpolation(control[used], triangles, vertices)
    corners[: len(on_face)], weights[: len(on_face)] = np.arange(len(on_face))[:, None], (1, 0, 0)
    matrix = np.zeros((len(vertices), len(control)), np.float32)
    np.add.at(matrix, (np.arange(len(vertices))[:, None], used[corners]), weights.astype(np.float32))
    between, follow = points_between(face, on_face)
    vertices = np.concatenate([vertices, between])
    rounded = np.zeros((len(between), len(control)), np.float32)
    rounded[:, on_face] = follow.toarray()
    matrix = np.concatenate([matrix, rounded])
    if smoothing != "none":
        radii = (
            disk_radii(face, vertices, shape)
            if smoothing == "confidence"
            else np.full(len(vertices), LARGEST_DISK_DIAGONALS * diagonal / 2)
        )
        on_border = ((vertices <= 0) | (vertices >= np.array([width - 1, height - 1]))).any(axis=1)
        smooth = np.flatnonzero((radii >= spacing / 2) & ~on_border)
        across = np.linspace(0, width - 1, int(np.ceil(2 * width / spacing)) + 1)
        down = np.linspace(0, height - 1, int(np.ceil(2 * height / spacing)) + 1)
        samples = np.stack(np.meshgrid(across, down), axis=-1).reshape(-1, 2)
        corners, weights = interpolation(control[used], triangles, samples)
        inside = np.minimum(vertices[smooth], (width - 1, height - 1) - vertices[smooth]).min(axis=1)
        reach = np.maximum(np.minimum(radii[smooth], inside), 0.75 * spacing)
        matrix[smooth] = _disk_average(vertices[smooth], reach, across, down, used[corners], weights, len(control))
    entries = matrix != 0
    return WarpMesh(
        vertices.astype(np.float32),
        constrained_delaunay(vertices, parting_edges(on_face)),
        np.concatenate([[0], np.cumsum(entries.sum(axis=1))]).astype(np.int32),
        np.nonzero(entries)[1].astype(np.int32),
        matrix[entries],
        shape,
    )


def _grid_around(face: NDArray[np.floating], shape: tuple[int, int], spacing: float) -> NDArray[np.float64]:
    """A regular grid outside the rings around the face's contour that reaches the image's corners, and one ring of vertices beyond its
    border: what it brings into the picture repeats the image's border."""
    height, width = shape
    beyond = MESH_MARGIN_DIAGONALS * float(np.hypot(height, width))
    xs, ys = (
        np.concatenate([[-beyond], np.linspace(0, side - 1, int(np.ceil(side / spacing)) + 1), [side - 1 + beyond]])
        for side in (width, height)
    )
    grid = np.stack(np.meshgrid(xs, ys), axis=-1).reshape(-1, 2)
    oval = face[list(FACE_OVAL), :2].astype(np.float32)
    outside = np.array([-cv2.pointPolygonTest(oval, (float(x), float(y)), True) for x, y in grid])
    return grid[outside > rings_end(face) + 0.4 * spacing]


@njit(nogil=True)
def _locate(control, triangles, x, y, order, corners, weights):  # type: ignore[no-untyped-def]
    """Write corners and weights (N, 3) of the points that lie in a triangle; x and y are sorted by y."""
    for t in range(len(triangles)):
        a, b, c = triangles[t, 0], triangles[t, 1], triangles[t, 2]
        bx, by = control[b, 0] - control[a, 0], control[b, 1] - control[a, 1]
        cx, cy = control[c, 0] - control[a, 0], control[c, 1] - control[a, 1]
        area = bx * cy - by * cx
        if area == 0:
            continue
        top = control[a, 1] + min(0.0, by, cy)
        bottom = control[a, 1] + max(0.0, by, cy)
        for k in range(_below(y, top - INSIDE_TOLERANCE, False), _below(y, bottom + INSIDE_TOLERANCE, False)):
            px, py = x[k] - control[a, 0], y[k] - control[a, 1]
            wb, wc = (px * cy - py * cx) / area, (bx * py - by * px) / area
            if min(wb, wc, 1 - wb - wc) >= -INSIDE_TOLERANCE:
                at = order[k]
                corners[at, 0], corners[at, 1], corners[at, 2] = a, b, c
                weights[at, 0], weights[at, 1], weights[at, 2] = 1 - wb - wc, wb, wc


@njit(nogil=True)
def _below(places, value, or_at):  # type: ignore[no-untyped-def]
    """How many of the places, which rise, are below a value, `or_at` it."""
    low, high = 0, len(places)
    while low < high:
        middle = (low + high) // 2
        if places[middle] < value or (or_at and places[middle] == value):
            low = middle + 1
        else:
            high = middle
    return low


@njit(nogil=True)
def _disk_average(vertices, radii, across, down, corners, weights, count):  # type: ignore[no-untyped-def]
    """(V, count) float32: what the mean over the samples within each vertex's disk takes of each control point. The
    samples lie where `across` and `down` cross, row by row; corners and weights (S, 3) are theirs."""
    out = np.zeros((len(vertices), count), np.float32)
    for v in range(len(vertices)):
        x, y, radius = vertices[v, 0], vertices[v, 1], radii[v]
        inside = 0
        for row in range(_below(down, y - radius, False), _below(down, y + radius, True)):
            wide = np.sqrt(max(radius**2 - (down[row] - y) ** 2, 0.0))
            for column in range(_below(across, x - wide, False), _below(across, x + wide, True)):
                inside += 1
                sample = row * len(across) + column
                for k in range(3):
                    out[v, corners[sample, k]] += weights[sample, k]
        for k in range(count):
            out[v, k] /= inside
    return out
