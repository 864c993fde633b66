"""Limbs as rings: what a limb is coloured like at each height along it, by what is seen of it there, or of the other side's.

A sleeve ends all round, and so does a sock, and both sides' do at one height. So what is hidden of a limb has the
colour that the limb shows at the same height. Where it shows nothing, it has the other limb's; where neither does, what
is between those above and below.
"""

from __future__ import annotations

from collections.abc import Container, Mapping
from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.body.parts import BODY_PARTS, vertex_parts
from engine.body.rig import Rig
from engine.character.fit.posed_template import PosedTemplate
from engine.character.fit.template_maps import side_maps
from engine.character.parts.labels import ARM_LABELS, LEG_LABELS, OPPOSITE_LABEL
from engine.imaging.filling.nearest import nearest_in
from engine.render.rasterisation.attributes import interpolate

RING_LENGTH_METRES = 0.01
"""Metres along a limb of a ring."""
MAX_RINGS = 256
"""As many as there are at most: none is further than two and a half metres."""
MIN_RING_SHARE = 0.15
"""How much of a ring must be seen, as a share of what is usual where the limb is seen, before it is told."""
RING_BLUR_RINGS = 1.0
"""Rings over which colours are averaged: a cuff is no softer than that."""


@dataclass(frozen=True)
class Heights:
    """How far along a limb each pixel (h, w) of the grid is, metres from the body's middle or from the ground; and from where on, if it is an arm,
    it is a hand."""

    along: NDArray[np.float32]
    hand: float | None


def limb_heights(template: PosedTemplate, rig: Rig, labels: NDArray[np.integer]) -> dict[int, Heights]:
    """Those of arms and legs of a template on the grid of the `labels` (h, w)."""
    part_of = vertex_parts(rig)[template.triangles[:, 0]]
    found = {}
    for limb in ARM_LABELS + LEG_LABELS:
        triangles = template.triangles[part_of == limb]
        size = (labels.shape[0], labels.shape[1])
        seen = side_maps(template.vertices, triangles, size, "front")
        if not seen.mask.any():
            continue
        axis = 0 if limb in ARM_LABELS else 1
        along = np.abs(interpolate(template.rest[:, axis : axis + 1], triangles, seen.raster)[..., 0])
        side = "Left" if BODY_PARTS[limb].startswith("left") else "Right"
        wrist = abs(float(template.rest_joints[rig.index(f"{side}Hand"), 0])) if limb in ARM_LABELS else None
        found[limb] = Heights(np.asarray(along[nearest_in(seen.mask)], np.float32), wrist)
    return found


def rings(
    rgb: NDArray[np.uint8],
    labels: NDArray[np.integer],
    clean: NDArray[np.bool_],
    heights: Mapping[int, Heights],
    skin: NDArray[np.floating] | None,
    wanted: Container[int] | None = None,
) -> dict[int, NDArray[np.float32]]:
    """Pictures (H, W, 3) of what each limb is coloured like, levels, wherever it is; of those alone of which, or of whose other side, something is
    seen.

    Parameters
    ----------
    rgb : (H, W, 3), the picture.
    labels : (h, w) on the grid, what its pixels show; `clean` (H, W): where colours are those of what is labelled alone.
    heights : of limbs, on the grid.
    skin : (3,) the colour of hands of which none is seen; None if it is not known.
    wanted : the limbs of which pictures are wanted; all unless they are given.
    """
    if wanted is not None:
        heights = {limb: one for limb, one in heights.items() if limb in wanted or OPPOSITE_LABEL[limb] in wanted}
    size = (rgb.shape[1], rgb.shape[0])
    along = {
        limb: np.asarray(cv2.resize(one.along, size, interpolation=cv2.INTER_LINEAR), np.float32)
        for limb, one in heights.items()
    }
    told = {}
    for limb, one in along.items():
        own = cv2.resize((labels == limb).astype(np.float32), size, interpolation=cv2.INTER_LINEAR) > 0.5
        told[limb] = _told(rgb, np.asarray(own & clean), one)
    found = {}
    for limb in along if wanted is None else [limb for limb in along if limb in wanted]:
        one = along[limb]
        colours = _whole(told[limb], told.get(OPPOSITE_LABEL[limb]), heights[limb].hand, skin)
        if colours is not None:
            at = np.clip(one / RING_LENGTH_METRES, 0, len(colours) - 1).astype(np.float32)
            found[limb] = np.asarray(cv2.remap(colours[:, None], np.zeros_like(at), at, cv2.INTER_LINEAR), np.float32)
    return found


def _told(rgb: NDArray[np.uint8], own: NDArray[np.bool_], along: NDArray[np.float32]) -> NDArray[np.float32]:
    """The median colour of each ring (R, 3) of a limb's `own` pixels (H, W); NaN where hardly any is seen."""
    out = np.full((MAX_RINGS, 3), np.nan, np.float32)
    ring = np.clip(along[own] / RING_LENGTH_METRES, 0, MAX_RINGS - 1).astype(np.intp)
    if not len(ring):
        return out
    count = np.bincount(ring, minlength=MAX_RINGS)
    least = MIN_RING_SHARE * np.median(count[count > 0])
    order = np.argsort(ring, kind="stable")
    colours, firsts = rgb[own][order], np.concatenate([[0], np.cumsum(count)])
    for one in np.flatnonzero((count > 0) & (count >= least)):
        out[one] = np.median(colours[firsts[one] : firsts[one + 1]], 0)
    return out


def _whole(
    own: NDArray[np.float32], other: NDArray[np.float32] | None, hand: float | None, skin: NDArray[np.floating] | None
) -> NDArray[np.float32] | None:
    """All rings (R, 3) of a limb of which its `own` and those of the `other` side are told; None where none is."""
    out = own.copy()
    if other is not None:
        both = np.isfinite(own[:, 0]) & np.isfinite(other[:, 0])
        light = np.median(own[both] - other[both], 0) if both.any() else np.zeros(3, np.float32)
        out = np.where(np.isfinite(out), out, other + light)
    there = np.isfinite(out[:, 0])
    if not there.any():
        return None
    if hand is not None and skin is not None and not there[round(hand / RING_LENGTH_METRES) :].any():
        out[round(hand / RING_LENGTH_METRES) :] = skin
        there = np.isfinite(out[:, 0])
    rows = np.flatnonzero(there)
    full = np.stack([np.interp(np.arange(MAX_RINGS), rows, one) for one in out[rows].T], 1).astype(np.float32)
    soft = cv2.GaussianBlur(full, (1, 0), 1, sigmaY=RING_BLUR_RINGS, borderType=cv2.BORDER_REPLICATE)
    return np.asarray(np.clip(soft, 0, 255), np.float32)
