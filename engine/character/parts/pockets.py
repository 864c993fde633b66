"""Hands that were not found: what shows around them, and whether they are hidden, in a pocket or behind the tail of a coat.

Beyond the paper. Colours part what shows there, the arm's from the cloth's. Where skin and cloth are alike it counts
whether the cloth goes on where the hand would be, and how sure of its fingers the body's network is. The template has
the hand that the picture lacks.
"""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.body.parts import BODY_PARTS
from engine.body.rig import Rig
from engine.character.fit.template_maps import side_maps
from engine.character.parts.labels import ARM_LABELS, complete_labels
from engine.character.parts.unfound_hands import SEEN_FINGER_CONFIDENCE, UnfoundHand, unit
from engine.geometry.rigging.joint_names import SIDE_NAMES
from engine.imaging.masks.colour_segmentation import MIN_MIXTURE_PIXELS, ColourMixture, smoothed_map
from engine.imaging.masks.mask_distance import dilate_mask, distance_to
from engine.imaging.masks.mask_pieces import pieces_touching

UNSEEN_FINGER_CONFIDENCE = 0.7
"""Confidence of a finger below which the hand surely is not seen."""
CLOTH_SHARE, CLOTH_WITHOUT_SKIN_SHARE = 0.2, 0.4
"""Share of the template's hand that stands out from the cloth around it. Up to the first the cloth goes on there,
whatever else is said; up to the second it does if no skin is seen there, or no finger."""
PLAIN_CLOTH_SHARE = 0.9
"""Share of the cloth that does not stand out from itself."""
PARTED_RADIUS_HAND_LENGTHS, CLOTH_RADIUS_HAND_LENGTHS, MIN_CLOTH_DISTANCE_HAND_LENGTHS = 1.2, 2.5, 0.3
"""Lengths of the hand from its middle: within the first, pixels are parted; within the second, cloth tells of its
colours. The third is how far cloth is from the template's hand, at least: the hand may be beside it."""
CUFF_LENGTH_HAND_LENGTHS = 0.3
"""Lengths of the hand by which a sleeve reaches beyond the wrist."""
MIN_CLOTH_LOG_LIKELIHOOD_RATIO = 3.0
"""By how much (a logarithm) a colour has to be likelier."""
MIN_NOT_SKIN_SHARE = 0.7
"""Share of the template's hand that is surely no skin where a hand is hidden."""
MIN_HUE_DISTANCE = 8.0
"""Distance of two hues (CIE Lab, 8 bits, without lightness) below which they say nothing."""
HAND_COLOUR_BLUR_PIXELS, CUFF_SHADOW_PIXELS = 1.0, 2
"""Pixels of the grid over which colours are taken together, and which part a hand from its cuff."""
FINGER_CLOSING_PIXELS = 7
"""Pixels between fingers that are closed: of a hidden hand they are together."""
SKIN_COLOUR_VARIANCE = 10.0
"""Variance by which a hand's skin differs from the face's."""


@dataclass(frozen=True)
class PartedHand:
    """What shows around a hand: the `arm`'s and the `cloth`'s pixels (h, w), and those where the hand is `hidden`."""

    arm: NDArray[np.bool_]
    cloth: NDArray[np.bool_]
    hidden: NDArray[np.bool_]


def template_hand(
    vertices: NDArray[np.floating], triangles: NDArray[np.integer], rig: Rig, arm: int, shape: tuple[int, int]
) -> NDArray[np.bool_]:
    """The pixels (h, w) of the template's hand, without what is before it. `vertices` (V, 3) in picture space."""
    side = SIDE_NAMES[ARM_LABELS.index(arm)]
    own = np.array([name.startswith(f"{side}Hand") for name in rig.names])[rig.bones[:, 0]]
    return side_maps(vertices, triangles[own[triangles].all(1)], shape, "front").mask


def parted(
    rgb: NDArray[np.uint8], labels: NDArray[np.integer], template: NDArray[np.bool_], hand: UnfoundHand
) -> PartedHand | None:
    """What the picture (h, w, 3) with its labels (h, w) says around one hand, which the `template` (h, w) has
    there. None where it says nothing.

    Of a hand that is seen the skin is the arm's. Of a hidden one what has the cloth's colours rather than the sleeve's is the
    cloth's, and beyond the cuff all that is not surely the sleeve's.
    """
    y, x = np.mgrid[: labels.shape[0], : labels.shape[1]]
    seen = template & (labels >= 0)
    if not seen.any():
        return None
    away = np.stack([x, y], -1) - [x[template].mean(), y[template].mean()]
    along = unit(hand.knuckles - hand.wrist)
    beyond = (np.stack([x, y], -1) - hand.wrist) @ along
    length = float(beyond[template].max())
    distance = np.linalg.norm(away, axis=-1)
    aside = distance_to(template)
    arm, worn = labels == hand.arm, np.isin(labels, [BODY_PARTS.index(f) for f in ("torso", "left_leg", "right_leg")])
    around = (distance < PARTED_RADIUS_HAND_LENGTHS * length) & (arm | worn)
    sleeve, cloth = (
        arm & (distance > PARTED_RADIUS_HAND_LENGTHS * length),
        worn & (distance < CLOTH_RADIUS_HAND_LENGTHS * length) & (aside > MIN_CLOTH_DISTANCE_HAND_LENGTHS * length),
    )
    if min(int(one.sum()) for one in (sleeve, cloth, around)) < MIN_MIXTURE_PIXELS:
        return None
    colours = rgb.astype(np.float64)
    of_cloth, of_sleeve = ColourMixture.fit(colours[cloth]), ColourMixture.fit(colours[sleeve])
    usual = np.quantile(of_cloth.negative_log_likelihood(colours[cloth]), PLAIN_CLOTH_SHARE)
    stands_out = float((of_cloth.negative_log_likelihood(colours[seen]) > usual).mean())
    cost = {
        "cloth": of_cloth.negative_log_likelihood(colours[around]),
        "sleeve": of_sleeve.negative_log_likelihood(colours[around]),
    }
    if len(hand.skin) >= MIN_MIXTURE_PIXELS and not _alike(hand.skin, rgb[cloth]):
        cost["skin"] = (
            ColourMixture.fit(hand.skin).widened(SKIN_COLOUR_VARIANCE).negative_log_likelihood(colours[around])
        )
        worn_cost = np.minimum(cost["cloth"], cost["sleeve"])
        like_skin = smoothed_map(worn_cost - cost["skin"], around, HAND_COLOUR_BLUR_PIXELS)
        if (like_skin < -MIN_CLOTH_LOG_LIKELIHOOD_RATIO)[
            seen
        ].mean() < MIN_NOT_SKIN_SHARE or stands_out > CLOTH_WITHOUT_SKIN_SHARE:
            return None if hand.before else _bare(like_skin, arm, around)
    elif hand.confidence > SEEN_FINGER_CONFIDENCE or stands_out > (
        CLOTH_WITHOUT_SKIN_SHARE if hand.confidence < UNSEEN_FINGER_CONFIDENCE else CLOTH_SHARE
    ):
        return None
    of_arm = np.minimum(cost["sleeve"], cost.get("skin", np.inf))
    sleeved = smoothed_map(cost["cloth"] - of_arm, around, HAND_COLOUR_BLUR_PIXELS)
    cloth = (
        arm
        & around
        & (
            sleeved
            < np.where(
                beyond > CUFF_LENGTH_HAND_LENGTHS * length,
                MIN_CLOTH_LOG_LIKELIHOOD_RATIO,
                -MIN_CLOTH_LOG_LIKELIHOOD_RATIO,
            )
        )
    )
    fingers = (
        cv2.morphologyEx(
            seen.astype(np.uint8), cv2.MORPH_CLOSE, np.ones((FINGER_CLOSING_PIXELS, FINGER_CLOSING_PIXELS), np.uint8)
        )
        > 0
    )
    return PartedHand(np.zeros_like(arm), cloth, fingers & (worn | cloth))


def _bare(like_skin: NDArray[np.float32], arm: NDArray[np.bool_], around: NDArray[np.bool_]) -> PartedHand:
    """A hand that is seen: what is like skin (h, w), joined with its arm (h, w) where both are `around` (h, w) its place."""
    bare = pieces_touching(around & (like_skin > 0), like_skin > MIN_CLOTH_LOG_LIKELIHOOD_RATIO)
    nothing = np.zeros_like(arm)
    return PartedHand(_joined(bare, arm) & around, nothing, nothing)


def with_hand_parted(labels: NDArray[np.intp], found: PartedHand, arm: int) -> NDArray[np.intp]:
    """Labels (h, w) in which an arm has what is its own, and the trunk and the legs what is theirs."""
    beneath = complete_labels(labels >= 0, np.where(np.isin(labels, ARM_LABELS), -1, labels))
    return np.where(found.arm, arm, np.where(found.cloth, beneath, labels))


def _alike(skin: NDArray[np.float64], cloth: NDArray[np.uint8]) -> bool:
    """Whether the hue of some skin (N, 3) is that of some cloth (M, 3), as in a picture without colours."""
    medians = np.stack([np.median(skin, axis=0), np.median(cloth, axis=0)]).astype(np.uint8)
    lab = cv2.cvtColor(medians[None], cv2.COLOR_RGB2LAB)[0].astype(np.float64)
    return bool(np.linalg.norm(lab[0, 1:] - lab[1, 1:]) < MIN_HUE_DISTANCE)


def _joined(bare: NDArray[np.bool_], arm: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """What is bare (h, w) with what parts it from its arm: the shadow in a cuff."""
    if not bare.any():
        return bare
    both = (
        cv2.morphologyEx(
            (bare | arm).astype(np.uint8), cv2.MORPH_CLOSE, np.ones((CUFF_SHADOW_PIXELS, CUFF_SHADOW_PIXELS), np.uint8)
        )
        > 0
    )
    near = dilate_mask(bare, CUFF_SHADOW_PIXELS)
    return np.asarray(bare | (both & near))
