"""The back of hips, level: a hem is as high behind as it is in front.

A limb's own model says what is around it at each height at rest, and hips that are turned or tilted carry that up on one side and down on
the other. Where legs begin they are behind what the whole width of trunk and legs is like at the height at which they are seen.
"""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.character.figure.silhouette import OPAQUE_ALPHA, Silhouette
from engine.character.fit.template_fit import load_human
from engine.character.hybrid.hybrid import Hybrid
from engine.character.parts.label_map import Labels
from engine.character.parts.labels import ARM_LABELS, HEAD_LABEL, LEG_LABELS, TRUNK_LABEL
from engine.character.texture.plain_cloth import TRUNK_SIDE_RADIANS
from engine.character.texture.trunk_back import with_trunk_back
from engine.imaging.filling.nearest import nearest_colours
from engine.imaging.masks.mask_distance import dilate_mask, distance_inside

LEVEL_BELOW_HIP_METRES, OWN_BELOW_HIP_METRES = 0.06, 0.18
"""Metres below the hip joints at rest down to which backs of legs are level with the trunk, and from which on they are the leg's own."""
MIN_HANGING_COSINE, HANGING_COSINE = 0.7, 0.87
"""Cosine between a thigh and the way down the trunk from which on it hangs somewhat, and wholly: of a lifted one nothing is level."""
ROWS_AROUND_PIXELS = 10
"""Rows of the grid above and below of which is known, too, what is behind them."""
BODY_OUTLINE_MARGIN_PIXELS, BESIDE_OTHERS_PIXELS = 2.5, 4.0
"""Pixels of the grid within the outline, and around arms and what is held, in which the body's colours are mixed with others."""
HIP_WIDTH_RADIANS = 0.0, TRUNK_SIDE_RADIANS[1]
"""Radians from the middle between which hips tell how high a hem is: over all their width, as the legs of shorts rise towards the sides, and hips
have no ties."""
SURE_JOINT_WEIGHT = 0.9
"""Weight of a joint from which on a vertex moves with it alone."""


def at_hips(hybrid: Hybrid) -> NDArray[np.float64]:
    """How far vertices (V,) of the shell are legs' that hang and are level with the trunk, from 0 to 1."""
    mesh, human = hybrid.shell.mesh, load_human()
    heads = dict(zip(human.rig.names, human.rig.joints(human.space.mean)[0], strict=True))
    height = human.space.mean[mesh.ids][:, 1].astype(np.float64)
    found = np.zeros(len(height))
    for leg, side in zip(LEG_LABELS, ("Left", "Right"), strict=True):
        own = hybrid.limbs.limb == leg
        below = heads[f"{side}UpLeg"][1] - height
        level = (OWN_BELOW_HIP_METRES - below) / (OWN_BELOW_HIP_METRES - LEVEL_BELOW_HIP_METRES)
        found[own] = np.clip(level[own], 0, 1) * _hangs(hybrid, f"{side}UpLeg", height)
    return found


def _hangs(hybrid: Hybrid, thigh: str, height: NDArray[np.float64]) -> float:
    """How far a thigh goes on down the trunk, from 0 to 1; `height` (V,): of the shell's vertices at rest."""
    mesh, seen = hybrid.shell.mesh, hybrid.shell.pictured
    own = mesh.share(thigh) > SURE_JOINT_WEIGHT
    lower = own & (height < np.median(height[own]))
    way = seen[lower].mean(0) - seen[own & ~lower].mean(0)
    down = seen[mesh.share("Hips") > SURE_JOINT_WEIGHT].mean(0) - seen[mesh.share("Spine2") > SURE_JOINT_WEIGHT].mean(0)
    cosine = float(way @ down / (np.linalg.norm(way) * np.linalg.norm(down)))
    return float(np.clip((cosine - MIN_HANGING_COSINE) / (HANGING_COSINE - MIN_HANGING_COSINE), 0, 1))


def hips_behind(
    rgb: NDArray[np.uint8], labels: Labels, silhouette: Silhouette, places: NDArray[np.floating]
) -> NDArray[np.uint8]:
    """The picture (H, W, 3) with what is behind trunk and thighs, about some `places` (N, 2) of the grid: at each height what their sides show.
    What lies beside them, as the wall or a hand, has the colours of the nearest of them: the template is as wide as it is."""
    if not len(places):
        return rgb
    rows = np.arange(labels.labels.shape[0])
    near = (rows > places[:, 1].min() - ROWS_AROUND_PIXELS) & (rows < places[:, 1].max() + ROWS_AROUND_PIXELS)
    body = np.isin(labels.labels, (TRUNK_LABEL, *LEG_LABELS)) & near[:, None]
    size, scale = (rgb.shape[1], rgb.shape[0]), 1 / float(silhouette.to_grid[0, 0])
    own = silhouette.alpha > OPAQUE_ALPHA

    def pictured(mask: NDArray[np.bool_]) -> NDArray[np.bool_]:
        flags = cv2.INTER_LINEAR | cv2.WARP_INVERSE_MAP
        return np.asarray(cv2.warpAffine(mask.astype(np.float32), silhouette.to_grid, size, flags=flags) > 0.5)

    others = np.isin(labels.labels, ARM_LABELS)
    if labels.held is not None:
        others |= labels.held >= 0
    shown, before = pictured(body) & own, pictured(others)
    clean = shown & within_the_outline(silhouette) & ~dilate_mask(before, round(BESIDE_OTHERS_PIXELS * scale))
    if not clean.any():
        return rgb
    rgb = nearest_colours(rgb, clean)
    head = pictured(labels.labels == HEAD_LABEL)
    return with_trunk_back(rgb, shown, clean, before, head, scale, told=HIP_WIDTH_RADIANS, necked=False)


def within_the_outline(silhouette: Silhouette) -> NDArray[np.bool_]:
    """The pixels (H, W) of the picture that show the person and nothing of what is behind."""
    margin = BODY_OUTLINE_MARGIN_PIXELS / silhouette.to_grid[0, 0]
    return np.asarray(distance_inside(silhouette.alpha > OPAQUE_ALPHA) > margin)
