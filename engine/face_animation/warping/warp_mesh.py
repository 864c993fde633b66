"""The mesh that carries a picture, as a frame uses it: control offsets in, the inverse map out.

It is built by `engine.face_animation.warping.dense_field`, once for a target, and kept.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from engine.compiled import njit
from engine.imaging.warping.fold_edges import folded_box
from engine.imaging.warping.mesh_warp import inverse_map


@dataclass(frozen=True)
class WarpMesh:
    """The mesh that carries an image and how it follows the control points.

    vertices : (V, 2) rest positions, pixels; the first ones are the face's usable control points.
    triangles : (T, 3).
    rows, columns, weights : the sparse matrix (V, C) of vertex offsets by control offsets: row v takes the entries
    from rows[v] to rows[v + 1].
    shape : (height, width).
    """

    vertices: NDArray[np.float32]
    triangles: NDArray[np.int32]
    rows: NDArray[np.int32]
    columns: NDArray[np.int32]
    weights: NDArray[np.float32]
    shape: tuple[int, int]

    def offsets(self, control_offsets: NDArray[np.floating]) -> NDArray[np.float32]:
        """(C, D) offsets of control points to (V, D) offsets of vertices."""
        return np.asarray(_product(self.rows, self.columns, self.weights, control_offsets.astype(np.float32)))

    def inverse_map(
        self,
        offsets: NDArray[np.float32],
        depth: NDArray[np.float32] | None = None,
        scale: int = 1,
        shape: tuple[int, int] | None = None,
    ) -> NDArray[np.float32]:
        """(H, W, 2): for each pixel of the output its origin in the image, for vertex offsets (V, 2).

        `scale` gives the origin in pixels of the image enlarged by that factor. `depth` (V,) decides where the mesh
        folds over itself: the nearest is seen. `shape` (H, W) is the output's, if it is not the image's.
        """
        source = scale * (self.vertices + np.float32(0.5)) - np.float32(0.5)
        moved, shape = self.vertices + offsets, shape or self.shape
        origin = inverse_map(moved, source, self.triangles, shape)
        left, top, right, bottom = folded_box(moved, self.triangles, shape)
        if depth is not None and left < right and top < bottom:
            corner = np.array([left, top], np.float32)
            origin[top:bottom, left:right] = inverse_map(
                moved - corner, source, self.triangles, (bottom - top, right - left), depth
            )
        return origin


@njit(fastmath=True, nogil=True)
def _product(rows, columns, weights, right):  # type: ignore[no-untyped-def]
    out = np.zeros((len(rows) - 1, right.shape[1]), np.float32)
    for row in range(len(out)):
        for entry in range(rows[row], rows[row + 1]):
            for k in range(right.shape[1]):
                out[row, k] += weights[entry] * right[columns[entry], k]
    return out
