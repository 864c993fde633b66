"""Which vertex of a shell's rim belongs to which point of an outline.

From the outline to the surface and not the other way: every point of the outline has a rim, but not every rim an outline.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from engine.character.figure.silhouette import GRID_HEIGHT_PIXELS
from engine.character.parts.labels import ARM_LABELS, HEAD_LABEL, LEG_LABELS, TRUNK_LABEL
from engine.character.shell.outlines import Outlines
from engine.character.shell.template_mesh import TemplateMesh

MAX_RIM_NORMAL_DEPTH = 0.5
"""Of a unit normal towards the viewer, at most, on a rim."""
MIN_RIM_NORMAL_COSINE = 0.7
"""Cosine between an outline's normal and that of a rim that may be its."""
MAX_LATERAL_SHARE = 0.012
"""How far aside of an outline point's normal its vertex may be, as a share of the person's height; and of what it is aside,
how much counts as being further in."""
LATERAL_WEIGHT = 0.5
MAX_OUTWARD_SHARE = 0.05
"""How far from its vertex an outline may be within the body, as a share of the person's height."""
MAX_INWARD_SHARES = (0.03, 0.05, 0.05)
"""How far beyond the body an outline may be from a vertex of hands, feet and the head, as a share of the person's
height. Of the rest each round says it."""
MAX_DISPLACEMENT_SHARES = (0.045, 0.06, 0.06, 0.085)
"""How far a vertex of hands, feet, the head and the rest may be displaced along the normal, as a share of the person's height."""
BORDER_INSET_SHARE = 0.002
"""How far, as a share of the height, a part is drawn back from a border beneath which it may go on."""
MIN_BORDER_PART_WEIGHT = 0.05
"""Share of a part in what moves a vertex that may lie on its border."""
SEARCH_STEP_PIXELS = 4.0
"""Pixels between the places along a normal at which vertices are looked for."""
MATCH_NEIGHBOUR_COUNT = 10


def match_outlines(
    mesh: TemplateMesh,
    template: NDArray[np.float64],
    pictured: NDArray[np.float64],
    normals: NDArray[np.floating],
    outlines: Outlines,
    inwards: float,
) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    """The vertices (N,), and the points of the outlines (N,) that they are drawn to: for each point the outermost vertex of the
    part's rim on its normal, within reach.

    `template` and `pictured` (V, 3) are vertices as they were and as they are, `normals` (V, 3) those of the latter, z
    towards the viewer. `inwards` is how far within the outline, as a share of the person's height, a vertex may be.
    """
    rim = np.flatnonzero((np.abs(normals[:, 2]) < MAX_RIM_NORMAL_DEPTH) & ~mesh.eye & ~mesh.ear)
    along = np.arange(
        -MAX_OUTWARD_SHARE * GRID_HEIGHT_PIXELS, inwards * GRID_HEIGHT_PIXELS + SEARCH_STEP_PIXELS, SEARCH_STEP_PIXELS
    )
    places = outlines.points[:, None] - along[None, :, None] * outlines.normals[:, None]
    tree = cKDTree(pictured[rim, :2])
    near = np.asarray(
        tree.query(places, MATCH_NEIGHBOUR_COUNT, distance_upper_bound=1.3 * MAX_LATERAL_SHARE * GRID_HEIGHT_PIXELS)[1]
    )
    point, _, _ = np.nonzero(near < len(rim))
    pairs = np.unique(point.astype(np.int64) * len(pictured) + rim[near[near < len(rim)]])
    point, vertex = pairs // len(pictured), pairs % len(pictured)
    fits, depth = _fits(mesh, template, pictured, normals, outlines, (point, vertex), inwards)
    point, vertex, depth = point[fits], vertex[fits], depth[fits]
    order = np.lexsort((depth, point))
    point, first = np.unique(point[order], return_index=True)
    return vertex[order][first], point


def _fits(
    mesh: TemplateMesh,
    template: NDArray[np.float64],
    pictured: NDArray[np.float64],
    normals: NDArray[np.floating],
    outlines: Outlines,
    pairs: tuple[NDArray[np.int64], NDArray[np.int64]],
    inwards: float,
) -> tuple[NDArray[np.bool_], NDArray[np.float64]]:
    """Whether pairs (P,) of outline points and vertices may belong together, and how far (P,) within the outline these are."""
    point, vertex = pairs
    outward = outlines.normals[point]
    way = outlines.points[point] - pictured[vertex, :2]
    inside, aside = (way * outward).sum(1), np.abs(way[:, 0] * -outward[:, 1] + way[:, 1] * outward[:, 0])
    across = normals[vertex, :2] / np.maximum(np.linalg.norm(normals[vertex, :2], axis=1, keepdims=True), 1e-6)
    kinds = [mesh.hand[vertex] > 0.5, mesh.foot[vertex] > 0.5, mesh.head[vertex] > 0.5]
    reach = np.select(kinds, MAX_INWARD_SHARES, inwards) * GRID_HEIGHT_PIXELS
    limit = np.select(kinds, MAX_DISPLACEMENT_SHARES[:3], MAX_DISPLACEMENT_SHARES[3]) * GRID_HEIGHT_PIXELS
    whole = np.abs(((outlines.points[point] - template[vertex, :2]) * outward).sum(1))
    fits = (
        (aside < MAX_LATERAL_SHARE * GRID_HEIGHT_PIXELS)
        & ((across * outward).sum(1) > MIN_RIM_NORMAL_COSINE)
        & (inside < reach)
        & (whole < limit)
    )
    fits &= inside > -np.where(outlines.hidden[point], BORDER_INSET_SHARE, MAX_OUTWARD_SHARE) * GRID_HEIGHT_PIXELS
    return fits & _of_part(mesh, vertex, outlines.part[point]), inside + LATERAL_WEIGHT * aside


def _of_part(mesh: TemplateMesh, vertex: NDArray[np.int64], part: NDArray[np.intp]) -> NDArray[np.bool_]:
    """Whether vertices (P,) may lie on the border of a part (P,). Trunk and legs have no border where they meet."""
    own = mesh.parts[vertex, part] > MIN_BORDER_PART_WEIGHT
    lower = mesh.parts[vertex][:, [TRUNK_LABEL, *LEG_LABELS]].sum(1) > MIN_BORDER_PART_WEIGHT
    other = np.zeros(len(vertex), np.bool_)
    for one, across in (LEG_LABELS, LEG_LABELS[::-1]):
        other |= (part == one) & (mesh.parts[vertex].argmax(1) == across)
    return np.asarray(own | (lower & ~np.isin(part, (*ARM_LABELS, HEAD_LABEL)) & ~other))
