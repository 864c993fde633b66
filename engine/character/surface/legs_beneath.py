"""Legs that come out from under a skirt or a coat: surfaces of their own, which go on under it.

Beyond the paper, whose occluded regions (section 4.2.2) are those behind limbs: here cloth hides limbs.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from engine.body.parts import vertex_parts
from engine.body.rig import Rig
from engine.character.fit.posed_template import PosedTemplate
from engine.character.parts.label_map import Labels
from engine.character.parts.overlapping_legs import hidden_leg
from engine.character.parts.regions import LimbRegion
from engine.character.surface.front_and_back import Layer
from engine.character.surface.part_surface import Surface
from engine.imaging.masks.mask_pieces import largest_piece, rows_apart

LEG_UNDER_CLOTH_SHARE = 0.06
"""How far a leg goes on under the cloth, as a share of the person's height."""
LEG_TAPER_SHARE = 0.4
"""By how much narrower a leg ends under the cloth than it came, and nearer to the middle than the cloth: what nobody
sees should not come through where cloth swings."""
MIN_WIDTH_RATIO, MAX_WIDTH_RATIO = 0.7, 1.4
"""How wide a leg is under the cloth at least and at most, to what it is where it comes out."""


def legs_beneath(labels: Labels, template: PosedTemplate, rig: Rig) -> list[LimbRegion]:
    """The regions of legs that come out from under cloth, of labels taken apart (`Labels.layered`)."""
    cloth = labels.cloth
    if cloth is None or cloth.legs is None:
        return []
    part = vertex_parts(rig)[template.triangles]
    up = round(LEG_UNDER_CLOTH_SHARE * rows_apart(labels.labels >= 0))
    clothed = (labels.labels >= 0) & (cloth.legs < 0)
    found = []
    for leg in np.unique(cloth.legs[cloth.legs >= 0]):
        own, chosen = cloth.legs == leg, (part == leg).all(1)
        if cloth.before not in (None, leg):
            own = largest_piece(
                own | ((cloth.legs == cloth.before) & hidden_leg(cloth.legs, cloth.before, template, part))
            )
        mask = own | leg_under_cloth(own, clothed, template.covers(chosen, own.shape), up)
        high = template.vertices[template.triangles, 1].max(1) > np.flatnonzero(mask.any(1))[0]
        nothing = np.zeros_like(own)
        found.append(LimbRegion(largest_piece(mask), chosen & high, int(leg), np.zeros_like(chosen), nothing))
    return found


def going_with(leg: Layer, cloth: Layer, own: NDArray[np.bool_]) -> Layer:
    """A leg that goes more and more with the cloth the further it is under it, and keeps away from its surface, or it would come
    through where they swing. `own` (h, w): what is seen of it."""
    begin = np.flatnonzero(own.any(1))[0]
    rows = np.flatnonzero(leg.mask.any(1))
    share = np.clip((begin - np.arange(len(own))) / max(begin - rows[0], 1), 0, 1)[:, None]
    share = np.where(leg.mask & cloth.mask, share, 0).astype(np.float32)
    middle = (cloth.front.depth + cloth.back.depth) / 2
    sides = []
    for side, worn, towards in ((leg.front, cloth.front, 1), (leg.back, cloth.back, -1)):
        off = towards * (side.depth - middle)
        most = (1 - LEG_TAPER_SHARE * share) * towards * (worn.depth - middle)
        depth = np.where(share > 0, middle + towards * np.minimum(off, most), side.depth)
        weights = side.weights + share[..., None] * (worn.weights - side.weights)
        sides.append(Surface(depth.astype(np.float32), weights))
    return replace(leg, front=sides[0], back=sides[1])


def leg_under_cloth(
    own: NDArray[np.bool_], clothed: NDArray[np.bool_], template: NDArray[np.bool_], up: int
) -> NDArray[np.bool_]:
    """What a leg covers under cloth, (h, w): `up` rows above where it comes out, along the `template`'s (h, w) and as wide as it
    is there, where the person is `clothed` (h, w)."""
    first = np.flatnonzero(own.any(1))[0]
    columns = np.flatnonzero(own.any(0))
    tops = own.argmax(0)[columns]
    tops = tops[clothed[tops - 1, columns]]  # beneath cloth, and not beside the leg, as toes are
    begin = int(tops.max()) if len(tops) else int(first)
    rows, left, right = _edges(own)
    there, leftmost, rightmost = _edges(template)
    centre = np.interp(np.arange(len(own)), there, (leftmost + rightmost) / 2)
    width = np.interp(np.arange(len(own)), there, rightmost - leftmost + 1)
    middle, half = (left + right)[rows == begin][0] / 2, (right - left + 1)[rows == begin][0] / 2
    out = np.zeros_like(own)
    columns = np.arange(own.shape[1])
    for row in range(max(first - up, int(there[0])), begin):
        under = np.clip((first - row) / up, 0, 1)
        reach = (
            half * np.clip(width[row] / width[begin], MIN_WIDTH_RATIO, MAX_WIDTH_RATIO) * (1 - LEG_TAPER_SHARE * under)
        )
        out[row] = abs(columns - (middle + centre[row] - centre[begin])) < reach
    return out & clothed


def _edges(mask: NDArray[np.bool_]) -> tuple[NDArray[np.intp], NDArray[np.intp], NDArray[np.intp]]:
    """The rows (n,) of a mask, and its first and last column in each."""
    rows = np.flatnonzero(mask.any(1))
    return rows, mask[rows].argmax(1), mask.shape[1] - 1 - mask[rows, ::-1].argmax(1)
