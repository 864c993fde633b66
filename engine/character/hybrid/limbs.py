"""The shell's arms and legs, cut off within the trunk, and where they lie to it.

Beyond the paper. What of a limb is within the trunk is beneath its surface, before and behind: no border of a limb is ever seen, and
what comes out of the trunk where a joint bends has been in it.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import cv2
import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray
from scipy.sparse.csgraph import connected_components

from engine.body.parts import BODY_PARTS
from engine.character.fit.template_fit import FittedBody, load_human
from engine.character.hybrid.trunk import LIMB_LABELS, TRUNK_BEHIND_LIMBS_PIXELS
from engine.character.parts.label_map import Labels
from engine.character.parts.labels import ARM_LABELS, LEG_LABELS
from engine.character.shell.template_mesh import TemplateMesh
from engine.character.surface.depth_order import INSET_PIXELS, MAX_FORWARD_PIXELS, body_behind, limb_before
from engine.character.surface.front_and_back import Layer
from engine.character.surface.legs_beneath import LEG_UNDER_CLOTH_SHARE
from engine.character.surface.part_surface import Surface
from engine.geometry.mesh.adjacency import neighbours, open_edges
from engine.geometry.mesh.surface import area_vectors
from engine.imaging.filling.nearest import nearest_in
from engine.imaging.masks.mask_distance import dilate_mask, distance_inside, distance_to
from engine.imaging.masks.mask_pieces import rows_apart
from engine.render.rasterisation.attributes import interpolate
from engine.render.rasterisation.rasteriser import rasterise

SHELL_SHOULDER_OVERLAP_METRES, SHELL_HIP_OVERLAP_METRES = 0.15, 0.16
"""Metres at rest around the joint in which the shell of arm or leg goes on in the trunk."""
MIN_LIMB_DEPTH_SHARE = 0.2
"""Share of the trunk's depth that a limb within it keeps about its middle, at least."""
LIMB_EDGE_TOLERANCE_PIXELS = 3
"""Pixels from limbs that are seen within which nothing is taken to be hidden by the trunk: outlines do not lie on one another exactly."""
CUT_CURVATURE = 0.15
"""How fast the trunk rises from beneath the shell, away from where a limb is cut from it: pixels for each of the grid's, squared."""
MERGED_DEPTH_PIXELS = 8.0
"""Pixels by which the trunk may be before the shell where both are one surface; twice as many, and the limb hangs beside it."""
MOVED_ALIKE_PIXELS = 16.0
"""Pixels from where a limb is cut from the trunk within which the trunk is moved more and more as the shell is there."""
END_DRAWN_IN_SHARE = 0.6
"""How far the border at which a limb ends within the trunk is drawn in, as a share of the way to its middle."""
TEMPLATE_RIM_PIXELS = 8.0
"""Pixels within the template's own outline in which its depth, which falls there, says less and less of the trunk's."""
FULL_DEPTH_NEARNESS, DEPTH_SMOOTHING_PIXELS = 0.4, 4.0
"""How near to a joint, from 0 to 1 there, the trunk is as deep as the shell, and pixels over which that is smoothed."""
WEIGHT_SMOOTHING_ROUNDS = 4
"""Times that what moves a limb's vertices into the trunk is spread to their neighbours."""


LIMB_KINDS = (ARM_LABELS, LEG_LABELS)
"""Limbs that leave the trunk in one place: a hand that hangs before a hip cuts no leg from it."""


@dataclass(frozen=True)
class Limbs:
    """Which of the shell's vertices (V,) are shown.

    limb : an index of `BODY_PARTS`; -1 of none.
    overlap : bool, those of which the trunk has the most.
    near : how near each is to a shoulder or hip, from 0 to 1 at the joint.
    """

    limb: NDArray[np.intp]
    overlap: NDArray[np.bool_]
    near: NDArray[np.float32]


def limbs_of(
    mesh: TemplateMesh,
    pictured: NDArray[np.float64],
    labels: Labels,
    fitted: FittedBody,
    within: NDArray[np.bool_] | None = None,
) -> Limbs:
    """The limbs of a shell as `pictured` (V, 3): what of it is arms' and legs', and around shoulders and hips. Of legs that come out
    from under cloth that hangs, what is below, and a little more. `labels`: of `trunk_labels`; `within` (V,): what is in the picture, all
    unless it is given: beyond its edge nothing is made up."""
    space, coefficients = load_human().space, fitted.fit.coefficients
    at, heads = space.vertices(coefficients)[mesh.ids], space.joints(coefficients)
    hangs = labels.cloth is not None and labels.cloth.hangs
    most = mesh.parts.argmax(1)
    limb = np.where(np.isin(most, LIMB_LABELS), most, -1)
    overlap, near = np.zeros(len(most), np.bool_), np.zeros(len(most), np.float32)
    for part in LIMB_LABELS:
        side = "Left" if BODY_PARTS[part].startswith("left") else "Right"
        name, reach = (
            ("Arm", SHELL_SHOULDER_OVERLAP_METRES) if part in ARM_LABELS else ("UpLeg", SHELL_HIP_OVERLAP_METRES)
        )
        distance = np.linalg.norm(at - heads[mesh.names.index(f"{side}{name}")], axis=1)
        if part in LEG_LABELS and hangs:
            continue
        near = np.maximum(near, np.clip(1 - distance / reach, 0, 1))
        beyond = (most == BODY_PARTS.index("torso")) & (distance < reach) & (limb < 0)
        limb[beyond], overlap[beyond] = part, True
    if hangs:
        up = LEG_UNDER_CLOTH_SHARE * rows_apart(labels.labels >= 0)
        for leg in LEG_LABELS:
            own = labels.labels == leg
            hem = np.flatnonzero(own.any(1))[0] if own.any() else np.inf
            limb[(limb == leg) & (pictured[:, 1] < hem - up)] = -1
        overlap |= np.isin(limb, LEG_LABELS) & (pictured[:, 1] < first_rows(labels, limb))
    if within is not None:
        limb[~within] = -1
    return Limbs(limb, overlap & (limb >= 0), near.astype(np.float32))


def first_rows(labels: Labels, limb: NDArray[np.intp]) -> NDArray[np.float64]:
    """The first row (V,) of its leg that is seen, of vertices of a `limb` (V,)."""
    rows = np.full(len(BODY_PARTS) + 1, -np.inf)
    for leg in LEG_LABELS:
        own = (labels.labels == leg).any(1)
        rows[leg] = np.flatnonzero(own)[0] if own.any() else -np.inf
    return rows[limb]


def joined_in_depth(
    mesh: TemplateMesh, pictured: NDArray[np.float64], limbs: Limbs, trunk: Layer, labels: Labels
) -> tuple[NDArray[np.float64], Layer]:
    """The shell's vertices (V, 3) and the trunk in their order of depth. Limbs that are seen before the trunk are
    before it, and those that it hides are behind its front. What of them goes on in it is within: around joints the
    trunk is as deep as the shell."""
    moved = pictured.copy()
    trunk = _beneath_at_the_cut(mesh, moved, limbs, _as_deep(mesh, moved, limbs, trunk), labels)
    beside = dilate_mask(trunk.mask & ~np.isin(labels.labels, LIMB_LABELS), TRUNK_BEHIND_LIMBS_PIXELS + 1)
    for part in LIMB_LABELS:
        own, chosen = labels.labels == part, (limbs.limb == part) & ~limbs.overlap
        if not (own.any() and chosen.any()):
            continue
        layer = _limb_layer(mesh, moved, limbs, part, own.shape)
        trunk = body_behind(trunk, layer, own)
        nearer = limb_before(layer, trunk, own & ~beside).front.depth - layer.front.depth
        moved[chosen, 2] += _at(np.nan_to_num(nearer), moved[chosen])
    return _ends_drawn_in(mesh, _within(mesh, moved, limbs, trunk, labels), limbs), trunk


def _as_deep(mesh: TemplateMesh, vertices: NDArray[np.float64], limbs: Limbs, trunk: Layer) -> Layer:
    """The trunk with front and back going over, towards shoulders and hips, to a little before and behind the shell's."""
    body = (limbs.near > 0) | (mesh.parts.argmax(1) == BODY_PARTS.index("torso"))
    triangles = mesh.triangles[body[mesh.triangles].all(1)]
    sides = []
    for side, towards in ((trunk.front, 1.0), (trunk.back, -1.0)):
        shape = side.depth.shape
        raster = rasterise(vertices * [1, 1, -towards], triangles, (shape[0], shape[1]))
        there = (raster.triangle >= 0) & trunk.mask
        share = np.clip(interpolate(limbs.near[:, None], triangles, raster)[..., 0] / FULL_DEPTH_NEARNESS, 0, 1)
        share *= np.clip(distance_inside(there) / TEMPLATE_RIM_PIXELS, 0, 1)
        share = cv2.GaussianBlur(np.where(there, share, 0).astype(np.float32), (0, 0), DEPTH_SMOOTHING_PIXELS)
        goal = np.where(there, towards * (INSET_PIXELS - raster.depth), 0)
        depth = np.where(there, side.depth + share * (goal - side.depth), side.depth)
        sides.append(Surface(depth.astype(np.float32), side.weights))
    return replace(trunk, front=sides[0], back=sides[1])


def _beneath_at_the_cut(
    mesh: TemplateMesh, vertices: NDArray[np.float64], limbs: Limbs, trunk: Layer, labels: Labels
) -> Layer:
    """The trunk with front and back bent beneath the shell's where it is cut from a limb. Both show the same picture
    there, so where they cross nothing is to be seen; a border of the trunk that stood off would be a step."""
    seen = [
        (labels.labels == limb, _limb_layer(mesh, vertices, limbs, limb, labels.labels.shape)) for limb in LIMB_LABELS
    ]
    for kind in LIMB_KINDS:
        trunk = _beneath_one_kind(mesh, vertices, limbs, trunk, kind, seen, distance_to(np.isin(labels.labels, kind)))
    return trunk


def _beneath_one_kind(
    mesh: TemplateMesh,
    vertices: NDArray[np.float64],
    limbs: Limbs,
    trunk: Layer,
    kind: tuple[int, ...],
    seen: list[tuple[NDArray[np.bool_], Layer]],
    from_cut: NDArray[np.float32],
) -> Layer:
    """The trunk bent beneath the limbs of a `kind`, so many pixels `from_cut` (h, w) where it is cut from them; `seen`: of all limbs
    where each is (h, w), and its layer. It moves as the template's trunk does there, not as what lies beside it."""
    joint = mesh.triangles[((limbs.near > 0) & np.isin(limbs.limb, kind))[mesh.triangles].all(1)]
    facing = -area_vectors(vertices, joint)[:, 2]  # y is down, so that the triangles turn the other way
    over = CUT_CURVATURE * from_cut**2 - INSET_PIXELS
    alike = np.clip(1 - from_cut / MOVED_ALIKE_PIXELS, 0, 1)
    of_trunk = limbs.overlap[joint].any(1) if kind == ARM_LABELS else np.ones(len(joint), np.bool_)
    sides = []
    for side, towards in ((trunk.front, 1.0), (trunk.back, -1.0)):
        shape = (side.depth.shape[0], side.depth.shape[1])
        outer = towards * facing > 0
        raster = rasterise(vertices * [1, 1, -towards], joint[outer], shape)
        there = (raster.triangle >= 0) & trunk.mask
        near = np.where(there, -raster.depth, 0)
        apart = towards * side.depth - near - MERGED_DEPTH_PIXELS
        limit = np.where(there, near + over + 2 * np.maximum(apart, 0), np.inf)
        if towards > 0:  # whatever it is before, what is seen is nearer than the trunk
            for own, limb in seen:
                limit = np.where(own & limb.mask & trunk.mask, np.fmin(limit, limb.front.depth - INSET_PIXELS), limit)
        depth = towards * np.minimum(towards * side.depth, limit)
        carried = joint[outer & of_trunk]
        raster = rasterise(vertices * [1, 1, -towards], carried, shape)
        there = (raster.triangle >= 0) & trunk.mask
        share = cv2.GaussianBlur(np.where(there, alike, 0).astype(np.float32), (0, 0), DEPTH_SMOOTHING_PIXELS) * there
        moves = interpolate(dense_weights(mesh, side.weights.shape[-1]), carried, raster)
        weights = side.weights + share[..., None] * (moves - side.weights)
        sides.append(Surface(depth.astype(np.float32), np.where(there[..., None], weights, side.weights)))
    return replace(trunk, front=sides[0], back=sides[1])


def dense_weights(mesh: TemplateMesh, joints: int) -> NDArray[np.float32]:
    """What moves each vertex, (V, J)."""
    weights = np.zeros((len(mesh.bones), joints), np.float32)
    np.add.at(weights, (np.arange(len(weights))[:, None], mesh.bones), mesh.weights)
    return weights


def _limb_layer(
    mesh: TemplateMesh, vertices: NDArray[np.float64], limbs: Limbs, part: int, shape: tuple[int, ...]
) -> Layer:
    """What of the grid a limb covers, without its overlap, and how near and far it reaches there."""
    own = (limbs.limb == part) & ~limbs.overlap
    triangles = mesh.triangles[own[mesh.triangles].all(1)]
    depths = []
    for towards in (1.0, -1.0):
        raster = rasterise(vertices * [1, 1, -towards], triangles, (shape[0], shape[1]))
        depths.append(np.where(raster.triangle >= 0, -towards * raster.depth, np.nan).astype(np.float32))
    unused = np.zeros((shape[0], shape[1], 0), np.float32)
    return Layer(np.isfinite(depths[0]), Surface(depths[0], unused), Surface(depths[1], unused), limb=part)


def _within(
    mesh: TemplateMesh, vertices: NDArray[np.float64], limbs: Limbs, trunk: Layer, labels: Labels
) -> NDArray[np.float64]:
    """Vertices (V, 3) moved beneath the trunk's surface: from before where it is what is seen, and what overlaps from behind, and from
    beside its outline, too; it bends, and is not torn."""
    shape = trunk.mask.shape
    half = np.where(trunk.mask, (trunk.front.depth - trunk.back.depth) / 2, 0)
    middle = np.where(trunk.mask, (trunk.front.depth + trunk.back.depth) / 2, 0)
    beneath = np.minimum(INSET_PIXELS, half * (1 - MIN_LIMB_DEPTH_SHARE))
    inner = cv2.erode(trunk.mask.astype(np.uint8), np.ones((3, 3), np.uint8), borderValue=0) > 0
    limb, moved = limbs.limb >= 0, vertices.copy()
    x, y = _pixels(vertices, shape)
    near, cut = np.zeros_like(limb), np.zeros_like(limb)
    for kind in LIMB_KINDS:
        own, seen = np.isin(limbs.limb, kind), np.isin(labels.labels, kind)
        near |= own & dilate_mask(seen, LIMB_EDGE_TOLERANCE_PIXELS)[y, x]
        cut |= own & (distance_to(seen) < np.sqrt(INSET_PIXELS / CUT_CURVATURE))[y, x]
    if inner.any():
        out = limbs.overlap & ~inner[y, x] & ~cut
        rows, columns = nearest_in(inner)
        moved[out, :2] = np.stack([columns[y, x], rows[y, x]], 1)[out]
        x, y = _pixels(moved, shape)
    covered = inner[y, x] & limb
    hidden = covered & ~limbs.overlap & ~near
    front = (middle + half - beneath)[y, x]
    back = (middle - half + beneath)[y, x]
    z = vertices[:, 2]
    wanted = z.copy()
    over = np.maximum(z - front, 0)[hidden]
    wanted[hidden] -= over * np.clip(2 - over / MAX_FORWARD_PIXELS, 0, 1)
    covered &= ~(cut & (limbs.near > 0))
    down = covered & limbs.overlap
    wanted[down] = np.minimum(z, front)[down]
    up = covered & limbs.overlap
    wanted[up] = np.maximum(wanted, back)[up]
    change = wanted - z
    beside = neighbours(mesh.triangles, len(vertices))
    degree = np.maximum(np.asarray(beside.sum(1)).ravel(), 1)
    spread = change.copy()
    for _ in range(WEIGHT_SMOOTHING_ROUNDS):
        spread = (beside @ spread) / degree
        spread = np.where(np.abs(change) > np.abs(spread), change, spread)
    moved[limb, 2] += spread[limb]
    return moved


def _pixels(vertices: NDArray[np.float64], shape: tuple[int, ...]) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    """The columns and rows (V,) each of the pixels of a grid in which vertices (V, 3) are, or are nearest to."""
    x, y = np.clip(np.rint(vertices[:, :2]), 0, [shape[1] - 1, shape[0] - 1]).astype(np.intp).T
    return x, y


def _ends_drawn_in(mesh: TemplateMesh, vertices: NDArray[np.float64], limbs: Limbs) -> NDArray[np.float64]:
    """Vertices (V, 3) with the borders at which limbs end in the trunk drawn in towards their middle: what closes them is inside, whatever
    way the surface bends."""
    shown = (limbs.limb >= 0)[mesh.triangles].all(1)
    edges = open_edges(mesh.triangles[shown])
    edges = edges[limbs.overlap[edges].all(1)]
    graph = sp.coo_array((np.ones(len(edges)), edges.T), (len(vertices), len(vertices)))
    loop = connected_components(graph, directed=False)[1]
    end = np.unique(edges)
    count = np.bincount(loop[end], minlength=loop.max() + 1)
    drawn = vertices.copy()
    for axis in range(3):
        total = np.bincount(loop[end], vertices[end, axis], minlength=len(count))
        middle = (total / np.maximum(count, 1))[loop[end]]
        drawn[end, axis] += END_DRAWN_IN_SHARE * (middle - vertices[end, axis])
    return drawn


def _at(values: NDArray[np.floating], places: NDArray[np.float64]) -> NDArray[np.float64]:
    """Values (h, w) at places (N, 3) of the grid, 0 beside it."""
    x, y = (np.ascontiguousarray(places[:, k], np.float32)[:, None] for k in (0, 1))
    return np.asarray(cv2.remap(values.astype(np.float32), x, y, cv2.INTER_LINEAR)[:, 0], np.float64)
