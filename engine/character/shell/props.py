"""What the outline shows beside the shell, a bag, a ball, a brim, hair: lenses of their own.

What a hand holds or a head wears is rigid with it; other pieces, such as the flap of a coat, go with the body beside them.
"""

from __future__ import annotations

from dataclasses import replace

import cv2
import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import distance_transform_edt
from scipy.spatial import cKDTree

from engine.body.parts import BODY_PARTS
from engine.character.figure.silhouette import GRID_HEIGHT_PIXELS, Silhouette
from engine.character.parts.labels import ARM_LABELS
from engine.character.shell.lens import SHELL_UNDERLAP_PIXELS, lens_over
from engine.character.shell.piece import Piece
from engine.character.shell.template_mesh import TemplateMesh
from engine.geometry.mesh.surface import vertex_normals
from engine.imaging.masks.mask_distance import dilate_mask, distance_inside
from engine.imaging.masks.mask_pieces import pieces_by_area
from engine.render.rasterisation.rasteriser import rasterise

MIN_PROP_PIXELS, MIN_HELD_PIECE_PIXELS = 110, 50
"""Pixels of what is worth being a piece; and of what a hand holds or is on a head."""
MIN_PROP_REACH_PIXELS, MIN_HEAD_REACH_PIXELS = 6.0, 3.0
"""How far, in pixels, the furthest of a piece is from the shell at least; the same of a head's, for hair is all around it."""
MAX_PROP_RIM_NORMAL_DEPTH = 0.45
"""Of a unit normal towards the viewer, at most, on a rim."""
MIN_HAND_RIM_SHARE, MIN_HEAD_RIM_SHARE, MIN_FOOT_RIM_SHARE = 0.35, 0.5, 0.4
"""Share of the rim's nearest vertices that are a hand's, the head's or a foot's where a piece is theirs. At feet nothing is: what is left
there is the fit's error."""
DEPTH_PER_DISTANCE, MAX_DEPTH_SHARES = 1.2, {"head": 0.05, "hand": 0.05, "soft": 0.04}
"""How deep a piece is to each side: by its distance from the shell, and at most, as a share of the person's height."""
MAX_HELD_DEPTH_SHARE, HELD_CLOSING_PIXELS, SEEN_HELD_SHARE = 0.07, 14, 0.85
"""Of what is held: how deep it is to each side at most, as a share of the person's height. Then half of the pixels
between its edges over which it goes on beneath fingers, and how much of what is seen of it is before the shell."""


def props_of(
    mesh: TemplateMesh,
    pictured: NDArray[np.float64],
    silhouette: Silhouette,
    others: list[Piece],
    held: NDArray[np.int8] | None = None,
) -> list[Piece]:
    """What is `held` (h, w; the arm's label, -1 where nothing is), and the pieces of the outline that neither that nor the shell as `pictured`
    (V, 3) nor `others` cover."""
    mask = silhouette.mask
    covered = _covered(pictured, mesh.triangles, mask.shape)
    depth = _nearest_depth(pictured, mesh.triangles, mask.shape)
    for other in others:
        covered |= _covered(other.vertices, other.triangles, mask.shape)
        depth = np.maximum(depth, _nearest_depth(other.vertices, other.triangles, mask.shape))
    if held is not None:
        covered |= held >= 0
    rest = cv2.morphologyEx((mask & ~covered).astype(np.uint8), cv2.MORPH_OPEN, _disk(1))
    count, pieces, stats, _ = cv2.connectedComponentsWithStats(rest, connectivity=4)
    away = distance_transform_edt(~covered)
    normals = vertex_normals(pictured, mesh.triangles)
    rim = np.flatnonzero((np.abs(normals[:, 2]) < MAX_PROP_RIM_NORMAL_DEPTH) & ~mesh.eye)
    tree = cKDTree(pictured[rim, :2])
    found = [] if held is None else _held_pieces(mesh, pictured, (rim, tree), silhouette, held, depth)
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
        beneath = distance_transform_edt(covered)
        half = min(DEPTH_PER_DISTANCE * furthest, MAX_DEPTH_SHARES[_kind(carrier)] * GRID_HEIGHT_PIXELS)
        piece = lens_over(mesh, pictured, (rim, tree), silhouette, reach, beneath, carrier, half)
        if piece is not None:
            found.append(piece)
    return found


def _held_pieces(
    mesh: TemplateMesh,
    pictured: NDArray[np.float64],
    rims: tuple[NDArray[np.intp], cKDTree],
    silhouette: Silhouette,
    held: NDArray[np.int8],
    depth: NDArray[np.float32],
) -> list[Piece]:
    """What hands hold, whole: as thick as it is wide, up to a limit, and before all of the shell that it hides."""
    found = []
    for arm, carrier in zip(ARM_LABELS, ("LeftHand", "RightHand"), strict=True):
        for thing in pieces_by_area(held == arm, MIN_HELD_PIECE_PIXELS):
            closed = cv2.morphologyEx(thing.astype(np.uint8), cv2.MORPH_CLOSE, _disk(HELD_CLOSING_PIXELS)) > 0
            reach = dilate_mask(closed, 1) & silhouette.mask
            half = min(float(distance_inside(thing).max()), MAX_HELD_DEPTH_SHARE * GRID_HEIGHT_PIXELS)
            own = pictured[(mesh.bones[:, 0] == mesh.names.index(carrier)) & (mesh.weights[:, 0] > 0.5), 2]
            piece = lens_over(
                mesh, pictured, rims, silhouette, reach, np.zeros(reach.shape), carrier, half, float(own.mean())
            )
            if piece is not None:
                found.append(_before_what_it_hides(piece, thing, depth, half))
    return found


def _before_what_it_hides(piece: Piece, thing: NDArray[np.bool_], depth: NDArray[np.float32], most: float) -> Piece:
    """A piece moved towards the viewer, as a whole and by `most` pixels at most, until `SEEN_HELD_SHARE` of the front of the `thing` (h, w) is
    before the shell, whose `depth` (h, w) is -inf where it is not."""
    front = piece.vertices[: len(piece.vertices) // 2]
    x, y = np.clip(np.rint(front[:, :2]), 0, [thing.shape[1] - 1, thing.shape[0] - 1]).astype(int).T
    lacking = np.sort((depth[y, x] - front[:, 2])[thing[y, x]])
    if not len(lacking):
        return piece
    forward = float(np.clip(lacking[int(SEEN_HELD_SHARE * (len(lacking) - 1))], 0, most))
    return replace(piece, vertices=piece.vertices + np.array([0, 0, forward]))


def _kind(carrier: str) -> str:
    return {"Head": "head", "soft": "soft"}.get(carrier, "hand")


def _carrier(mesh: TemplateMesh, near: NDArray[np.intp]) -> str | None:
    """The joint that carries a piece beside the vertices `near` (N,), `soft` where it goes with all of them, None where it is an
    error of a foot's place."""
    if (mesh.foot[near] > 0.3).mean() > MIN_FOOT_RIM_SHARE:
        return None
    hand = near[mesh.hand[near] > 0.5]
    if len(hand) > MIN_HAND_RIM_SHARE * len(near):
        return "LeftHand" if mesh.parts[hand, BODY_PARTS.index("left_arm")].mean() > 0.5 else "RightHand"
    return "Head" if (mesh.head[near] > 0.5).mean() > MIN_HEAD_RIM_SHARE else "soft"


def _nearest_depth(
    vertices: NDArray[np.float64], triangles: NDArray[np.int32], shape: tuple[int, ...]
) -> NDArray[np.float32]:
    raster = rasterise(vertices * [1, 1, -1], triangles, (shape[0], shape[1]))
    return np.where(raster.triangle >= 0, -raster.depth, -np.inf).astype(np.float32)


def _covered(vertices: NDArray[np.float64], triangles: NDArray[np.int32], shape: tuple[int, ...]) -> NDArray[np.bool_]:
    screen = np.stack([vertices[:, 0], vertices[:, 1], -vertices[:, 2]], 1)
    return np.asarray(rasterise(screen, triangles, (shape[0], shape[1])).triangle >= 0)


def _disk(radius: int) -> NDArray[np.uint8]:
    size = 2 * radius + 1
    return np.asarray(cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (size, size)), np.uint8)
