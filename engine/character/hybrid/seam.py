"""The colours of a shell where it goes over into the trunk: the trunk's, so that neither sides nor backs show a border.

What a shell's own trunk would be coloured like is filled from its rows; here a relief is in its place, whose tiles say what is there.
"""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.character.figure.figure import Figure
from engine.character.figure.silhouette import Silhouette
from engine.character.hybrid.hips import at_hips, hips_behind, within_the_outline
from engine.character.hybrid.hybrid import SHOULDER_NEARNESS, Hybrid
from engine.character.hybrid.trunk import LIMB_LABELS
from engine.character.parts.labels import ARM_LABELS, HEAD_LABEL, LEG_LABELS, TRUNK_LABEL
from engine.character.shell.colours.light_of_the_picture import light_of_the_picture
from engine.character.shell.colours.texels import texels
from engine.character.texture.texture import Tiles
from engine.geometry.mesh.surface import vertex_normals
from engine.imaging.filling.nearest import nearest_colours
from engine.imaging.masks.mask_distance import dilate_mask, distance_to
from engine.render.rasterisation.rasteriser import rasterise

TRUNK_WEIGHT_THRESHOLD = 0.5
"""Share of the trunk in what moves a vertex from which on its colours go over to the trunk's."""
MIN_PICTURED_COSINE, FULLY_PICTURED_COSINE = 0.12, 0.3
"""Cosine to the viewer from which on what is seen of a limb is more and more, and all, the picture's."""
FULLY_CONTINUED_PIXELS, CONTINUED_PIXELS = 2.0, 6.0
"""Pixels of the grid around what is surely a limb's up to which its surface has the colours of that, and from which on it has them no more:
neither's border is exact."""
LIMB_MARGIN_PIXELS, SURE_ARM_OVER_LEG_MARGIN_PIXELS = 2, 4
"""Pixels of the grid from another limb, and of a leg from an arm, whose shadow lies on it, within which nothing is surely a limb's."""
VISIBILITY_TOLERANCE_PIXELS = 3.0
"""Pixels of the grid by which a point may be behind what is nearest at its place and yet be seen."""
MAX_SIDE_COSINE = 0.3
"""Cosine to the viewer up to which, on both sides, front and back go over into one another."""


@dataclass(frozen=True)
class _Shown:
    """What a picture shows of one part: its colours (H, W, 3), continued beyond it, and on the grid how far (h, w) they are of use, from 0 to 1."""

    colours: NDArray[np.uint8]
    certain: NDArray[np.float32]


def with_the_trunks_colours(
    texture: NDArray[np.uint8], hybrid: Hybrid, tiles: Tiles, figure: Figure, silhouette: Silhouette
) -> NDArray[np.uint8]:
    """A shell's texture (S, S, 3) which goes over to the colours that a trunk's `tiles` have in front and behind.

    Where a limb is what is seen, it goes over to those that the picture has of it: a trunk does not end, and an arm does not begin, in
    the same place on the template and on a sleeve.
    """
    shell, labels, raster = hybrid.shell, hybrid.labels.labels, texels()
    mesh, to_grid = shell.mesh, silhouette.to_grid
    share = np.clip((mesh.parts[:, TRUNK_LABEL] - TRUNK_WEIGHT_THRESHOLD) / (1 - TRUNK_WEIGHT_THRESHOLD), 0, 1)
    facing = -vertex_normals(shell.pictured, mesh.triangles)[:, 2]
    joint = np.where(
        np.isin(hybrid.limbs.limb, ARM_LABELS),
        np.clip(hybrid.limbs.near / SHOULDER_NEARNESS, 0, 1),
        hybrid.limbs.near > 0,
    )
    values = np.column_stack([shell.pictured, facing, share, joint, at_hips(hybrid)]).astype(np.float32)
    shown = np.asarray((hybrid.limbs.limb >= 0)[mesh.triangles].all(1), np.bool_)
    y, x = np.nonzero((raster.triangle >= 0) & shown[raster.triangle])
    corners = mesh.triangles[raster.triangle[y, x]]
    at = np.einsum("nk,nkc->nc", raster.barycentrics[y, x], values[corners])
    tile = (at[:, :2] + 0.5) * tiles.scale + tiles.shift - 0.5
    front, back = _sampled(tiles.body, tile), _sampled(tiles.back, tile)
    pixel = (at[:, :2] - to_grid[:, 2]) / np.diag(to_grid)
    depth = -rasterise(shell.pictured * [1, 1, -1], mesh.triangles[shown], labels.shape).depth
    column, row = np.clip(np.rint(at[:, :2]).astype(int), 0, [labels.shape[1] - 1, labels.shape[0] - 1]).T
    nearest = ~(depth[row, column] - at[:, 2] > VISIBILITY_TOLERANCE_PIXELS)
    certain, picture = np.zeros(len(at), np.float32), np.zeros((len(at), 3), np.float32)
    at_joint = np.zeros(len(at), np.float32)
    for limb in LIMB_LABELS:
        own = np.flatnonzero(hybrid.limbs.limb[corners[:, 0]] == limb)
        if (seen := _shown(limb, hybrid, figure.rgb, silhouette)) is not None and len(own):
            certain[own] = _sampled(seen.certain, at[own, :2])
            picture[own] = _sampled(seen.colours, pixel[own])
        shared = np.isin(labels, (TRUNK_LABEL, limb)) & ~(hybrid.strange & (limb in LEG_LABELS))  # no wall between legs
        at_joint[own] = _sampled(shared.astype(np.float32), at[own, :2])
    certain *= nearest
    at_joint *= (
        at[:, 5] * nearest
    )  # whatever is seen there, the limb's or the trunk's, is on the surface in which both meet
    person = nearest_colours(figure.rgb, within_the_outline(silhouette))
    before = np.clip(0.5 + at[:, 3] / (2 * MAX_SIDE_COSINE), 0, 1)
    of_hips = at[:, 6] * (1 - before)
    behind_hips = hips_behind(figure.rgb, hybrid.labels, silhouette, at[of_hips > 0, :2])
    of_front, of_back = at[:, 4] * (1 - certain) * before, at[:, 4] * (1 - before)
    seen_share = np.clip((at[:, 3] - MIN_PICTURED_COSINE) / (FULLY_PICTURED_COSINE - MIN_PICTURED_COSINE), 0, 1)
    mixed = texture[y, x].astype(np.float32)
    change, pictured = np.zeros(texture.shape, np.float32), np.zeros(texture.shape[:2], np.float32)
    change[y, x], pictured[y, x] = picture - mixed, seen_share * certain
    mixed += light_of_the_picture(change, pictured)[y, x]
    for weight, colours in (
        (of_front, front),
        (of_back, back),
        (of_hips, _sampled(behind_hips, pixel)),
        (seen_share * certain, picture),
        (seen_share * at_joint, _sampled(person, pixel)),
    ):
        mixed += weight[:, None] * (colours - mixed)
    out = texture.copy()
    out[y, x] = np.clip(mixed + 0.5, 0, 255).astype(np.uint8)
    return out


def _shown(limb: int, hybrid: Hybrid, rgb: NDArray[np.uint8], silhouette: Silhouette) -> _Shown | None:
    """What a picture (H, W, 3) shows of a limb, an index of `BODY_PARTS`; None of one that it hides."""
    labels = hybrid.labels.labels
    sure = (labels == limb) & ~dilate_mask(hybrid.strange, 1)
    for other in LIMB_LABELS:
        if other != limb:
            over = limb in LEG_LABELS and other in ARM_LABELS
            sure &= ~dilate_mask(labels == other, SURE_ARM_OVER_LEG_MARGIN_PIXELS if over else LIMB_MARGIN_PIXELS)
    if limb in ARM_LABELS:  # it leaves, and takes none of the body's colours with it
        sure &= ~dilate_mask(np.isin(labels, (TRUNK_LABEL, HEAD_LABEL)), LIMB_MARGIN_PIXELS)
    away = distance_to(sure)
    certain = np.clip((CONTINUED_PIXELS - away) / (CONTINUED_PIXELS - FULLY_CONTINUED_PIXELS), 0, 1)
    size = (rgb.shape[1], rgb.shape[0])
    flags = cv2.INTER_LINEAR | cv2.WARP_INVERSE_MAP
    there = cv2.warpAffine(sure.astype(np.float32), silhouette.to_grid, size, flags=flags) > 0.5
    own = there & within_the_outline(silhouette)
    return _Shown(nearest_colours(rgb, own), certain.astype(np.float32)) if own.any() else None


def _sampled(tile: NDArray[np.uint8] | NDArray[np.float32], places: NDArray[np.floating]) -> NDArray[np.float32]:
    """Values (N, ...) of a picture at places (N, 2), pixels."""
    maps = [np.ascontiguousarray(places[:, k].reshape(-1, 1), np.float32) for k in (0, 1)]
    rows = 16_384  # remap takes no more at once
    parts = [
        cv2.remap(tile, maps[0][k : k + rows], maps[1][k : k + rows], cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE)
        for k in range(0, len(places), rows)
    ]
    return np.concatenate(parts)[:, 0].astype(np.float32) if parts else np.zeros((0, 3), np.float32)
