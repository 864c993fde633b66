"""What the outline shows beside the shell, a bag, a ball, a brim, hair: lenses of their own.

What a hand holds or a head wears is rigid with it; other pieces, such as the flap of a coat, go with the body beside them.
"""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import distance_transform_edt
from scipy.spatial import cKDTree

from engine.body.parts import BODY_PARTS
from engine.character.figure.silhouette import GRID_HEIGHT_PIXELS, Silhouette
from engine.character.parts.labels import ARM_LABELS
from engine.character.shell.piece import Piece
from engine.character.shell.template_mesh import TemplateMesh
from engine.geometry.mesh.surface import vertex_normals
from engine.render.rasteriser import rasterise

VERTEX_SPACING_PIXELS = 2
"""Pixels between the vertices of a piece."""
MIN_PROP_PIXELS, MIN_HELD_PIECE_PIXELS = 110, 50
"""Pixels of what is worth being a piece; and of what a hand holds or is on a head."""
MIN_PROP_REACH_PIXELS, MIN_HEAD_REACH_PIXELS = 6.0, 3.0
"""How far, in pixels, the furthest of a piece is from the shell at least; the same of a head's, for hair is all around it."""
SHELL_UNDERLAP_PIXELS = 8
"""Pixels by which a piece goes on beneath the shell."""
MAX_PROP_RIM_NORMAL_DEPTH = 0.45
"""Of a unit normal towards the viewer, at most, on a rim."""
MIN_HAND_RIM_SHARE, MIN_HEAD_RIM_SHARE, MIN_FOOT_RIM_SHARE = 0.35, 0.5, 0.4
"""Share of the rim's nearest vertices that are a hand's, the head's or a foot's where a piece is theirs. At feet nothing is: what is left
there is the fit's error."""
DEPTH_PER_DISTANCE, MAX_DEPTH_SHARES = 1.2, {"head": 0.05, "hand": 0.05, "soft": 0.04}
"""How deep a piece is to each side: by its distance from the shell, and at most, as a share of the person's height."""
SECTION_FLATTENING_RATIO = 0.8
"""The depth of a piece's section, as a share of a circle's."""
MIN_ARM_WEIGHT_SHARE = 0.6
"""Share of arms in what moves a piece of cloth from which on it is an arm's."""
MAX_PROP_BORDER_SHIFT_PIXELS, MIN_PROP_MASK_SLOPE = 2.5, 0.05
"""Pixels by which its border is drawn to the outline at most, and the slope of the mask from which it is."""
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


def props_of(
    mesh: TemplateMesh, pictured: NDArray[np.float64], silhouette: Silhouette, others: list[Piece]
) -> list[Piece]:
    """The pieces of the outline that neither the shell as `pictured` (V, 3) nor `others` cover."""
    mask = silhouette.mask
    covered = _covered(pictured, mesh.triangles, mask.shape)
    for other in others:
        covered |= _covered(other.vertices, other.triangles, mask.shape)
    rest = cv2.morphologyEx((mask & ~covered).astype(np.uint8), cv2.MORPH_OPEN, _disk(1))
    count, pieces, stats, _ = cv2.connectedComponentsWithStats(rest, connectivity=4)
    away = distance_transform_edt(~covered)
    normals = vertex_normals(pictured, mesh.triangles)
    rim = np.flatnonzero((np.abs(normals[:, 2]) < MAX_PROP_RIM_NORMAL_DEPTH) & ~mesh.eye)
    tree = cKDTree(pictured[rim, :2])
    found = []
    for number in range(1, count):
        own = pieces == number
        if stats[number, cv2.CC_STAT_AREA] < MIN_HELD_PIECE_PIXELS:
            continue
        y, x = np.nonzero(own)
        near = rim[np.asarray(tree.query(np.stack([x, y], 1)[::3])[1])]
        carrier = _carrier(mesh, near)
        furthest = float(away[own].max())
        if carrier is None or furthest < (MIN_HEAD_REACH_PIXELS if carrier == "Head" else MIN_PROP_REACH_PIXELS):
            continue
        if carrier == "soft" and stats[number, cv2.CC_STAT_AREA] < MIN_PROP_PIXELS:
            continue
        reach = (cv2.dilate(own.astype(np.uint8), _disk(SHELL_UNDERLAP_PIXELS)) > 0) & mask
        piece = _lens(mesh, pictured, (rim, tree), silhouette, reach, covered, carrier, furthest)
        if piece is not None:
            found.append(piece)
    return found


def _carrier(mesh: TemplateMesh, near: NDArray[np.intp]) -> str | None:
    """The joint that carries a piece beside the vertices `near` (N,), `soft` where it goes with all of them, None where it is an
    error of a foot's place."""
    if (mesh.foot[near] > 0.3).mean() > MIN_FOOT_RIM_SHARE:
        return None
    hand = near[mesh.hand[near] > 0.5]
    if len(hand) > MIN_HAND_RIM_SHARE * len(near):
        return "LeftHand" if mesh.parts[hand, BODY_PARTS.index("left_arm")].mean() > 0.5 else "RightHand"
    return "Head" if (mesh.head[near] > 0.5).mean() > MIN_HEAD_RIM_SHARE else "soft"


def _lens(
    mesh: TemplateMesh,
    pictured: NDArray[np.float64],
    rims: tuple[NDArray[np.intp], cKDTree],
    silhouette: Silhouette,
    reach: NDArray[np.bool_],
    covered: NDArray[np.bool_],
    carrier: str,
    furthest: float,
) -> Piece | None:
    """A closed lens over the pixels `reach` (h, w): thick in the middle, thin at its border and beneath the shell."""
    lattice = _lattice(reach)
    if len(lattice.cells) < 8:
        return None
    rim, tree = rims
    x, y, moved = _to_outline(lattice, silhouette)
    _, nearest = tree.query(np.stack([x, y], 1), PROP_NEIGHBOUR_COUNT)
    middle = lattice.smoothed(pictured[rim[nearest], 2].mean(1)[:, None], DEPTH_SMOOTHING_VERTICES)[:, 0]
    kind = {"Head": "head", "soft": "soft"}.get(carrier, "hand")
    at = (lattice.y.astype(int), lattice.x.astype(int))
    border = distance_transform_edt(silhouette.mask)[at]
    half = min(DEPTH_PER_DISTANCE * furthest, MAX_DEPTH_SHARES[kind] * GRID_HEIGHT_PIXELS)
    thick = (
        np.where(moved | (border < 1.5), 0, half * np.sqrt(1 - (1 - np.clip(border / half, 0, 1)) ** 2))
        * SECTION_FLATTENING_RATIO
    )
    beneath = distance_transform_edt(covered)[at]
    thick *= np.clip(1 - beneath / (SHELL_UNDERLAP_PIXELS + 1), 0.15, 1)
    front, back = (np.stack([x, y, middle + sign * (thick + 0.05)], 1) for sign in (1, -1))
    a, b, c, d = lattice.cells.T
    faces = np.concatenate([np.stack([a, d, c], 1), np.stack([a, c, b], 1)])
    count = len(x)
    ends = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
    _, which, times = np.unique(np.sort(ends, 1), axis=0, return_inverse=True, return_counts=True)
    p, q = ends[times[which.ravel()] == 1].T
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
    if dense[:, of_arm].sum() < MIN_ARM_WEIGHT_SHARE * dense.sum():
        dense[:, of_arm] = 0
        dense[:, mesh.names.index("Hips")] += 1e-4
    used = np.flatnonzero(dense.any(0))
    dense[:, used] = lattice.smoothed(dense[:, used], WEIGHT_SMOOTHING_VERTICES)
    bones = np.argsort(-dense, 1)[:, :4]
    shares = dense[np.arange(count)[:, None], bones]
    return bones.astype(np.intp), (shares / shares.sum(1, keepdims=True)).astype(np.float32)


def _covered(vertices: NDArray[np.float64], triangles: NDArray[np.int32], shape: tuple[int, ...]) -> NDArray[np.bool_]:
    screen = np.stack([vertices[:, 0], vertices[:, 1], -vertices[:, 2]], 1)
    return np.asarray(rasterise(screen, triangles, (shape[0], shape[1])).triangle >= 0)


def _disk(radius: int) -> NDArray[np.uint8]:
    size = 2 * radius + 1
    return np.asarray(cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (size, size)), np.uint8)
