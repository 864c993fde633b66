"""Hair that a raised arm passes before: the head's, though the arm is nearer and may cut it in two."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from engine.body.parts import BODY_PARTS
from engine.character.parts.labels import ARM_LABELS, MIN_LABEL_PIECE_PIXELS
from engine.imaging.masks.colour_segmentation import MIN_MIXTURE_PIXELS, ColourMixture, log_likelihood_ratio
from engine.imaging.masks.mask_distance import dilate_mask
from engine.imaging.masks.mask_pieces import pieces_touching, without_small_pieces

ARM_OUTLINE_TOLERANCE_SHARE = 0.008
"""How far around the template's outline an arm's may be, as a share of the height."""
MIN_HAIR_LOG_LIKELIHOOD_RATIO = 3.0
"""By how much likelier hair must be where the template has its arm (logarithms of probabilities)."""
PASSING_ARM_WIDTH_SHARE = 0.05
"""How wide an arm is that passes before hair, as a share of the height."""
HAIR_LIKELIHOOD_PERCENTILE, MIN_NOT_HAIR_SHARE = 98.0, 0.4
"""Percent of hair whose colours say what may be hair; share of an arm that may not be, at least, to be told from hair."""
LIKELIHOOD_BLUR_PIXELS = 2.0
"""Pixels over which likelihoods are averaged."""


def hair_behind_arms(
    rgb: NDArray[np.uint8], labels: NDArray[np.integer], template: NDArray[np.integer], sure: NDArray[np.integer]
) -> NDArray[np.intp]:
    """Labels (H, W) in which the hair that a raised arm passes before is the head's. Such pieces lie above the chin and
    are not `sure` (H, W) to be the arm. They have the colours of hair rather than of the arm, and would hang together
    with the head if the arm were not before it. `template` (H, W): the projected template's labels."""
    found = labels.astype(np.intp).copy()
    head = BODY_PARTS.index("head")
    hair = (labels == head) & (template != head)
    if hair.sum() < MIN_MIXTURE_PIXELS or not (template == head).any():
        return found
    chin = int(np.flatnonzero((template == head).any(1))[-1])
    colours = rgb.astype(np.float64)
    of_hair = ColourMixture.fit(colours[hair])
    hairy = float(np.percentile(of_hair.negative_log_likelihood(colours[hair]), HAIR_LIKELIHOOD_PERCENTILE))
    for arm in ARM_LABELS:
        inner = (labels == arm) & ~_grown_by_share(template != arm, ARM_OUTLINE_TOLERANCE_SHARE)
        bare = inner.copy()
        bare[inner] = of_hair.negative_log_likelihood(colours[inner]) > hairy
        doubtful = (labels == arm) & (sure != arm)
        doubtful[chin:] = False
        if (
            bare.sum() < max(MIN_MIXTURE_PIXELS, MIN_NOT_HAIR_SHARE * inner.sum())
            or doubtful.sum() < MIN_LABEL_PIECE_PIXELS
        ):
            continue
        likelier = log_likelihood_ratio(
            colours, doubtful, of_hair, ColourMixture.fit(colours[bare]), LIKELIHOOD_BLUR_PIXELS
        )
        clear = np.where(
            _grown_by_share(template == arm, ARM_OUTLINE_TOLERANCE_SHARE), MIN_HAIR_LOG_LIKELIHOOD_RATIO, 0
        )
        given = doubtful & (likelier > clear)
        near = _grown_by_share(labels == head, PASSING_ARM_WIDTH_SHARE)
        found[pieces_touching(without_small_pieces(given, MIN_LABEL_PIECE_PIXELS), near)] = head
    return found


def _grown_by_share(mask: NDArray[np.bool_], share: float) -> NDArray[np.bool_]:
    """A mask (H, W) grown by a share of its height."""
    return dilate_mask(mask, max(1, round(share * mask.shape[0])))
