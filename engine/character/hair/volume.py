"""Hair that stands off the head or falls from it: a surface of its own around the template's head, open where no hair is seen.

Beyond the paper, whose head is a relief: with long hair that is a hood with a face before it, and from its side there is none. The picture
says how wide hair is at each height and what of it is before the neck; around the back it is as far from the head as it is at the sides,
and hangs down. What of the head is beneath it is pressed in: nothing comes through.
"""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.character.fit.template_fit import load_human
from engine.character.hair.colours import hair_round
from engine.character.hair.extent import HeadLevels, hair_extent
from engine.character.hair.rings import HAIR_CLEARANCE_PIXELS, HairRings, hair_rings
from engine.character.parts.labels import HEAD_LABEL
from engine.character.shell.colours.head_map import (
    CHIN_LANDMARK,
    EYES_LANDMARKS,
    NAPE_HEIGHT_SHARE,
    NOSE_TIP_LANDMARK,
)
from engine.character.shell.piece import Colours, Piece
from engine.character.shell.template_mesh import TemplateMesh
from engine.geometry.mesh.clipping import clip, walled
from engine.geometry.mesh.welding import same_rows
from engine.imaging.filling.nearest import nearest_values
from engine.render.rasterisation.rasteriser import rasterise

SURE_HEAD_WEIGHT = 0.9
"""Weight of the head from which on a vertex is the skull's."""
RING_COLUMNS = 80
"""Columns of vertices around the head; behind, where the first meets the last, there is one more."""
MIN_HAIR_ROWS = 8
"""Rows of hair that are worth a volume."""
HAIR_THICKNESS_PIXELS, MAX_THICKNESS_SHARE = 4.0, 0.4
"""Pixels between its walls where it hangs, at most, and the same as a share of how far it is from the head's axis."""
SKULL_DEPTH_PIXELS = 1.0
"""Pixels within the head at which its inner wall is: on the head hair has no thickness that is seen."""
FRAMED_RADIANS = 1.4
"""Radians from the front within which hair lies over where ears are: what ends at it is beside no ear."""
MIN_INNER_SHARE = 0.2
"""How far its inner wall is from the head's axis at least, as a share of how far the outer one is."""
STRAIGHT_COSINE = 0.35
"""Cosine to the viewer from which on the inner wall is straight behind the outer one."""
HEAD_HAIR_SHARE, TRUNK_HAIR_SHARE = 0.35, 0.75
"""How far below the chin, as a share of the head's height, hair moves with the head alone; how much of it moves with the trunk from twice as far on."""


@dataclass(frozen=True)
class HairedHead:
    """A head with its hair.

    hair : a closed surface, in its own colours.
    pictured : (V, 3), the shell's vertices, what is beneath hair within it.
    framed : (V,) float32, from 0 to 1, what of the head ends at hair further around: nothing else is beside it.
    """

    hair: Piece
    pictured: NDArray[np.float64]
    framed: NDArray[np.float32]


def hair_volume(
    mesh: TemplateMesh,
    pictured: NDArray[np.float64],
    rgb: NDArray[np.uint8],
    to_grid: NDArray[np.float64],
    hair: NDArray[np.bool_],
    front: NDArray[np.float32],
    back: NDArray[np.float32],
) -> HairedHead | None:
    """The hair around a head, and what of the head is beneath it within; None where there is too little.

    Parameters
    ----------
    pictured : (V, 3), the shell's vertices.
    rgb : (H, W, 3), the picture; `to_grid` (2, 3) takes its pixels to those of the grid.
    hair : (h, w), what of the grid shows hair.
    front, back : (h, w), how near and how far what is shown of the person besides reaches, z of picture space, infinite where nothing is.
    """
    if int(hair.any(1).sum()) < MIN_HAIR_ROWS:
        return None
    skull, levels = pictured[mesh.head > SURE_HEAD_WEIGHT], _levels(mesh, pictured)
    of = hair_rings(hair, skull, front, back, levels.nape)
    angles = np.linspace(-np.pi, np.pi, RING_COLUMNS + 1)
    beneath = _head_radius(mesh, pictured, of)
    outer = _clear_of_the_head(of, of.places(angles), beneath)
    outer[:, -1] = outer[:, 0]
    extent = hair_extent(hair, np.isfinite(front), of, outer, angles, levels)
    extent[:, -1] = extent[:, 0]
    pressed = _pressed(mesh, pictured, of, outer, extent)
    inner = _inner_wall(of, outer, beneath, front, levels)
    cut = clip(_grid_triangles(len(of.rows)), extent.ravel())
    walls = [cut.extended(one.reshape(-1, 3)) for one in (outer, inner)]
    column, row = np.meshgrid(np.linspace(0, 1, RING_COLUMNS + 1), np.linspace(0, 1, len(of.rows)))
    places = cut.extended(np.stack([column, row], 2).reshape(-1, 2))
    used = np.unique(cut.triangles)
    if not len(used):
        return None
    number = np.full(len(places), -1, np.int32)
    number[used] = np.arange(len(used))
    triangles = walled(number[cut.triangles], same_rows(walls[0][used]), len(used))
    vertices = np.concatenate(
        [one[used] for one in (*walls, walls[1])]
    )  # the border's inner end has the outer wall's colours
    bones, weights = _carried(mesh, skull, vertices)
    outside, inside = hair_round(rgb, to_grid, hair, np.isfinite(front), outer[..., :2], float(np.ptp(skull[:, 1])))
    places, first = places[used], outside.shape[1]
    width = first + inside.shape[1]
    outer_half = places * [(first - 1) / (width - 1), 1]
    inner_half = places * [(width - first - 1) / (width - 1), 1] + np.array([first / (width - 1), 0])
    colours = Colours(np.concatenate([outer_half, inner_half, outer_half]), np.concatenate([outside, inside], 1))
    hair_piece = Piece("Head", vertices, triangles, bones, weights, colours)
    return HairedHead(hair_piece, pressed, _framed(mesh, pictured, of, _evenly(of, outer, extent)))


def _levels(mesh: TemplateMesh, pictured: NDArray[np.float64]) -> HeadLevels:
    """The rows at which a head has its ears, its nape and its chin."""
    row = pictured[mesh.renamed(load_human().face), 1]
    eyes, nose, chin = float(row[EYES_LANDMARKS].mean()), float(row[NOSE_TIP_LANDMARK]), float(row[CHIN_LANDMARK])
    return HeadLevels((eyes + nose) / 2, chin + NAPE_HEIGHT_SHARE * (nose - chin), chin)


def _polar(of: HairRings, places: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Radians from the front around to the right, and pixels from the head's axis, of places (..., 3)."""
    aside, ahead = places[..., 0] - of.axis, places[..., 2] - of.middle
    return np.arctan2(aside, ahead), np.hypot(aside, ahead)


def _at(
    values: NDArray[np.floating], of: HairRings, angles: NDArray[np.float64], rows: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Values (R, `RING_COLUMNS` + 1) of rows and of even angles from -pi to pi at other angles and rows (...)."""
    x = (angles + np.pi) / (2 * np.pi) * RING_COLUMNS
    column, row = (np.atleast_2d(each).astype(np.float32) for each in (x, rows - of.rows[0]))
    found = cv2.remap(np.asarray(values, np.float32), column, row, cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE)
    return np.asarray(found, np.float64).reshape(angles.shape)


def _evenly(of: HairRings, outer: NDArray[np.float64], values: NDArray[np.float64]) -> NDArray[np.float64]:
    """Values (R, `RING_COLUMNS` + 1) of the vertices of the `outer` wall at even angles about the head's axis from -pi to pi."""
    angle, _ = _polar(of, outer)
    even = np.linspace(-np.pi, np.pi, values.shape[1])
    rows = [np.interp(even, own[:-1], row[:-1], period=2 * np.pi) for own, row in zip(angle, values, strict=True)]
    return np.stack(rows)


def _head_radius(mesh: TemplateMesh, pictured: NDArray[np.float64], of: HairRings) -> NDArray[np.float64]:
    """How far head and neck, without ears, are from the axis (R, `RING_COLUMNS` + 1) at even angles from -pi to pi; 0 above and below them."""
    own = (mesh.parts[:, HEAD_LABEL] > 0.5) & ~mesh.ear & ~mesh.eye
    corners = mesh.triangles[own[mesh.triangles].all(1)]
    angle, radius = _polar(of, pictured)
    turned = angle[corners]
    turned = turned[:, :1] + (turned - turned[:, :1] + np.pi) % (2 * np.pi) - np.pi
    columns = (turned + np.pi) / (2 * np.pi) * RING_COLUMNS
    places = np.stack([columns, pictured[corners, 1] - of.rows[0], -radius[corners]], -1)
    copies = np.concatenate([places + np.array([turn * RING_COLUMNS, 0, 0]) for turn in (0, -1, 1)]).reshape(-1, 3)
    drawn = rasterise(copies, np.arange(len(copies), dtype=np.int32).reshape(-1, 3), (len(of.rows), RING_COLUMNS + 1))
    there = drawn.triangle >= 0
    if not there.any():
        return np.zeros(there.shape)
    wide, deep = (np.concatenate([one[:, :-1], one, one[:, 1:]], 1) for one in (there, drawn.depth))
    filled = -nearest_values(deep, wide)[:, RING_COLUMNS : 2 * RING_COLUMNS + 1]
    return np.where(there.any(1, keepdims=True), filled, 0.0)


def _clear_of_the_head(of: HairRings, places: NDArray[np.float64], beneath: NDArray[np.float64]) -> NDArray[np.float64]:
    """The `places` (R, N, 3) of hair moved outwards from what is `beneath` (R, N), no further aside than its outline."""
    angle, radius = _polar(of, places)
    clear = np.maximum(radius, _at(beneath, of, angle, places[..., 1]) + HAIR_CLEARANCE_PIXELS)
    moved = places.copy()
    moved[..., 0] = np.clip(of.axis + clear * np.sin(angle), of.left[:, None], of.right[:, None])
    moved[..., 2] = of.middle + clear * np.cos(angle)
    rise = np.clip(np.arange(len(of.rows)) / (2 * HAIR_CLEARANCE_PIXELS), 0, 1)  # at its top a ring is closed
    return places + rise[:, None, None] * (moved - places)


def _inner_wall(
    of: HairRings,
    outer: NDArray[np.float64],
    beneath: NDArray[np.float64],
    front: NDArray[np.float32],
    levels: HeadLevels,
) -> NDArray[np.float64]:
    """The inner wall (R, N, 3): within the head as far as there is one, and close to the `outer` one where hair hangs. In front it is straight
    behind that, so that a viewer sees nothing of the border between both; `front` (h, w): how near what is beneath reaches."""
    angle, radius = _polar(of, outer)
    thin = radius - np.minimum(HAIR_THICKNESS_PIXELS, MAX_THICKNESS_SHARE * radius)
    hangs = np.clip((of.rows - levels.nape) / max(levels.chin - levels.nape, 1), 0, 1)[:, None]
    head = np.clip(_at(beneath, of, angle, outer[..., 1]) - SKULL_DEPTH_PIXELS, MIN_INNER_SHARE * radius, thin)
    within = head + hangs * (thin - head)
    inner = outer.copy()
    inner[..., 0], inner[..., 2] = of.axis + within * np.sin(angle), of.middle + within * np.cos(angle)
    x, y = (np.rint(outer[..., k]).astype(np.intp).clip(0, front.shape[1 - k] - 1) for k in (0, 1))
    behind = outer[..., 2] - HAIR_THICKNESS_PIXELS
    head = np.where(np.isfinite(front[y, x]), np.minimum(front[y, x] - SKULL_DEPTH_PIXELS, behind), behind)
    straight = np.maximum(head + hangs * (behind - head), of.middle)
    share = np.clip(np.cos(angle) / STRAIGHT_COSINE, 0, 1)[..., None]
    return inner + share * (
        np.stack([outer[..., 0], outer[..., 1], np.minimum(straight, outer[..., 2] - SKULL_DEPTH_PIXELS)], 2) - inner
    )


def _pressed(
    mesh: TemplateMesh,
    pictured: NDArray[np.float64],
    of: HairRings,
    outer: NDArray[np.float64],
    extent: NDArray[np.float64],
) -> NDArray[np.float64]:
    """The vertices `pictured` (V, 3) with what of the head is beneath hair within its `outer` wall (R, N, 3)."""
    own = (mesh.parts[:, HEAD_LABEL] > 0.5) & ~mesh.eye
    angle, radius = _polar(of, pictured)
    row = np.maximum(pictured[:, 1], of.rows[0] + HAIR_CLEARANCE_PIXELS)
    beside = own & (row <= of.rows[-1])
    there, wall = (_evenly(of, outer, one) for one in (extent, _polar(of, outer)[1]))
    covered = np.clip(2 * _at(there, of, angle, row), 0, 1) * beside
    most = np.maximum(_at(wall, of, angle, row) - HAIR_CLEARANCE_PIXELS, 0)
    within = radius + covered * np.minimum(most - radius, 0)
    moved = pictured.copy()
    moved[own, 0] = (of.axis + within * np.sin(angle))[own]
    moved[own, 1] = (pictured[:, 1] + covered * (row - pictured[:, 1]))[own]
    moved[own, 2] = (of.middle + within * np.cos(angle))[own]
    return moved


def _framed(
    mesh: TemplateMesh,
    pictured: NDArray[np.float64],
    of: HairRings,
    extent: NDArray[np.float64],
) -> NDArray[np.float32]:
    """From 0 to 1 (V,), what of the head has hair further aside at its height, before where an ear is. `extent` (R, `RING_COLUMNS` + 1): where
    hair is, at even angles from -pi to pi."""
    angles = np.linspace(-np.pi, np.pi, RING_COLUMNS + 1)
    covered = np.clip(2 * extent, 0, 1) * (np.abs(angles) < FRAMED_RADIANS)
    half = RING_COLUMNS // 2
    further = np.maximum.accumulate(covered[:, half:][:, ::-1], 1)[:, ::-1]
    nearer = np.maximum.accumulate(covered[:, : half + 1], 1)
    angle, _ = _polar(of, pictured)
    row = pictured[:, 1]
    found = _at(np.concatenate([nearer[:, :-1], further], 1), of, angle, row)
    beside = (mesh.parts[:, HEAD_LABEL] > 0.5) & (row >= of.rows[0]) & (row <= of.rows[-1])
    return np.where(beside, found, 0).astype(np.float32)


def _grid_triangles(rows: int) -> NDArray[np.int32]:
    """Triangles of so many rows of `RING_COLUMNS` + 1 vertices, turned outwards."""
    number = np.arange(rows * (RING_COLUMNS + 1)).reshape(rows, -1)
    upper, following, lower, below = number[:-1, :-1], number[:-1, 1:], number[1:, :-1], number[1:, 1:]
    halves = [np.stack([upper, lower, below], -1), np.stack([upper, below, following], -1)]
    return np.concatenate([half.reshape(-1, 3) for half in halves]).astype(np.int32)


def _carried(
    mesh: TemplateMesh, skull: NDArray[np.float64], places: NDArray[np.float64]
) -> tuple[NDArray[np.intp], NDArray[np.float32]]:
    """(N, 4) joints and (N, 4) weights: the head above, and further and further down the trunk."""
    chin, height = skull[:, 1].max(), np.ptp(skull[:, 1])
    down = np.clip((places[:, 1] - chin) / (HEAD_HAIR_SHARE * height) - 1, 0, 1)
    share = TRUNK_HAIR_SHARE * down * down * (3 - 2 * down)
    weights = np.stack([1 - share, share, 0 * share, 0 * share], 1)
    names = [mesh.names.index(name) for name in ("Head", "Spine2", "Head", "Head")]
    return np.tile(np.array(names, np.intp), (len(places), 1)), weights.astype(np.float32)
