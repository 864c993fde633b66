"""A closed lens over an area of the picture: what has an outline and no back."""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import distance_transform_edt
from scipy.spatial import cKDTree

from engine.character.figure.silhouette import Silhouette
from engine.character.parts.labels import ARM_LABELS
from engine.character.shell.piece import Piece
from engine.character.shell.template_mesh import TemplateMesh
from engine.geometry.mesh.adjacency import open_edges

VERTEX_SPACING_PIXELS = 2
"""Pixels between the vertices of a piece."""
SHELL_UNDERLAP_PIXELS = 8
"""Pixels by which a piece goes on beneath the shell."""
MIN_PIECE_THICKNESS_PIXELS = 0.1
"""Pixels between front and back of a piece where it ends."""
SECTION_FLATTENING_RATIO = 0.8
"""The depth of a piece's section, as a share of a circle's."""
MIN_ARM_WEIGHT_SHARE = 0.6
"""Share of arms in what moves a piece of cloth from which on it is an arm's."""
MAX_PROP_BORDER_SHIFT_PIXELS, MIN_PROP_MASK_SLOPE = 2.5, 0.05
"""Pixels by which the border of a piece is drawn to the outline at most, and the slope of the mask from which it is."""
DEPTH_SMOOTHING_VERTICES, WEIGHT_SMOOTHING_VERTICES = 5.0, 6.0
"""Vertices over which depths and weights are smoothed."""
PROP_NEIGHBOUR_COUNT = 6


@dataclass(frozen=True)
class _Lattice:
    """Vertices of a piece by row and column.

    used : (R, C) where there is one.
    x, y : (N,) where it is.
    cells : (M, 4) those around each cell.
    """

    used: NDArray[np.bool_]
    x: NDArray[np.float64]
    y: NDArray[np.float64]
    cells: NDArray[np.intp]

    def smoothed(self, values: NDArray[np.floating], sigma: float) -> NDArray[np.float64]:
        """Values (N, C) smoothed over the piece alone."""
        out = np.empty(values.shape)
        weight = np.maximum(cv2.GaussianBlur(self.used.astype(np.float32), (0, 0), sigma), 1e-6)[self.used]
        image = np.zeros(self.used.shape, np.float32)
        for k in range(values.shape[1]):
            image[self.used] = values[:, k]
            out[:, k] = cv2.GaussianBlur(image, (0, 0), sigma)[self.used] / weight
        return out


def lens_over(
    mesh: TemplateMesh,
    pictured: NDArray[np.float64],
    rims: tuple[NDArray[np.intp], cKDTree],
    silhouette: Silhouette,
    reach: NDArray[np.bool_],
    beneath: NDArray[np.floating],
    carrier: str,
    half: float,
    depth: float | None = None,
) -> Piece | None:
    """A closed lens over an area of the picture, which follows the outline where it ends there. None where that is too small.

    Parameters
    ----------
    pictured : (V, 3), the shell's vertices.
    rims : those of them on its rims (R,), and a tree of their places in the picture.
    reach : (h, w) bool, the area.
    beneath : (h, w), by how many pixels each is beneath the shell, where the lens is thin.
    carrier : the joint that moves it; `soft`: what moves the shell around it.
    half : pixels that it is thick to each side in the middle.
    depth : of its middle; as deep as the shell around it unless it is given.
    """
    lattice = _lattice(reach)
    if len(lattice.cells) < 8:
        return None
    rim, tree = rims
    x, y, moved = _to_outline(lattice, silhouette)
    _, nearest = tree.query(np.stack([x, y], 1), PROP_NEIGHBOUR_COUNT)
    middle = lattice.smoothed(pictured[rim[nearest], 2].mean(1)[:, None], DEPTH_SMOOTHING_VERTICES)[:, 0]
    if depth is not None:
        middle = np.full_like(middle, depth)
    at = (lattice.y.astype(int), lattice.x.astype(int))
    border = distance_transform_edt(silhouette.mask if depth is None else reach)[at]
    thick = (
        np.where(moved | (border < 1.5), 0, half * np.sqrt(1 - (1 - np.clip(border / half, 0, 1)) ** 2))
        * SECTION_FLATTENING_RATIO
    )
    thick *= np.clip(1 - beneath[at] / (SHELL_UNDERLAP_PIXELS + 1), 0.15, 1)
    front, back = (np.stack([x, y, middle + sign * (thick + MIN_PIECE_THICKNESS_PIXELS / 2)], 1) for sign in (1, -1))
    a, b, c, d = lattice.cells.T
    faces = np.concatenate([np.stack([a, d, c], 1), np.stack([a, c, b], 1)])
    count = len(x)
    p, q = open_edges(faces).T
    wall = np.concatenate([np.stack([q, p, p + count], 1), np.stack([q, p + count, q + count], 1)])
    triangles = np.concatenate([faces, faces[:, ::-1] + count, wall]).astype(np.int32)
    bones, weights = _carried(mesh, rim[nearest], lattice, carrier)
    twice = np.concatenate
    return Piece(carrier, twice([front, back]), triangles, twice([bones, bones]), twice([weights, weights]))


def _lattice(reach: NDArray[np.bool_]) -> _Lattice:
    cells = reach[1::VERTEX_SPACING_PIXELS, 1::VERTEX_SPACING_PIXELS]
    rows, columns = np.nonzero(cells)
    used = np.zeros((cells.shape[0] + 1, cells.shape[1] + 1), np.bool_)
    corners = ((0, 0), (0, 1), (1, 1), (1, 0))
    for dy, dx in corners:
        used[rows + dy, columns + dx] = True
    number = np.full(used.shape, -1)
    number[used] = np.arange(used.sum())
    y, x = np.nonzero(used)
    within = np.array(reach.shape) - 1
    return _Lattice(
        used,
        np.minimum(VERTEX_SPACING_PIXELS * x, within[1]).astype(np.float64),
        np.minimum(VERTEX_SPACING_PIXELS * y, within[0]).astype(np.float64),
        np.stack([number[rows + dy, columns + dx] for dy, dx in corners], 1),
    )


def _to_outline(
    lattice: _Lattice, silhouette: Silhouette
) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.bool_]]:
    """The vertices' columns and rows (N,), those of its border drawn to where the mask is half, and which of them were."""
    soft = cv2.GaussianBlur(silhouette.soft, (0, 0), 1.0)
    slopes = [cv2.Sobel(soft, cv2.CV_32F, dx, 1 - dx, scale=1 / 8) for dx in (1, 0)]
    at = (lattice.y.astype(int), lattice.x.astype(int))
    slope = np.stack([one[at] for one in slopes], 1).astype(np.float64)
    steep = np.linalg.norm(slope, axis=1)
    around = np.bincount(lattice.cells.ravel(), minlength=len(lattice.x)) < 4
    moved = around & (steep > MIN_PROP_MASK_SLOPE) & (distance_transform_edt(silhouette.mask)[at] < 4)
    way = np.clip(
        (0.5 - soft[at]) / np.maximum(steep, 0.02), -MAX_PROP_BORDER_SHIFT_PIXELS, MAX_PROP_BORDER_SHIFT_PIXELS
    )
    shift = np.where(moved[:, None], slope / np.maximum(steep, 1e-6)[:, None] * way[:, None], 0)
    return lattice.x + shift[:, 0], lattice.y + shift[:, 1], moved


def _carried(
    mesh: TemplateMesh, nearest: NDArray[np.intp], lattice: _Lattice, carrier: str
) -> tuple[NDArray[np.intp], NDArray[np.float32]]:
    """What moves a piece's vertices, `nearest` (N, K) to them the shell's: (N, 4) joints and (N, 4) weights."""
    count = len(nearest)
    if carrier != "soft":
        weights = np.tile(np.array([1, 0, 0, 0], np.float32), (count, 1))
        return np.full((count, 4), mesh.names.index(carrier), np.intp), weights
    dense = np.zeros((count, len(mesh.names)))
    np.add.at(
        dense,
        (np.arange(count)[:, None, None], mesh.bones[nearest]),
        mesh.weights[nearest].astype(np.float64) / nearest.shape[1],
    )
    of_arm = np.zeros(len(mesh.names), np.bool_)
    of_arm[np.unique(mesh.bones[mesh.parts[:, list(ARM_LABELS)].sum(1) > 0.99, 0])] = True
    arms = dense[:, of_arm].sum() > MIN_ARM_WEIGHT_SHARE * dense.sum()
    dense[:, ~of_arm if arms else of_arm] = 0  # between an arm and what it leaves it would be drawn out
    dense[:, int(dense.sum(0).argmax()) if arms else mesh.names.index("Hips")] += 1e-4
    used = np.flatnonzero(dense.any(0))
    dense[:, used] = lattice.smoothed(dense[:, used], WEIGHT_SMOOTHING_VERTICES)
    bones = np.argsort(-dense, 1)[:, :4]
    shares = dense[np.arange(count)[:, None], bones]
    return bones.astype(np.intp), (shares / shares.sum(1, keepdims=True)).astype(np.float32)
