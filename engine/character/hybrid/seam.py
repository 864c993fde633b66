"""The colours of a shell where it goes over into the trunk: the trunk's, so that neither sides nor backs show a border.

What a shell's own trunk would be coloured like is filled from its rows; here a relief is in its place, whose tiles say what is there.
"""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.body.parts import BODY_PARTS
from engine.character.hybrid.hybrid import Hybrid
from engine.character.hybrid.trunk import LIMB_LABELS
from engine.character.shell.colours.paint import texels
from engine.character.texture.texture import Tiles
from engine.geometry.mesh.surface import vertex_normals
from engine.imaging.masks.mask_distance import dilate_mask
from engine.render.rasteriser import rasterise

TRUNK_WEIGHT_THRESHOLD = 0.5
"""Share of the trunk in what moves a vertex from which on its colours go over to the trunk's."""
MIN_PICTURED_COSINE, FULLY_PICTURED_COSINE = 0.12, 0.3
"""Cosine to the viewer from which on what is seen of a limb is more and more, and all, the picture's."""
LIMB_LABEL_TOLERANCE_PIXELS = 5
"""Pixels of the grid around a limb's label in which its surface may be what is seen: neither's border is exact."""
VISIBILITY_TOLERANCE_PIXELS = 3.0
"""Pixels of the grid by which a point may be behind what is nearest at its place and yet be seen."""
MAX_SIDE_COSINE = 0.3
"""Cosine to the viewer up to which, on both sides, front and back go over into one another."""


def with_the_trunks_colours(
    texture: NDArray[np.uint8], hybrid: Hybrid, tiles: Tiles, rgb: NDArray[np.uint8], to_grid: NDArray[np.float64]
) -> NDArray[np.uint8]:
    """A shell's texture (S, S, 3) which goes over to the colours that a trunk's `tiles` have in front and behind.

    Where a limb is what is seen, it goes over to those of the picture `rgb` (H, W, 3), which `to_grid` (2, 3) brings to the grid: a trunk
    does not end, and an arm does not begin, in the same place on the template and on a sleeve.
    """
    shell, labels, raster = hybrid.shell, hybrid.labels.labels, texels()
    mesh = shell.mesh
    share = np.clip(
        (mesh.parts[:, BODY_PARTS.index("torso")] - TRUNK_WEIGHT_THRESHOLD) / (1 - TRUNK_WEIGHT_THRESHOLD), 0, 1
    )
    facing = -vertex_normals(shell.pictured, mesh.triangles)[:, 2]
    values = np.column_stack([shell.pictured, facing, share]).astype(np.float32)
    shown = np.asarray((hybrid.limbs.limb >= 0)[mesh.triangles].all(1), np.bool_)
    y, x = np.nonzero((raster.triangle >= 0) & shown[raster.triangle])
    corners = mesh.triangles[raster.triangle[y, x]]
    at = np.einsum("nk,nkc->nc", raster.barycentrics[y, x], values[corners])
    tile = (at[:, :2] + 0.5) * tiles.scale + tiles.shift - 0.5
    front, back = _sampled(tiles.body, tile), _sampled(tiles.back, tile)
    picture = _sampled(rgb, (at[:, :2] - to_grid[:, 2]) / np.diag(to_grid))
    depth = -rasterise(shell.pictured * [1, 1, -1], mesh.triangles[shown], labels.shape).depth
    column, row = np.clip(np.rint(at[:, :2]).astype(int), 0, [labels.shape[1] - 1, labels.shape[0] - 1]).T
    nearest = ~(depth[row, column] - at[:, 2] > VISIBILITY_TOLERANCE_PIXELS)
    own = _around_limbs(labels)[hybrid.limbs.limb[corners[:, 0]], row, column] & nearest
    before = np.clip(0.5 + at[:, 3] / (2 * MAX_SIDE_COSINE), 0, 1)
    of_front, of_back = at[:, 4] * before * ~own, at[:, 4] * (1 - before)
    seen = np.clip((at[:, 3] - MIN_PICTURED_COSINE) / (FULLY_PICTURED_COSINE - MIN_PICTURED_COSINE), 0, 1) * own
    mixed = texture[y, x].astype(np.float32)
    for weight, colours in ((of_front, front), (of_back, back), (seen, picture)):
        mixed += weight[:, None] * (colours - mixed)
    out = texture.copy()
    out[y, x] = np.clip(mixed + 0.5, 0, 255).astype(np.uint8)
    return out


def _around_limbs(labels: NDArray[np.integer]) -> NDArray[np.bool_]:
    """For each part the pixels (P, h, w) that it may show: of limbs what is labelled so, and a little around it that is no other
    limb's; of other parts none."""
    around = np.zeros((len(BODY_PARTS), *labels.shape), np.bool_)
    for limb in LIMB_LABELS:
        others = np.isin(labels, [other for other in LIMB_LABELS if other != limb])
        around[limb] = dilate_mask(labels == limb, LIMB_LABEL_TOLERANCE_PIXELS) & ~dilate_mask(others, 2)
        around[limb] |= labels == limb
    return around


def _sampled(tile: NDArray[np.uint8], places: NDArray[np.floating]) -> NDArray[np.float32]:
    """Colours (N, 3) of a tile at places (N, 2), pixels."""
    maps = [np.ascontiguousarray(places[:, k].reshape(-1, 1), np.float32) for k in (0, 1)]
    rows = 16_384  # remap takes no more at once
    parts = [
        cv2.remap(tile, maps[0][k : k + rows], maps[1][k : k + rows], cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE)
        for k in range(0, len(places), rows)
    ]
    return np.concatenate(parts)[:, 0].astype(np.float32) if parts else np.zeros((0, 3), np.float32)
