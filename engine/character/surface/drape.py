"""A skirt or the tails of a coat hang as a bell does, also towards the viewer and away.

Beyond the paper, whose depth comes from the template's normals: two legs under a sheet, which from the side is as thin as
the legs and drawn in at the hem.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import gaussian_filter1d

from engine.character.parts.free_cloth import CLOSE_FIT_WIDTH_RATIO, FREE_HANGING_WIDTH_RATIO, FreeCloth
from engine.character.surface.front_and_back import Layer
from engine.character.surface.part_surface import Surface
from engine.imaging.masks.mask_distance import dilate_mask

MAX_DEPTH_SLOPE = 0.7
"""By how much half of the depth may grow with a step down."""
SUPERELLIPSE_EXPONENT = 2.2
"""Exponent of the cross-section, a superellipse: of 2 it would be an ellipse."""

OPEN_LENGTH_FACTOR = 3.0
"""How far cloth is open from beneath, in units of that over which it changes along the body."""


def drape(body: Layer, cloth: FreeCloth) -> Layer:
    """The body with its free cloth about as deep as it is wide. What hangs no wider than hips or legs falls straight from belly and seat."""
    middle, half, share = (
        np.array([getattr(ring, name) for ring in cloth.rings], np.float64) for name in ("middle", "half", "share")
    )
    if cloth.hangs:
        loose, near, far = np.maximum(_flare(cloth), share), *_falling_straight(body, cloth)
        middle = loose * middle + (1 - loose) * (near + far) / 2
        half = loose * half + (1 - loose) * (near - far) / 2
    middle, half, share = (
        gaussian_filter1d(one, cloth.even, mode="nearest") for one in (middle, _hanging(half, MAX_DEPTH_SLOPE), share)
    )
    if cloth.hangs:  # around both legs it is round, however close
        share = np.maximum(share, cloth.begins(cloth.above))
    share = share * cloth.begins()
    depths = body.front.depth.copy(), body.back.depth.copy()
    for k, row, columns in cloth.rows():
        height = half[k] * (1 - np.abs(cloth.rings[k].across(columns)) ** SUPERELLIPSE_EXPONENT) ** (
            1 / SUPERELLIPSE_EXPONENT
        )
        for depth, towards in zip(depths, (1, -1), strict=True):
            own = depth[row, columns]
            depth[row, columns] = own + share[k] * (middle[k] + towards * height - own)
    front, back = (Surface(depth, side.weights) for depth, side in zip(depths, (body.front, body.back), strict=True))
    return replace(body, front=front, back=back, hem=_hem(body.mask, cloth) if cloth.hangs else None)


def _flare(cloth: FreeCloth) -> NDArray[np.float64]:
    """How much wider than the hips each ring (n,) is: 0 as a straight skirt, 1 as a bell."""
    width = np.array([ring.width for ring in cloth.rings], np.float64)
    ratio = width / width[: cloth.above + 1].max()
    return np.asarray(
        np.clip((ratio - CLOSE_FIT_WIDTH_RATIO) / (FREE_HANGING_WIDTH_RATIO - CLOSE_FIT_WIDTH_RATIO), 0, 1)
    )


def _falling_straight(body: Layer, cloth: FreeCloth) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """The depth (n,) of each ring's front and back where cloth falls from what stands out furthest above it."""
    rows = list(cloth.rows())[: len(cloth.rings)]
    near = np.array([np.nanmax(body.front.depth[row, columns]) for _, row, columns in rows], np.float64)
    far = np.array([np.nanmin(body.back.depth[row, columns]) for _, row, columns in rows], np.float64)
    return np.maximum.accumulate(near), np.minimum.accumulate(far)


def _hem(mask: NDArray[np.bool_], cloth: FreeCloth) -> NDArray[np.float32]:
    """How far cloth is open from beneath at its hem, pixels; 0 elsewhere (h, w)."""
    first = cloth.rings[-1].row
    if cloth.legs is not None and cloth.parted:
        first = min(first, int(np.flatnonzero((cloth.legs >= 0).any(1))[0]) - 1)
    hem = mask & cloth.worn & dilate_mask(~mask, 1)
    hem[:first] = False
    up, within = np.zeros(mask.shape, np.float32), hem
    for step in range(1, round(OPEN_LENGTH_FACTOR * cloth.even) + 1):
        within = within & np.roll(mask, step, 0)
        up += within
    return up


def _hanging(half: NDArray[np.float64], steepest: float) -> NDArray[np.float64]:
    """Depths (n,) that do not shrink downwards, for cloth hangs, nor grow by more than `steepest` from row to row."""
    hung = np.maximum.accumulate(half)
    rows = np.arange(len(hung))
    return np.asarray(np.minimum.accumulate(hung - steepest * rows) + steepest * rows)
