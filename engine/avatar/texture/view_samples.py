"""What every frame shows of every face of the surface, measured at a few points of it.

The paper renders a partial texture of each frame, which at 4096 texels are 200 MB each; what its energy asks of them is how
each face is seen, and which colours its edges have. Both are looked up at a few points, in space, so that edges at which the
texture is cut are edges like others.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.avatar.texture.views import ChartedSurface, FrameView
from engine.geometry.mesh.adjacency import edge_table, neighbours
from engine.geometry.mesh.surface import vertex_normals
from engine.render.rasterisation.visibility import depth_buffer, seen_points, view_cosines
from engine.render.textures.sampling import bilinear

FACE_SAMPLE_COORDINATES = np.array([[1, 1, 1], [1.8, 0.6, 0.6], [0.6, 1.8, 0.6], [0.6, 0.6, 1.8]]) / 3
"""Barycentric coordinates of the points at which it is asked whether a face is seen."""
SAMPLES_PER_SEAM_EDGE = 6
"""Points of an edge at which frames are compared."""
NORMAL_SMOOTHING_ROUNDS, NORMAL_SMOOTHING_SHARE = 6, 0.5
"""Rounds in which normals become half their neighbours': folds of cloth do not change who sees it best, and patches get fewer."""
RIM_SHARE = 0.004
"""Of a frame's longer side, by which masks of the person err."""
MAX_TAKEN_DEGREES = 65.0
"""Between a normal and the way to the camera, from which on nothing is taken at all."""


@dataclass(frozen=True)
class ViewSamples:
    """What N frames show of T faces, and of the E edges between two of them that are stitched.

    cosine : (T, N) float32, of the angle between each face's normal and the way to the camera; 0 where the face is not
        wholly seen, or at more than `MAX_TAKEN_DEGREES`.
    density : (T, N) float32, pixels per metre, of a face seen from the front.
    pairs : (E, 2) intp, the two faces of each edge.
    lengths : (E,) metres.
    colours : (E, N, `SAMPLES_PER_SEAM_EDGE`, 3) uint8, the frames' pixels along each edge, whether they show it or not.
    """

    cosine: NDArray[np.float32]
    density: NDArray[np.float32]
    pairs: NDArray[np.intp]
    lengths: NDArray[np.float64]
    colours: NDArray[np.uint8]


def sample_views(surface: ChartedSurface, views: Sequence[FrameView]) -> ViewSamples:
    """Look at a surface from all `views`, one after the other."""
    points, faces = np.asarray(surface.vertices, np.float64), np.ascontiguousarray(surface.triangles, np.int32)
    normals = _smooth_normals(points, faces)
    table = edge_table(faces, np.arange(len(points), dtype=np.int32))
    table = table[(table[:, 3] >= 0) & surface.stitched[table[:, 2:]].all(1)]
    along = (np.arange(SAMPLES_PER_SEAM_EDGE) + 0.5) / SAMPLES_PER_SEAM_EDGE
    start, end = points[table[:, 0]], points[table[:, 1]]
    on_edges = (start[:, None] + along[:, None] * (end - start)[:, None]).reshape(-1, 3)
    on_faces = np.einsum("sk,tkd->tsd", FACE_SAMPLE_COORDINATES, points[faces]).reshape(-1, 3)
    facing_to = normals[faces].mean(1)
    facing_to /= np.maximum(np.linalg.norm(facing_to, axis=1, keepdims=True), 1e-12)
    cosine = np.zeros((len(faces), len(views)), np.float32)
    density = np.zeros_like(cosine)
    colours = np.empty((len(table), len(views), SAMPLES_PER_SEAM_EDGE, 3), np.uint8)
    for n, view in enumerate(views):
        pixels = view.camera.project(on_faces)
        seen = seen_points(depth_buffer(view.camera, points, faces), pixels)
        if view.person is not None:
            seen[seen] = _at(_without_rim(view.person()), view.places(on_faces[seen]))
        middles = points[faces].mean(1)
        towards = view_cosines(view.camera, middles, facing_to)
        whole = seen.reshape(len(faces), -1).all(1) & (towards > np.cos(np.radians(MAX_TAKEN_DEGREES)))
        whole &= surface.stitched & (view.camera.depth(middles) < view.farthest)
        cosine[:, n] = np.where(whole, towards, 0)
        density[:, n] = view.camera.focal / np.maximum(view.camera.depth(middles), 1e-6)
        found = bilinear(view.picture(), view.places(on_edges))
        colours[:, n] = np.rint(found).astype(np.uint8).reshape(-1, SAMPLES_PER_SEAM_EDGE, 3)
    lengths = np.linalg.norm(end - start, axis=1)
    return ViewSamples(cosine, density, table[:, 2:].astype(np.intp), lengths, colours)


def _smooth_normals(points: NDArray[np.float64], faces: NDArray[np.int32]) -> NDArray[np.float64]:
    """(V, 3) normals that are means of those around; not of unit length."""
    normals = vertex_normals(points, faces).astype(np.float64)
    around = neighbours(faces, len(points))
    number = np.maximum(np.asarray(around.sum(1)).reshape(-1, 1), 1)
    for _ in range(NORMAL_SMOOTHING_ROUNDS):
        normals = (1 - NORMAL_SMOOTHING_SHARE) * normals + NORMAL_SMOOTHING_SHARE * (around @ normals) / number
    return normals


def _without_rim(mask: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """A mask (H, W) without what is next to its outline, where a frame may show either side."""
    side = 2 * max(round(RIM_SHARE * max(mask.shape)), 1) + 1
    return np.asarray(cv2.erode(mask.astype(np.uint8), np.ones((side, side), np.uint8), borderValue=1) > 0)


def _at(mask: NDArray[np.bool_], pixels: NDArray[np.floating]) -> NDArray[np.bool_]:
    """(N,) what a mask (H, W) says at pixels (N, 3); beside it nothing is the person."""
    columns, rows = np.rint(pixels[:, 0]).astype(np.intp), np.rint(pixels[:, 1]).astype(np.intp)
    inside = (rows >= 0) & (rows < mask.shape[0]) & (columns >= 0) & (columns < mask.shape[1])
    out = np.zeros(len(pixels), np.bool_)
    out[inside] = mask[rows[inside], columns[inside]]
    return out
