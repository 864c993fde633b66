"""Where cloth that goes round both legs ends, and which pixels beneath are legs'.

This goes beyond the paper, in which clothes are one with the body. Legs that come out from under a hem are limbs that
something passes before, and go on behind it.
"""

from __future__ import annotations

from dataclasses import replace

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.body.parts import BODY_PARTS, vertex_parts
from engine.body.rig import Rig
from engine.character.fit.posed_template import PosedTemplate
from engine.character.parts.free_cloth import FreeCloth, free_cloth
from engine.character.parts.hem_between_legs import hem_between_legs
from engine.character.parts.label_map import Labels
from engine.character.parts.labels import ARM_LABELS, LEG_LABELS, MIN_LIMB_PIXELS
from engine.character.parts.overlapping_legs import leg_before
from engine.character.parts.regions import Region, find_regions
from engine.character.parts.unseen_limbs import not_seen
from engine.imaging.masks.colour_segmentation import (
    MIN_MIXTURE_PIXELS,
    UNSEEDED_MARK,
    ColourMixture,
    ContrastGraph,
    colour_costs,
)
from engine.imaging.masks.mask_distance import dilate_mask
from engine.imaging.masks.mask_pieces import largest_piece, pieces_touching, rows_apart, without_small_pieces

HEM_BAND_SHARE = 0.05
"""How far above and below the last ring of the cloth its hem may be, as a share of the person's height."""
FAR_LABEL_COST = 3.0
"""What a pixel so far away costs with the label that is not its own there, in units of equation 16."""
LEG_EDGE_PIXELS = 3
"""Pixels up to which what seems to hang down beside a leg is the leg's edge."""


def with_cloth(labels: Labels, rgb: NDArray[np.uint8], template: PosedTemplate, rig: Rig) -> Labels:
    """Labels with the cloth that goes round both legs, and where it hangs, the legs that come out from under it. What
    goes round both is one piece with the trunk, and neither of them is apart there. `rgb` (h, w, 3): the picture on
    their grid."""
    unseen = [limb for limb in not_seen(labels) if limb in ARM_LABELS]
    region, _ = find_regions(labels, [int(limb) for limb in labels.apart], template, rig, unseen)
    cloth = around_legs(region, labels, rgb, template, rig)
    if cloth is None or not cloth.hangs:
        return replace(labels, cloth=cloth)
    before = leg_before(labels.labels, template, rig)
    legs = legs_below(rgb, labels.labels, cloth, before)
    part = vertex_parts(rig)[template.triangles]
    for leg in np.unique(legs[legs >= 0]):
        first = np.flatnonzero((legs == leg).any(1))[0]
        if template.covers((part == leg).all(1), legs.shape)[first:].sum() < MIN_LIMB_PIXELS:
            legs[legs == leg] = -1  # nothing says what shape it has
    lower = cloth.lower.copy()
    first = cloth.rings[-1].row + 1
    beneath = round(2 * HEM_BAND_SHARE * rows_apart(labels.labels >= 0))
    lower[first : first + beneath] |= (cloth.worn & (legs < 0))[first : first + beneath]
    cloth = replace(cloth, legs=legs, lower=lower, before=before)
    return replace(labels, apart=np.setdiff1d(labels.apart, LEG_LABELS), cloth=cloth)


def around_legs(
    body: Region, labels: Labels, rgb: NDArray[np.uint8], template: PosedTemplate, rig: Rig
) -> FreeCloth | None:
    """The cloth that goes round both legs, one that passes before the other included, in the picture `rgb` (h, w, 3)."""
    part = vertex_parts(rig)[template.triangles]
    crossing = [int(limb) for limb in labels.apart if limb in LEG_LABELS]
    clothed = body.triangles | np.isin(part, crossing).any(1)
    sides = template.sides(clothed, body.mask.shape)
    shown = np.where(sides.front.mask, part[:, 0][clothed][sides.front.raster.triangle], -1)
    bare = [arm for arm in ARM_LABELS if arm not in labels.apart]
    cloth = (body.mask | np.isin(labels.labels, crossing)) & ~np.isin(labels.labels, bare)
    legs = [template.covers(clothed & (part == leg).all(1), shown.shape) for leg in LEG_LABELS]
    hem = hem_between_legs(rgb, cloth, *(shown == leg for leg in LEG_LABELS))
    return free_cloth(cloth, shown, sides.front.depth, sides.back.depth, labels.parting, legs[0] & legs[1], hem)


def legs_below(
    rgb: NDArray[np.uint8], labels: NDArray[np.integer], cloth: FreeCloth, before: int | None = None
) -> NDArray[np.int8]:
    """The leg (h, w), an index of `BODY_PARTS`, that shows from under a hem; -1 elsewhere. The hem is near the last ring, where
    the picture `rgb` (h, w, 3) goes over from the cloth's colours to the legs'. Each is in one piece, unless the one that is `before` it
    parts it."""
    end, wide = cloth.rings[-1].row, max(2, round(HEM_BAND_SHARE * rows_apart(labels >= 0)))
    rows = np.broadcast_to(np.arange(len(labels))[:, None], labels.shape)
    person = (labels >= 0) & ~np.isin(labels, ARM_LABELS) & (labels != BODY_PARTS.index("head"))
    below = person & (rows > end) & np.isin(labels, LEG_LABELS) & ~cloth.lower
    band = person & (abs(rows - end) <= wide) & (cloth.worn | below)
    shown = _parted(rgb, person & (cloth.worn | below) & (abs(rows - end) <= 3 * wide), band, below, end, wide)
    legs = np.where(band, shown, below)
    alone = (person & ~legs).astype(np.uint8)
    thread = person & ~(
        cv2.morphologyEx(alone, cv2.MORPH_OPEN, np.ones((LEG_EDGE_PIXELS, LEG_EDGE_PIXELS), np.uint8)) > 0
    )
    legs |= thread & (rows > end) & dilate_mask(legs, LEG_EDGE_PIXELS)
    # what hangs together with no foot is cloth
    legs = pieces_touching(legs, rows > end + wide)
    found = np.full(labels.shape, -1, np.int8)
    away = np.stack([cv2.distanceTransform((labels != leg).astype(np.uint8), cv2.DIST_L2, 5) for leg in LEG_LABELS])
    found[legs] = np.array(LEG_LABELS, np.int8)[away.argmin(0)][legs]
    for leg in LEG_LABELS:
        own = found == leg
        whole = largest_piece(own)
        if before not in (None, leg):
            whole |= pieces_touching(without_small_pieces(own, MIN_LIMB_PIXELS), dilate_mask(found == before, 1))
        found[own & ~whole if whole.sum() >= MIN_LIMB_PIXELS else own] = -1
    return found


def _parted(
    rgb: NDArray[np.uint8],
    near: NDArray[np.bool_],
    band: NDArray[np.bool_],
    below: NDArray[np.bool_],
    end: int,
    wide: int,
) -> NDArray[np.bool_]:
    """Which pixels of the `band` (h, w) are legs', by their colours and by their distance from the row where the cloth
    ends. Those that are `near` (h, w) and not in it are as `below` (h, w) says."""
    colours = rgb.astype(np.float64)
    learned = [colours[near & ~band & which] for which in (~below, below)]
    if min(len(some) for some in learned) < MIN_MIXTURE_PIXELS:
        return below
    rows = np.nonzero(near)[0]
    pixels, inner, before = colours[near], band[near], below[near]
    costs = colour_costs([ColourMixture.fit(some) for some in learned], pixels)
    off = FAR_LABEL_COST * (rows - end) / wide
    costs += np.stack([np.maximum(off, 0), np.maximum(-off, 0)], 1)
    labels = before.astype(np.intp)
    cut = ContrastGraph.of(colours, near).cut(costs, labels, np.where(inner, UNSEEDED_MARK, labels))
    found = np.zeros_like(near)
    found[near] = cut > 0
    return found
