"""The colours of limbs that are apart: what is seen of them, and what is made where something passes before them.

The paper's section 5 fills hidden regions by PatchMatch. Beyond it, they are filled from what is near of the same limb, or
from the other one where hardly more than a hand is seen.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from types import MappingProxyType

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.character.figure.face_region import within_oval
from engine.character.parts.crossed_labels import Behind
from engine.character.parts.label_map import Labels
from engine.character.parts.labels import LEG_LABELS, OPPOSITE_LABEL
from engine.character.texture.rings import Heights
from engine.imaging.filling.inpaint import inpaint
from engine.imaging.filling.nearest import continued_colours
from engine.imaging.masks.mask_distance import dilate_mask, distance_inside, distance_to
from engine.imaging.masks.mask_pieces import bounding_box
from engine.imaging.masks.usual_colours import usual_colours
from engine.imaging.resample import enlarged_mask

MIXED_EDGE_PIXELS = (0.5, 1.5)
"""Pixels of the grid within a limb's edge up to which its colours are mixed with what is behind, and from which on they are
surely its own."""
MAX_SLIVER_PIXELS = 5
"""Pixels of the grid up to which a limb that shows beside its label is the outline's roughness."""
COLOUR_LOOKUP_SHARE = 0.07
"""How far from what is hidden of a limb its colours are looked up, as a share of the person's height."""
LIMB_MID_LEVEL, MAX_DETAIL_LEVELS = 128, 60
"""The level on which what is fine about a limb is looked at; and the levels beyond which it is no more than that."""
MIN_SEEN_ARM_SHARE = 0.25
"""Share of an arm that is seen, below which the other one tells more of what it wears."""


def own_of_limbs(labelled: NDArray[np.bool_], shown: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """The pixels (h, w) whose colours are the limbs': those `labelled` so where their surface is `shown`, and what it shows
    beyond slivers elsewhere. The others are on the body, whatever they are called."""
    near = dilate_mask(shown, 1)
    more = cv2.morphologyEx(
        (shown & ~labelled).astype(np.uint8), cv2.MORPH_OPEN, np.ones((MAX_SLIVER_PIXELS, MAX_SLIVER_PIXELS), np.uint8)
    )
    return np.asarray((labelled & near) | (more > 0))


@dataclass(frozen=True)
class LimbSurfaces:
    """What the surfaces of limbs that are apart cover of the grid."""

    reach: NDArray[np.bool_]
    """(h, w) all of it, seen or not."""
    shown: NDArray[np.bool_]
    """(h, w) where they are the nearest."""
    along: NDArray[np.bool_] | None = None
    """(h, w) what of the body goes with a limb, as at shoulders, and so is of its colours."""
    body: NDArray[np.bool_] | None = None
    """(h, w) what the body covers without them; all of the person unless it is given."""
    sleeves: Mapping[int, NDArray[np.bool_]] = field(default_factory=dict)
    """(h, w) each: what that of an arm covers above its hand, by the arm's index."""
    whole: Mapping[int, NDArray[np.bool_]] = field(default_factory=dict)
    """(h, w) each: what that of a limb covers, by its index."""
    heights: Mapping[int, Heights] = field(default_factory=dict)
    """How far along limbs pixels are, by their index."""
    before: NDArray[np.bool_] | None = None
    """(h, w) what else lies before the body, as hair."""


def paint_limbs(
    seen: NDArray[np.uint8],
    own: NDArray[np.bool_],
    around: NDArray[np.bool_],
    labels: Labels,
    surfaces: LimbSurfaces,
    face: NDArray[np.floating] | None,
    scale: float,
    round_them: Mapping[int, NDArray[np.float32]] = MappingProxyType({}),
) -> NDArray[np.uint8]:
    """The tile (H, W, 3) of the limbs that are apart.

    Parameters
    ----------
    seen : the picture (H, W, 3), continued beyond the person's `own` pixels (H, W).
    around : (H, W) what the limbs show, to their edges in the picture.
    surfaces : of the limbs, on the grid of the `labels` (h, w).
    face : an ellipse around the face, in pixels of the tile.
    scale : pixels of the tile for each of the grid's.
    round_them : what limbs are coloured like all round, (H, W, 3) each, as `rings.rings` has it.
    """
    size = (own.shape[1], own.shape[0])
    limbs, reach, sleeves = surfaces.shown, surfaces.reach, surfaces.sleeves
    made = seen
    if limbs.any():
        legs = np.isin(labels.labels, LEG_LABELS)
        legs = enlarged_mask(distance_to(limbs & legs) < distance_to(limbs & ~legs), size)
        hole = enlarged_mask(reach & ~limbs, size)
        made = of_the_limbs(seen, around & own, hole, scale, legs, _laid(seen, surfaces, round_them))
        near = enlarged_mask(
            dilate_mask(limbs | reach, MAX_SLIVER_PIXELS), size
        )  # what an unseen limb is like may be elsewhere
        made = np.where(near[..., None], made, seen)
    for arm in sleeves:
        made = _like_the_other_sleeve(made, seen, labels, arm, sleeves, limbs, own)
    if (labels.hidden >= 0).any():
        hands = dilate_mask(labels.hidden >= 0, MAX_SLIVER_PIXELS) & ~limbs
        made = _with_skin(made, seen, enlarged_mask(hands, size), face, own)
    return made


def of_the_limbs(
    seen: NDArray[np.uint8],
    own: NDArray[np.bool_],
    hole: NDArray[np.bool_],
    scale: float,
    legs: NDArray[np.bool_] | None = None,
    rings: NDArray[np.float32] | None = None,
) -> NDArray[np.uint8]:
    """The limbs (h, w, 3): what is seen of their `own`, and around it, where a surface that was made on the grid may
    end, the colours of their inside. The `hole` behind what is before them is filled from what is usual near it. A
    hand's skin is on no shoulder, nor, where `legs` (h, w) are, on one of these. Where it is known what limbs are like
    all round, `rings` (h, w, 3), that is what they are like there, too, and patches say what is fine about it."""
    inside = distance_inside(own) / scale
    deep = inside > MIXED_EDGE_PIXELS[1]
    around = continued_colours(seen, deep if deep.any() else own)
    made = np.where((inside > MIXED_EDGE_PIXELS[0])[..., None], seen, around)
    for which in (np.ones_like(own),) if legs is None else (legs, ~legs):
        mine, lost = own & which, hole & which
        if mine.any() and lost.any():
            known = usual_colours(seen, mine & (distance_to(lost) < COLOUR_LOOKUP_SHARE * hole.shape[0]))
            made = filled(made, lost, known if known.any() else mine, rings)
    return made


def filled(
    rgb: NDArray[np.uint8], hole: NDArray[np.bool_], source: NDArray[np.bool_], rings: NDArray[np.float32] | None
) -> NDArray[np.uint8]:
    """A picture (h, w, 3) with a `hole` (h, w) filled with patches of the `source` (h, w). Where `rings` (h, w, 3) say
    what limbs are like all round, patches are of what is fine about them."""
    if rings is None or not hole.any():
        return inpaint(rgb, hole, source)
    box = bounding_box(hole | source)
    like, lost = rings[box], hole[box]
    fine = np.clip(LIMB_MID_LEVEL + rgb[box].astype(np.float32) - like, 0, 255).astype(np.uint8)
    kept = source[box] & (cv2.absdiff(fine, np.full_like(fine, LIMB_MID_LEVEL)) < MAX_DETAIL_LEVELS).all(-1)
    fine = inpaint(fine, lost, kept) if kept.any() else np.full_like(fine, LIMB_MID_LEVEL)
    out = rgb.copy()
    made = like[lost] + fine[lost] - np.float32(LIMB_MID_LEVEL) + np.float32(0.5)
    out[box][lost] = np.clip(made, 0, 255).astype(np.uint8)
    return out


def _laid(
    seen: NDArray[np.uint8], surfaces: LimbSurfaces, rings: Mapping[int, NDArray[np.float32]]
) -> NDArray[np.float32] | None:
    """One picture (H, W, 3) of what all limbs are like round, each where it is; None where that is not known of all."""
    size = (seen.shape[1], seen.shape[0])
    if not surfaces.whole or any(limb not in rings for limb in surfaces.whole):
        return None
    out = seen.astype(np.float32)
    for limb, whole in surfaces.whole.items():
        near = enlarged_mask(dilate_mask(whole, MAX_SLIVER_PIXELS), size)
        out = np.where(near[..., None], rings[limb], out)
    return out


def _like_the_other_sleeve(
    made: NDArray[np.uint8],
    seen: NDArray[np.uint8],
    labels: Labels,
    arm: int,
    sleeves: Mapping[int, NDArray[np.bool_]],
    limbs: NDArray[np.bool_],
    own: NDArray[np.bool_],
) -> NDArray[np.uint8]:
    """The limbs as they are `made` (h, w, 3) with the sleeve of an arm of which hardly more than the hand is `seen` made of what the
    other one is, where none of the `limbs` (h, w) is seen."""
    other = OPPOSITE_LABEL[arm]
    shown = {one: (labels.labels == one) & sleeve for one, sleeve in sleeves.items()}
    if (
        other not in sleeves
        or shown[arm].sum() > MIN_SEEN_ARM_SHARE * sleeves[arm].sum()
        or shown[other].sum() < shown[arm].sum()
    ):
        return made
    size = (own.shape[1], own.shape[0])
    hole = enlarged_mask(sleeves[arm] & ~limbs, size)
    return inpaint(made, hole, usual_colours(seen, enlarged_mask(shown[other], size) & own))


def behind_another(
    limbs: NDArray[np.uint8],
    labels: Labels,
    behind: Behind,
    seen: NDArray[np.uint8],
    own: NDArray[np.bool_],
    face: NDArray[np.floating] | None,
) -> NDArray[np.uint8]:
    """The `limbs` (h, w, 3) with that which is `behind` another in its own colours there, as they are elsewhere on it."""
    size = (own.shape[1], own.shape[0])
    mine = labels.labels == behind.limb
    edge = dilate_mask(behind.area, MAX_SLIVER_PIXELS // 2)
    worn = usual_colours(limbs, enlarged_mask(mine & ~edge, size) & own)
    whole = inpaint(limbs, enlarged_mask(behind.area | (mine & edge), size), worn)
    return _with_skin(whole, seen, enlarged_mask(behind.hand, size), face, own)


def _with_skin(
    rgb: NDArray[np.uint8],
    seen: NDArray[np.uint8],
    hands: NDArray[np.bool_],
    face: NDArray[np.floating] | None,
    own: NDArray[np.bool_],
) -> NDArray[np.uint8]:
    """The picture (h, w, 3) with `hands` (h, w) that are hidden in the face's colour; as it was where no face is `seen`."""
    skin = np.zeros_like(own) if face is None else within_oval(face, own.shape) & own
    return np.where(hands[..., None], np.median(seen[skin], axis=0).astype(np.uint8), rgb) if skin.any() else rgb
