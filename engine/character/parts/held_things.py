"""What a hand holds, a ball, a bag, a basket: whole, and no part of the body.

Beyond the paper, whose labels (section 4.2.1) know body parts alone and give a ball half to the arm and half to the hip. What stands off
the template beside a hand is either held or cloth that hangs there. Cloth meets the body along its own length and has its colours; what is
held meets it at the hand.
"""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.body.rig import Rig
from engine.character.fit.posed_template import PosedTemplate
from engine.character.fit.template_maps import side_maps
from engine.character.parts.labels import ARM_LABELS, HEAD_LABEL, LEG_LABELS, TRUNK_LABEL
from engine.character.parts.pockets import template_hand
from engine.imaging.masks.colour_segmentation import (
    MIN_MIXTURE_PIXELS,
    UNSEEDED_MARK,
    ColourMixture,
    ContrastGraph,
    colour_costs,
)
from engine.imaging.masks.mask_distance import dilate_mask, distance_inside, distance_to
from engine.imaging.masks.mask_pieces import pieces_by_area, pieces_touching

MIN_HELD_DISTANCE_PIXELS, MAX_HAND_DISTANCE_PIXELS = 7.0, 14.0
"""Pixels of the grid that a pixel is away from the template, at least, to be surely none of its; and from the template's hand to the nearest of
such pixels, at most, for it to hold them."""
MIN_HELD_PIXELS = 120
"""Pixels that are surely none of the template's, of a thing that is looked for."""
BODY_COLOUR_RADIUS_PIXELS = 80
"""Pixels around a thing within which the body's colours are learned."""
BODY_INSET_PIXELS, HAND_MARGIN_PIXELS = 4.0, 5
"""Pixels within the template's outline from which on it is surely there, and around its hand in which nothing is sure."""
HELD_COLOUR_VARIANCE = 30.0
"""Variance, levels squared, by which one matter's colours differ with the light."""
MIN_HELD_LOG_LIKELIHOOD_RATIO = 1.5
"""By how much (a logarithm) the median of a thing's pixels is likelier of its own colours than of the body's around it."""
TEMPLATE_COST = 1.0
"""What it costs, beside negative logarithms of densities, where the template is in place of a thing."""
GROWTH_MARGIN_PIXELS = 8.0
"""Pixels by which a thing may reach further than its own size beyond what is surely none of the template's."""
MAX_MEETING_SHARE = 0.27
"""Share of a thing's rim at which trunk or legs are, from which on it hangs from them."""


def held_things(
    rgb: NDArray[np.uint8], labels: NDArray[np.integer], template: PosedTemplate, rig: Rig
) -> NDArray[np.int8]:
    """The arm (h, w) whose hand holds what each pixel shows, an index of `BODY_PARTS`; -1 where nothing is held.

    rgb : (h, w, 3), the picture on the grid.
    labels : (h, w), which part each pixel shows, -1 outside the person.
    """
    shape = (labels.shape[0], labels.shape[1])
    body = side_maps(template.vertices, template.triangles, shape, "front").mask
    hands = {arm: template_hand(template.vertices, template.triangles, rig, arm, shape) for arm in ARM_LABELS}
    away = {arm: distance_to(hand) for arm, hand in hands.items() if hand.any()}
    found = np.full(shape, -1, np.int8)
    off = (labels >= 0) & (labels != HEAD_LABEL) & (distance_to(body) > MIN_HELD_DISTANCE_PIXELS)
    for piece in pieces_by_area(_opened(off), MIN_HELD_PIXELS, connectivity=8):
        nearest = {arm: float(distance[piece].min()) for arm, distance in away.items()}
        arm = min(nearest, key=lambda one: nearest[one], default=None)
        if arm is not None and nearest[arm] < MAX_HAND_DISTANCE_PIXELS:
            thing = _whole(rgb.astype(np.float64), labels, body, hands[arm], piece)
            if thing is not None:
                found[thing] = arm
    return found


def _whole(
    colours: NDArray[np.float64],
    labels: NDArray[np.integer],
    body: NDArray[np.bool_],
    hand: NDArray[np.bool_],
    piece: NDArray[np.bool_],
) -> NDArray[np.bool_] | None:
    """All of the thing (h, w) of which a `piece` (h, w) stands off the body, to where colours change; None if it hangs from the body."""
    around = dilate_mask(hand, HAND_MARGIN_PIXELS)
    sure = (labels >= 0) & (distance_inside(body) > BODY_INSET_PIXELS) & ~around
    from_piece = distance_to(piece)
    near = sure & (from_piece < BODY_COLOUR_RADIUS_PIXELS)
    if near.sum() < MIN_MIXTURE_PIXELS:
        return None
    of_body, of_thing = (ColourMixture.fit(colours[area]).widened(HELD_COLOUR_VARIANCE) for area in (near, piece))
    costs = colour_costs([of_body, of_thing], colours[piece])
    if np.median(costs[:, 0] - costs[:, 1]) < MIN_HELD_LOG_LIKELIHOOD_RATIO:
        return None
    reach = float(np.sqrt(piece.sum())) + GROWTH_MARGIN_PIXELS
    window = (labels >= 0) & (from_piece < reach + 2)
    costs = colour_costs([of_body, of_thing], colours[window])
    costs[:, 1] += TEMPLATE_COST * sure[window]
    not_it = (from_piece >= reach) | (sure & np.isin(labels, ARM_LABELS))
    seeds = np.where(piece[window], 1, np.where(not_it[window], 0, UNSEEDED_MARK))
    thing = np.zeros(labels.shape, np.bool_)
    thing[window] = ContrastGraph.of(colours, window).cut(costs, (costs[:, 1] < costs[:, 0]).astype(int), seeds) == 1
    thing = pieces_touching(thing, piece)
    rim = dilate_mask(thing, 2) & ~thing
    meets = rim & np.isin(labels, (TRUNK_LABEL, *LEG_LABELS)) & ~around
    return thing if meets.sum() < MAX_MEETING_SHARE * rim.sum() else None


def _opened(mask: NDArray[np.bool_]) -> NDArray[np.bool_]:
    return np.asarray(cv2.morphologyEx(mask.astype(np.uint8), cv2.MORPH_OPEN, np.ones((3, 3), np.uint8)) > 0)
