"""The shell's head in place of the relief's: a profile, ears and a nape, none of which a picture from before shows.

Beyond the paper, whose head is a relief like the rest: from its side it is a hood with a face before it. Where hair, hat or hood keep
to the skull, the template's head displaced to the outline is the head; where they do not, as long hair, it is no shape of theirs, and
the relief remains. The head reaches into the trunk, as limbs do (`engine.character.hybrid.limbs`).
"""

from __future__ import annotations

from dataclasses import replace

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.character.figure.face_region import face_ellipse, in_profile
from engine.character.figure.figure import Figure
from engine.character.figure.silhouette import Silhouette
from engine.character.fit.template_fit import FittedBody, load_human
from engine.character.hair.mask import hair_mask
from engine.character.hair.regions import TemplateHead
from engine.character.hybrid.limbs import WEIGHT_SMOOTHING_ROUNDS, Limbs
from engine.character.parts.label_map import Labels
from engine.character.parts.labels import ARM_LABELS, HEAD_LABEL, TRUNK_LABEL
from engine.character.shell.template_mesh import TemplateMesh
from engine.character.surface.depth_order import INSET_PIXELS
from engine.character.surface.front_and_back import ClosedMesh
from engine.geometry.mesh.adjacency import neighbours
from engine.geometry.mesh.welding import same_rows
from engine.imaging.masks.mask_distance import dilate_mask
from engine.imaging.masks.mask_pieces import largest_piece
from engine.render.rasterisation.rasteriser import rasterise

MIN_SHOWN_HEAD_WEIGHT = 0.3
"""Share of the head in what moves a vertex that may show in its outline."""
HAIR_DEPTH_SHARE = 0.09
"""How far hair that keeps to the skull stands off it, as a share of the head's height."""
MAX_LOOSE_HAIR_SHARE, MAX_UNCOVERED_SHARE = 0.02, 0.13
"""Share of what the picture shows of the head that may be further off, and share of the template's head that may lie
beside the person, for it to be a head of that shape. Beyond, hair is loose, or the head is not where it is taken to
be."""
MAX_UNKNOWN_SHARE = 0.22
"""Share of the template's head that may lie beside the person where it is displaced to the outline, hair apart, or beyond the picture."""
NECK_SURROUND_SHARE, COLLAR_DEPTH_SHARE, MAX_FALLEN_HAIR_SHARE = 0.25, 0.03, 0.22
"""How far about jaw and neck falling hair is looked for, and how far off them it is at least, both in heights of the
head. And how much of it there may be, as a share of what jaw and neck cover."""
MOUTH_LANDMARK = 62
"""Of the 68 points of a face, the middle of the upper lip's lower edge."""
NECK_OVERLAP_METRES = 0.1
"""Metres at rest around the neck's joint in which the shell of the head goes on in the trunk."""
TRUNK_BEHIND_HEAD_PIXELS = 5
"""Pixels by which the trunk goes on behind the head: what lies between two borders of pixels would gape."""
COLLAR_SMOOTHING_PIXELS = 3.0
"""Pixels over which the line is smoothed along which a trunk's back goes into the neck."""
SHEET_GAP_PIXELS = 0.5
"""Pixels of depth by which the trunk's front and back stay apart within the neck."""
NECK_EDGE_PIXELS = 4
"""Pixels within the outline of the neck in which the trunk does not go on: it would stand beside it."""
HEAD_LABEL_TOLERANCE_PIXELS = 2
"""Pixels around the head's label in which a head may be what is seen: the border is not exact."""


def hair_keeps_to_the_head(
    figure: Figure, silhouette: Silhouette, labels: Labels, mesh: TemplateMesh, template: NDArray[np.float64]
) -> bool:
    """Whether the head, hair and all, has the shape of the `template`'s (V, 3), picture space. No where that is not
    known: no face is seen, or one in profile, whose turn is not found, or the picture cuts the head off."""
    own = labels.labels == HEAD_LABEL
    if not own.any() or not _turned_to_the_viewer(figure, silhouette, mesh, template):
        return False
    of_head, size = mesh.parts[:, HEAD_LABEL] > MIN_SHOWN_HEAD_WEIGHT, np.ptp(template[mesh.head > 0.5, 1])
    covered, neck = (_covered(mesh, template, each, own.shape) for each in (of_head, of_head & _below_the_mouth(mesh)))
    loose = (own & ~dilate_mask(covered, round(HAIR_DEPTH_SHARE * size))).sum() / own.sum()
    at_neck = dilate_mask(neck, round(NECK_SURROUND_SHARE * size)) & ~dilate_mask(
        covered & ~neck, HEAD_LABEL_TOLERANCE_PIXELS
    )
    beyond = own & ~dilate_mask(covered, max(HEAD_LABEL_TOLERANCE_PIXELS, round(COLLAR_DEPTH_SHARE * size)))
    fallen = (beyond & at_neck).sum() / max(neck.sum(), 1)
    beside = (covered & (labels.labels < 0)).sum() / max(covered.sum(), 1)
    return bool(loose < MAX_LOOSE_HAIR_SHARE and fallen < MAX_FALLEN_HAIR_SHARE and beside < MAX_UNCOVERED_SHARE)


def head_is_known(
    figure: Figure, silhouette: Silhouette, labels: Labels, mesh: TemplateMesh, template: NDArray[np.float64]
) -> bool:
    """Whether the `template`'s head (V, 3), picture space, is where the person's is. No where that is not known: no face is seen, or one in
    profile, whose turn is not found, or the picture cuts the head off."""
    if not _turned_to_the_viewer(figure, silhouette, mesh, template):
        return False
    covered = _covered(mesh, template, mesh.parts[:, HEAD_LABEL] > MIN_SHOWN_HEAD_WEIGHT, labels.labels.shape)
    return bool((covered & (labels.labels < 0)).sum() < MAX_UNKNOWN_SHARE * covered.sum())


def with_hair_apart(
    figure: Figure, silhouette: Silhouette, labels: Labels, mesh: TemplateMesh, template: NDArray[np.float64]
) -> Labels:
    """Labels in which hair that does not keep to the `template`'s head (V, 3) is what the head holds before all else."""
    if hair_keeps_to_the_head(figure, silhouette, labels, mesh, template):
        return labels
    hair = hair_beside_the_head(figure, silhouette, labels, mesh, template)
    if not hair.any():
        return labels
    held = np.full(labels.labels.shape, -1, np.int8) if labels.held is None else labels.held.copy()
    held[hair] = HEAD_LABEL
    return replace(labels, labels=np.where(hair, -1, labels.labels).astype(np.int8), held=held)


def hair_beside_the_head(
    figure: Figure, silhouette: Silhouette, labels: Labels, mesh: TemplateMesh, template: NDArray[np.float64]
) -> NDArray[np.bool_]:
    """The pixels (h, w) of the grid that show hair beside the face and where it falls over the body; none where no face is found.
    `template` (V, 3): where the body's vertices are, picture space."""
    head = labels.labels == HEAD_LABEL
    face = face_ellipse(figure, silhouette.to_grid, head)
    if face is None:
        return np.zeros_like(head)
    shown = (mesh.parts[:, HEAD_LABEL] > MIN_SHOWN_HEAD_WEIGHT, mesh.ear)
    covered, ears = (_covered(mesh, template, own, head.shape) for own in shown)
    body = np.isin(labels.labels, (TRUNK_LABEL, *ARM_LABELS))
    return hair_mask(silhouette.rgb, head, body, TemplateHead(covered, ears, face))


def _turned_to_the_viewer(
    figure: Figure, silhouette: Silhouette, mesh: TemplateMesh, template: NDArray[np.float64]
) -> bool:
    """Whether a face is seen, not in profile, and the picture cuts off no more of the `template`'s head (V, 3) than a crown."""
    if figure.face is None or in_profile(figure):
        return False
    places = (template[mesh.head > 0.5, :2] - silhouette.to_grid[:, 2]) / np.diag(silhouette.to_grid)
    height, width = silhouette.alpha.shape
    within = ((places >= 0) & (places <= [width - 1, height - 1])).all(1)
    return bool(within.mean() > 1 - MAX_UNKNOWN_SHARE)


def _covered(
    mesh: TemplateMesh, places: NDArray[np.float64], vertices: NDArray[np.bool_], shape: tuple[int, ...]
) -> NDArray[np.bool_]:
    """The pixels (h, w) of the grid that are covered by what lies between some of the vertices (V,)."""
    triangles = mesh.triangles[vertices[mesh.triangles].all(1)]
    return np.asarray(rasterise(places * [1, 1, -1], triangles, (shape[0], shape[1])).triangle >= 0)


def _below_the_mouth(mesh: TemplateMesh) -> NDArray[np.bool_]:
    """Which vertices (V,) are, on the mean body."""
    human = load_human()
    height = human.space.mean[mesh.ids, 1]
    return np.asarray(height < height[mesh.renamed(human.face)[MOUTH_LANDMARK]])


def with_head(limbs: Limbs, mesh: TemplateMesh, fitted: FittedBody) -> Limbs:
    """The shell's vertices that are shown, with those of head and neck, and around the neck's joint."""
    space, coefficients = load_human().space, fitted.fit.coefficients
    at, heads = space.vertices(coefficients)[mesh.ids], space.joints(coefficients)
    most, limb = mesh.parts.argmax(1), limbs.limb.copy()
    limb[(most == HEAD_LABEL) | mesh.eye] = HEAD_LABEL
    distance = np.linalg.norm(at - heads[mesh.names.index("Neck")], axis=1)
    beyond = (most == TRUNK_LABEL) & (distance < NECK_OVERLAP_METRES) & (limb < 0)
    limb[beyond] = HEAD_LABEL
    return replace(limbs, limb=limb, overlap=limbs.overlap | beyond)


def no_limbs(mesh: TemplateMesh) -> Limbs:
    """None of the shell's vertices."""
    count = len(mesh.ids)
    return Limbs(np.full(count, -1), np.zeros(count, np.bool_), np.zeros(count, np.float32))


def without_head(labels: Labels) -> Labels:
    """Labels of who has no head: what is nearest to the trunk of it is the trunk's."""
    found = labels.labels.copy()
    head = found == HEAD_LABEL
    under = head & dilate_mask(found == TRUNK_LABEL, TRUNK_BEHIND_HEAD_PIXELS)
    under &= ~dilate_mask(found < 0, NECK_EDGE_PIXELS)
    whole = (under | (found == TRUNK_LABEL)).astype(np.uint8)
    under &= cv2.morphologyEx(whole, cv2.MORPH_OPEN, np.ones((3, 3), np.uint8)) > 0  # no threads
    found[head] = -1
    found[under] = TRUNK_LABEL
    loose = (found == TRUNK_LABEL) & ~largest_piece(found == TRUNK_LABEL) & dilate_mask(head, TRUNK_BEHIND_HEAD_PIXELS)
    found[loose] = -1
    return replace(labels, labels=found)


def joined_at_the_neck(
    mesh: TemplateMesh, pictured: NDArray[np.float64], shown: Limbs, trunk: ClosedMesh, labels: Labels
) -> tuple[NDArray[np.float64], ClosedMesh]:
    """The shell's vertices (V, 3) and the trunk with the head in its place. It is before the trunk where the picture
    shows it (`labels`), and behind the trunk's front where that is seen. What of it goes on in the trunk is within."""
    shape = (labels.labels.shape[0], labels.labels.shape[1])
    body = trunk.triangles[(trunk.layer == 0)[trunk.triangles].all(1)]
    front = -rasterise(trunk.vertices * [1, 1, -1], body, shape).depth
    back = rasterise(trunk.vertices, body, shape).depth
    own = shown.limb == HEAD_LABEL
    row, column = _pixels(pictured, shape)
    covered = own & np.isfinite(front[row, column]) & np.isfinite(back[row, column])
    head = labels.labels == HEAD_LABEL
    cloth = (labels.labels == TRUNK_LABEL) & ~dilate_mask(head, HEAD_LABEL_TOLERANCE_PIXELS)
    z = pictured[:, 2].copy()
    least, most = back[row, column] + INSET_PIXELS, front[row, column] - INSET_PIXELS
    down = covered & (shown.overlap | cloth[row, column])
    z[down] = np.minimum(z, most)[down]
    up = covered & shown.overlap
    z[up] = np.maximum(z, np.minimum(least, most))[up]
    moved = pictured.copy()
    moved[own, 2] += _spread(mesh, z - pictured[:, 2])[own]
    neck = mesh.triangles[(own | shown.overlap)[mesh.triangles].all(1)]  # shoulders go on up to it
    return moved, _beneath(neck, moved, trunk, head)


def _beneath(
    triangles: NDArray[np.int32], places: NDArray[np.float64], trunk: ClosedMesh, head: NDArray[np.bool_]
) -> ClosedMesh:
    """The trunk with what of it the picture shows as `head` (h, w) within the head's `triangles`, before and behind.

    Behind, where no picture says where cloth ends, it goes into the neck along a smooth line.
    """
    shape = (head.shape[0], head.shape[1])
    front = -rasterise(places * [1, 1, -1], triangles, shape).depth - INSET_PIXELS
    back = rasterise(places, triangles, shape).depth + INSET_PIXELS
    row, column = _pixels(trunk.vertices, shape)
    front, back = front[row, column], back[row, column]
    smooth = cv2.GaussianBlur(head.astype(np.float32), (0, 0), COLLAR_SMOOTHING_PIXELS)
    point = same_rows(trunk.vertices)
    behind = np.isin(point, point[~trunk.front])  # at the rim there are vertices of both sheets in one place
    share = np.where(behind, np.clip(2 * smooth[row, column], 0, 1), head[row, column])
    low, high = back + ~behind * SHEET_GAP_PIXELS, front - behind * SHEET_GAP_PIXELS
    under = (trunk.layer == 0) & (share > 0) & np.isfinite(front) & np.isfinite(back) & (low < high)
    vertices = trunk.vertices.copy()
    within = np.clip(vertices[under, 2], low[under], high[under])
    vertices[under, 2] += share[under] * (within - vertices[under, 2])
    return replace(trunk, vertices=vertices)


def _pixels(places: NDArray[np.floating], shape: tuple[int, int]) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    """Rows and columns (N,) of the pixels of the grid that places (N, 3) are in."""
    column, row = np.clip(np.rint(places[:, :2]), 0, [shape[1] - 1, shape[0] - 1]).astype(np.intp).T
    return row, column


def _spread(mesh: TemplateMesh, change: NDArray[np.float64]) -> NDArray[np.float64]:
    """A change (V,) of vertices carried on to those around, less and less."""
    beside = neighbours(mesh.triangles, len(change))
    count = np.maximum(np.asarray(beside.sum(1)).ravel(), 1)
    spread = change
    for _ in range(WEIGHT_SMOOTHING_ROUNDS):
        spread = (beside @ spread) / count
        spread = np.where(np.abs(change) > np.abs(spread), change, spread)
    return spread
