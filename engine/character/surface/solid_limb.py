"""Arms that no sheet can make: the template's own surface, warped to where the picture shows the arm.

A sheet has one depth for each pixel. Of a forearm that points at the viewer the picture shows a few pixels: a sheet made of
them hangs as a wide rag. Beyond the paper, such an arm is the fitted template's, whole, its
outline in the picture that of the arm. What the picture shows of it has its pixels; what it does not show has those of the
nearest place of the arm that is seen, and a hand of which nothing is seen those of the other hand.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import cv2
import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import distance_transform_edt
from scipy.spatial import cKDTree

from engine.body.rig import Rig
from engine.character.fit.posed_template import PosedTemplate
from engine.character.fit.template_maps import side_maps
from engine.character.parts.labels import ARM_LABELS
from engine.character.surface.part_surface import warp_part
from engine.imaging.masks.mask_pieces import largest_piece

FORESHORTENED_LENGTH_SHARE = 0.5
"""Share of its length that a bone has in the picture, below which the limb is more deep than long."""
UNCOLOURED_BAND_PIXELS = 2
"""Pixels of a limb at its outline from which no colours are taken."""
LIMB_VISIBILITY_TOLERANCE_METRES = 0.02
"""Metres behind what is nearest at a pixel, within which a vertex is taken to be seen there."""


@dataclass(frozen=True)
class SolidLimb:
    """A limb that is more deep than long in the picture, as a closed mesh.

    vertices : (V, 3) in picture space.
    rest : (V, 3) the same at rest, metres.
    triangles : (T, 3) closed.
    weights : (V, J) skinning weights.
    front, back : (h, w) its depths, NaN beside it.
    seen : (V,) whether the picture shows a vertex.
    sure : (V,) whether it does so away from the limb's outline.
    upper : (V,) whether a vertex is above the elbow.
    hand : (V,) whether it is of the hand.
    like : the limb of the other side, whose colours it has if it is not seen.
    """

    vertices: NDArray[np.float64]
    rest: NDArray[np.float64]
    triangles: NDArray[np.int32]
    weights: NDArray[np.float32]
    front: NDArray[np.float32]
    back: NDArray[np.float32]
    seen: NDArray[np.bool_]
    sure: NDArray[np.bool_]
    upper: NDArray[np.bool_]
    hand: NDArray[np.bool_]
    like: SolidLimb | None = None

    def moved(self, front: NDArray[np.float32], back: NDArray[np.float32], which: NDArray[np.bool_]) -> SolidLimb:
        """The limb when its depths have become others, and `which` of its vertices (V,) go with them."""
        covered = np.isfinite(self.front)
        _, (rows, columns) = distance_transform_edt(~covered, return_indices=True)
        x, y = _pixels(self.vertices, covered.shape)
        at = rows[y, x], columns[y, x]
        share = (self.vertices[:, 2] - self.back[at]) / np.maximum((self.front - self.back)[at], 1e-6)
        share = np.clip(share, 0, 1)
        further = share * (front - self.front)[at] + (1 - share) * (back - self.back)[at]
        vertices = self.vertices + np.outer(np.where(which, further, 0), [0, 0, 1])
        return replace(self, vertices=vertices, front=front, back=back)


def solid_arms(template: PosedTemplate, rig: Rig) -> set[int]:
    """The arms (indices of `BODY_PARTS`) that no sheet can make."""
    sides = zip(ARM_LABELS, ("Left", "Right"), strict=True)
    return {arm for arm, side in sides if _shortest(template, rig, side) < FORESHORTENED_LENGTH_SHARE}


def _shortest(template: PosedTemplate, rig: Rig, side: str) -> float:
    """The share of its length that the arm's or the forearm's bone has in the picture, whichever has less."""
    at = [rig.index(f"{side}{name}") for name in ("Arm", "ForeArm", "Hand")]
    seen = np.linalg.norm(np.diff(template.joints[at, :2], axis=0), axis=1)
    whole = np.linalg.norm(np.diff(template.rest_joints[at], axis=0), axis=1) * template.pixels_per_metre
    return float((seen / whole).min())


def solid_limb(
    chosen: NDArray[np.bool_], mask: NDArray[np.bool_], template: PosedTemplate, rig: Rig, own: NDArray[np.bool_]
) -> SolidLimb:
    """The `chosen` triangles (T,) of the template where the limb's `mask` (h, w) is, of which the picture shows its `own`."""
    used, triangles = np.unique(template.triangles[chosen], return_inverse=True)
    triangles = triangles.reshape(-1, 3)
    vertices = template.vertices[used].copy()
    vertices[:, :2] = _warped(vertices, triangles, mask)
    count = len(vertices)
    dense = np.zeros((count, len(rig.names)), np.float32)
    for k in range(rig.bones.shape[1]):
        dense[np.arange(count), rig.bones[used, k]] += rig.weights[used, k]
    rest = template.rest[used].astype(np.float64)
    vertices, triangles, dense, rest = _capped(vertices, triangles, dense, rest)
    sides = [side_maps(vertices, triangles, (own.shape[0], own.shape[1]), side) for side in ("front", "back")]
    front, back = (side.depth for side in sides)
    x, y = _pixels(vertices, own.shape)
    with np.errstate(invalid="ignore"):
        near = vertices[:, 2] > front[y, x] - LIMB_VISIBILITY_TOLERANCE_METRES * template.pixels_per_metre
    forearm, hand = (dense[:, [part in name for name in rig.names]].sum(1) for part in ("ForeArm", "Hand"))
    seen = near & own[y, x]
    sure = seen & _inner(own)[y, x]
    sure = sure if sure.any() else seen
    return SolidLimb(
        vertices, rest, triangles.astype(np.int32), dense, front, back, seen, sure, forearm + hand < 0.5, hand > 0.5
    )


def _inner(own: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """The pixels (h, w) surely of a limb: at its outline colours are mixed with what is behind. Of one too thin, all."""
    inner = (
        cv2.erode(own.astype(np.uint8), np.ones((3, 3), np.uint8), iterations=UNCOLOURED_BAND_PIXELS, borderValue=0) > 0
    )
    return np.asarray(inner) if inner.any() else own


def places_on_the_picture(limbs: Sequence[SolidLimb]) -> list[NDArray[np.float64]]:
    """For each of some limbs the pixels (V, 2), x and y, whose colours its vertices take. Where they are seen these are
    their own. Else they are those of the nearest at rest that is, of a hand for a hand and of an arm for an arm. A limb
    that is not seen takes those of the one that it is like. NaN where nothing is seen."""
    found = []
    for limb in limbs:
        places = np.full((len(limb.vertices), 2), np.nan)
        other = limb.like or next((one for one in limbs if one is not limb), None)
        for group in (limb.hand, ~limb.hand):
            wanted, source, flip = group & ~limb.seen, limb, 1.0
            shown = group & (limb.sure if (group & limb.sure).any() else limb.seen)
            if not shown.any() and other is not None and (limb.like or group is limb.hand):
                source, flip, shown = other, -1.0, (other.hand if group is limb.hand else ~other.hand) & other.sure
            if not shown.any():
                source, flip, shown = limb, 1.0, limb.sure
            if not shown.any() and limb.like is not None:
                source, flip, shown = limb.like, -1.0, limb.like.sure
            if shown.any() and wanted.any():
                _, nearest = cKDTree(source.rest[shown] * [flip, 1, 1]).query(limb.rest[wanted])
                places[wanted] = source.vertices[shown][nearest, :2]
        places[limb.seen] = limb.vertices[limb.seen, :2]
        found.append(places)
    return found


def _warped(
    vertices: NDArray[np.float64], triangles: NDArray[np.integer], mask: NDArray[np.bool_]
) -> NDArray[np.float64]:
    """Where vertices (V, 3) of a part of the template lie in the picture (V, 2), when its outline is that of the part's `mask`
    (h, w): the paper's warp, the other way round."""
    covered = largest_piece(side_maps(vertices, triangles, (mask.shape[0], mask.shape[1]), "front").mask)
    warp = warp_part(covered, mask)
    _, (rows, columns) = distance_transform_edt(~covered, return_indices=True)
    offsets = warp.places - np.stack(np.meshgrid(*(np.arange(n) for n in mask.shape[::-1])), -1)
    offsets = offsets[rows, columns].astype(np.float32)
    x, y = (np.ascontiguousarray(vertices[None, :, axis], np.float32) for axis in (0, 1))
    return vertices[:, :2] + cv2.remap(offsets, x, y, cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE)[0]


def _capped(
    vertices: NDArray[np.float64], triangles: NDArray[np.intp], weights: NDArray[np.float32], rest: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.intp], NDArray[np.float32], NDArray[np.float64]]:
    """A part of the template closed where it was cut off: each loop of open border joined to its middle."""
    edges = np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]])
    count = len(vertices)
    there, back = edges[:, 0] * count + edges[:, 1], edges[:, 1] * count + edges[:, 0]
    open_edges = edges[~np.isin(there, back)]
    following = dict(map(tuple, open_edges.tolist()))
    caps: list[tuple[int, int, int]] = []
    middles: list[list[int]] = []
    while following:
        loop = [next(iter(following))]
        while (after := following.pop(loop[-1], None)) is not None and after != loop[0]:
            loop.append(after)
        here = count + len(middles)
        middles.append(loop)
        caps += [(b, a, here) for a, b in zip(loop, [*loop[1:], loop[0]], strict=True)]
    if not caps:
        return vertices, triangles, weights, rest
    mean = [np.stack([one[loop].mean(0) for loop in middles]) for one in (vertices, weights, rest)]
    joined = [np.concatenate([one, more]) for one, more in zip((vertices, weights, rest), mean, strict=True)]
    return joined[0], np.concatenate([triangles, np.array(caps)]), joined[1].astype(np.float32), joined[2]


def _pixels(vertices: NDArray[np.floating], shape: Sequence[int]) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    """The pixels, x (V,) and y (V,), in which vertices (V, 3) lie."""
    at = np.clip(np.rint(vertices[:, :2]), 0, [shape[1] - 1, shape[0] - 1]).astype(int)
    return at[:, 0], at[:, 1]
