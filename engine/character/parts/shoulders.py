"""Shoulders at which colours say what is arm and what is trunk: where they are bare, or sleeves are another cloth than what is worn
over them.

Beyond the paper, whose labels are found by colours where limbs pass before others (section 4.2.1), and by shape elsewhere.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from engine.body.parts import BODY_PARTS
from engine.body.rig import Rig
from engine.character.fit.posed_template import PosedTemplate
from engine.character.parts.labels import ARM_LABELS
from engine.imaging.masks.colour_segmentation import MIN_MIXTURE_PIXELS, ColourMixture, ContrastGraph, colour_costs
from engine.imaging.masks.mask_distance import dilate_mask
from engine.imaging.masks.mask_pieces import pieces_touching

SHOULDER_RADIUS_METRES, TRUNK_SAMPLE_RADIUS_METRES = 0.13, 0.35
"""Metres around a shoulder in which labels may go by colours, and in which the trunk's are learned."""
MIN_LABEL_LOG_LIKELIHOOD_RATIO = 4.0
"""By how much a colour must be likelier of one than of the other, in units of equation 16."""
MIN_TRUNK_COLOURED_SHARE, MAX_TRUNK_COLOURED_ARM_SHARE = 0.8, 0.3
"""Share of the pixels whose colours must be one part's rather than the other's, and share of those labelled an arm that
may be of the trunk's colours: more are a sleeve's, cut from the cloth of the trunk."""


def labelled_shoulders(
    rgb: NDArray[np.uint8], labels: NDArray[np.integer], template: PosedTemplate, rig: Rig
) -> tuple[NDArray[np.intp], NDArray[np.bool_]]:
    """Labels (h, w) in which arm and trunk part at the shoulders where their colours do, and where that is (h, w). It
    is where nearly all colours of the picture `rgb` (h, w, 3) are either the arm's or the trunk's, as these are further
    away."""
    y, x = np.mgrid[: labels.shape[0], : labels.shape[1]]
    colours = rgb.astype(np.float64)
    out, plain = labels.astype(np.intp).copy(), np.zeros(labels.shape, np.bool_)
    torso = labels == BODY_PARTS.index("torso")
    joints = [template.joints[rig.index(f"{side}Arm")] for side in ("Left", "Right")]
    away = [np.hypot(x - joint[0], y - joint[1]) / template.pixels_per_metre for joint in joints]
    near = np.minimum(*away) < SHOULDER_RADIUS_METRES
    for arm, distance in zip(ARM_LABELS, away, strict=True):
        own = labels == arm
        here = (distance < SHOULDER_RADIUS_METRES) & (own | torso)
        learned = [colours[torso & ~near & (distance < TRUNK_SAMPLE_RADIUS_METRES)], colours[own & ~near]]
        if not here.any() or min(len(some) for some in learned) < MIN_MIXTURE_PIXELS:
            continue
        known = [ColourMixture.fit(some) for some in learned]
        known += _hair(colours[labels == BODY_PARTS.index("head")], known[1])
        costs = colour_costs(known, colours[here])
        likelier = costs[:, 0] - costs[:, 1]
        of_the_trunk = (likelier < 0) & own[here]
        if (
            abs(likelier) > MIN_LABEL_LOG_LIKELIHOOD_RATIO
        ).mean() > MIN_TRUNK_COLOURED_SHARE and of_the_trunk.sum() <= MAX_TRUNK_COLOURED_ARM_SHARE * own[here].sum():
            found = ContrastGraph.of(colours, here).cut(costs, costs.argmin(1))
            whole = out.copy()
            whole[here] = np.array([BODY_PARTS.index("torso"), arm, BODY_PARTS.index("head")])[found]
            # a neck is as bare as a shoulder
            astray = (whole == arm) & ~pieces_touching(whole == arm, (own & ~here) | dilate_mask(labels < 0, 1))
            out[here & ~astray] = whole[here & ~astray]
            plain |= here
    return out, plain


def _hair(head: NDArray[np.float64], arm: ColourMixture) -> list[ColourMixture]:
    """The colours of a head (N, 3) that are none of the `arm`'s: hair, where skin is bare. None where it has hardly any."""
    if len(head) < MIN_MIXTURE_PIXELS:
        return []
    likelier = arm.negative_log_likelihood(head) - ColourMixture.fit(head).negative_log_likelihood(head)
    hair = head[likelier > MIN_LABEL_LOG_LIKELIHOOD_RATIO]
    return [ColourMixture.fit(hair)] if len(hair) >= MIN_MIXTURE_PIXELS else []
