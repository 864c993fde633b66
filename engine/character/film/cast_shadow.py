"""The shadow that the person casts on the ground of the picture: found, so that it leaves with them.

On plain ground the light changes slowly. A smooth surface is fitted to the ground's brightness around the feet; what is
darker than it by a good deal, of the same hue, and hangs together with the feet, is the shadow. Where it lies tells where
the light comes from. On ground that is not plain nothing is said.
"""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.character.fit.template_fit import FittedBody
from engine.character.rig.measures import picture_camera, pose
from engine.character.rig.rigging import Character
from engine.imaging.masks.mask_distance import dilate_mask
from engine.imaging.masks.mask_pieces import bounding_box, pieces_touching
from engine.render.lighting.ground_shadow import GroundShadow

UPPER_MARGIN_HEIGHTS, LOWER_MARGIN_HEIGHTS, SIDE_MARGIN_HEIGHTS = 0.3, 0.2, 1.2
"""What of the picture is looked at, in heights of the person: above the feet, below them, and to either side."""
MAX_SHADOW_BRIGHTNESS_RATIO = 0.82
"""Brightness, as a share of the ground's, below which it is in shadow."""
MAX_PLAIN_GROUND_DEVIATION = 0.05
"""Deviation from the smooth surface, in natural logarithms of brightness, that plain ground has in the median."""
MAX_SHADOW_HUE_CHANGE = 12.0
"""By how much the colour (CIE a and b, 8 bits) may change in the shadow."""
MIN_SHADOW_AREA_RATIO, MAX_SHADOW_AREA_RATIO = 0.01, 1.0
"""Areas of shadows, as shares of the person's."""
TRIED_LIGHT_SLOPES = np.linspace(-2.0, 2.0, 21)
"""Light's directions that are tried: metres sideways for a metre down."""
SHADOW_COPY_SIZE_PIXELS = 480
"""Longest side, in pixels, of the copy in which a shadow is looked for."""
MIN_SHADOW_IOU, EQUIVALENT_IOU_SHARE = 0.35, 0.9
"""Overlap (intersection over union) with what the person would cast, from which a direction is believed; the share of the
best overlap that is as good as it."""


@dataclass(frozen=True)
class CastShadow:
    """`mask` (H, W) [0, 1]; `strength` [0, 1]: the share of light that is taken away; 0 where no shadow was found."""

    mask: NDArray[np.float32]
    strength: float


def find_cast_shadow(rgb: NDArray[np.uint8], alpha: NDArray[np.float32]) -> CastShadow:
    """Find the shadow of whoever `alpha` (H, W) cuts out of `rgb` (H, W, 3)."""
    nothing = CastShadow(np.zeros(alpha.shape, np.float32), 0.0)
    person = alpha > 0.5
    rows, columns = bounding_box(person)
    high, lowest = rows.stop - rows.start, rows.stop - 1
    top, bottom = (
        int(lowest - UPPER_MARGIN_HEIGHTS * high),
        int(min(alpha.shape[0], lowest + LOWER_MARGIN_HEIGHTS * high + 1)),
    )
    left = int(max(0, columns.start - SIDE_MARGIN_HEIGHTS * high))
    right = int(min(alpha.shape[1], columns.stop + SIDE_MARGIN_HEIGHTS * high))
    part = slice(top, bottom), slice(left, right)
    near = dilate_mask(alpha[part] > 0.02, 2)
    small = cv2.GaussianBlur(rgb[part], (0, 0), 1.2)
    lab = cv2.cvtColor(small, cv2.COLOR_RGB2LAB).astype(np.float64)
    light = np.log(np.maximum(small.astype(np.float64).mean(-1), 4))
    usual, off = _ground(light, ~near)
    if off > MAX_PLAIN_GROUND_DEVIATION:
        return nothing
    hue = np.median(lab[~near & (np.abs(light - usual) < 2 * MAX_PLAIN_GROUND_DEVIATION)], axis=0)
    same = np.linalg.norm(lab[..., 1:] - hue[1:], axis=-1) < MAX_SHADOW_HUE_CHANGE
    dark = (light - usual < np.log(MAX_SHADOW_BRIGHTNESS_RATIO)) & same & ~near
    dark = cv2.morphologyEx(dark.astype(np.uint8), cv2.MORPH_OPEN, np.ones((3, 3), np.uint8)) > 0
    # it begins at the feet
    feet = near & (np.arange(top, bottom)[:, None] > lowest - 0.08 * high)
    reach = dilate_mask(feet, max(2, high // 60))
    found = dark & pieces_touching(dark | reach, reach, connectivity=8)
    if not MIN_SHADOW_AREA_RATIO * person.sum() < found.sum() < MAX_SHADOW_AREA_RATIO * person.sum():
        return nothing
    mask = np.zeros(alpha.shape, np.float32)
    mask[part] = cv2.GaussianBlur(found.astype(np.float32), (0, 0), 1.5)
    return CastShadow(mask, float(np.clip(1 - np.exp(np.median((light - usual)[found])), 0, 0.9)))


def _ground(light: NDArray[np.float64], known: NDArray[np.bool_]) -> tuple[NDArray[np.float64], float]:
    """The smooth brightness (h, w) of the ground, quadratic, by robust least squares, and how far known pixels are off."""
    height, width = light.shape
    y, x = (np.mgrid[:height, :width] / max(height, width)) - 0.5
    terms = np.stack([np.ones_like(x), x, y, x * x, x * y, y * y], -1)
    if known.sum() < 100:
        return light, np.inf
    some = np.argwhere(known)[:: max(1, int(known.sum()) // 4000)]
    matrix, wanted = terms[some[:, 0], some[:, 1]], light[some[:, 0], some[:, 1]]
    weight = np.ones(len(wanted))
    for _ in range(12):
        solved = np.linalg.lstsq(matrix * weight[:, None], wanted * weight, rcond=None)[0]
        residual = wanted - matrix @ solved
        scale = max(1.5 * float(np.median(np.abs(residual))), 0.01)
        weight = 1 / (1 + (residual / (2 * scale)) ** 2)
    return terms @ solved, float(np.median(np.abs(residual)))


def ground_shadow(shadow: CastShadow, character: Character, fitted: FittedBody) -> GroundShadow:
    """How the character is to darken the ground: from the light that the picture's shadow tells of; else softly, below."""
    soft = GroundShadow()
    if shadow.strength == 0:
        return soft
    height, width = shadow.mask.shape
    camera = picture_camera(character, fitted, (height, width))
    posed = pose(character, character.pictured)[::3]
    factor = min(1.0, SHADOW_COPY_SIZE_PIXELS / max(height, width))
    size = max(1, round(width * factor)), max(1, round(height * factor))
    wanted = cv2.resize(shadow.mask, size, interpolation=cv2.INTER_AREA) > 0.5
    person = camera.project(posed)[:, :2] * factor
    standing = _splat(person, size)
    overlaps: dict[tuple[float, float], float] = {}
    for tilt in TRIED_LIGHT_SLOPES:
        for away in TRIED_LIGHT_SLOPES:
            ground = np.stack(
                [posed[:, 0] + posed[:, 1] * tilt, np.zeros(len(posed)), posed[:, 2] + posed[:, 1] * away], 1
            )
            seen = camera.project(ground)
            cast = _splat(seen[seen[:, 2] > 0, :2] * factor, size) & ~standing
            overlaps[float(tilt), float(away)] = float((cast & wanted).sum() / max((cast | wanted).sum(), 1))
    best = max(overlaps.values())
    if best < MIN_SHADOW_IOU:
        return soft
    # a shadow that leaves the picture may be of any length: the shortest that explains it
    light = min(
        (one for one, overlap in overlaps.items() if overlap > EQUIVALENT_IOU_SHARE * best),
        key=lambda one: np.hypot(*one),
    )
    direction = np.array([-light[0], 1.0, -light[1]])
    x, y, z = (direction / np.linalg.norm(direction)).tolist()
    return GroundShadow(strength=shadow.strength, reach=float("inf"), light=(x, y, z))


def _splat(points: NDArray[np.floating], size: tuple[int, int]) -> NDArray[np.bool_]:
    """What points (N, 2) cover of a picture of `size` (width, height), gaps closed."""
    drawn = np.zeros((size[1], size[0]), np.uint8)
    at = np.rint(points).astype(int)
    inside = (at >= 0).all(1) & (at < size).all(1)
    drawn[at[inside, 1], at[inside, 0]] = 1
    return np.asarray(cv2.morphologyEx(drawn, cv2.MORPH_CLOSE, np.ones((5, 5), np.uint8)) > 0)
