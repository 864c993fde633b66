"""Which pixels show hair, a hat or a hood: what is beside a face and is no skin, and what of it falls down the body."""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.character.figure.face_region import within_oval
from engine.imaging.masks.colour_segmentation import (
    MIN_MIXTURE_PIXELS,
    UNSEEDED_MARK,
    ColourMixture,
    ContrastGraph,
    colour_costs,
)
from engine.imaging.masks.mask_distance import dilate_mask, distance_to
from engine.imaging.masks.mask_pieces import mask_height, pieces_touching, without_small_pieces

MOUTH_DEPTH_SHARE = 0.35
"""How far below a face's middle, as a share of half its height, what is narrow may be a collar."""
MIN_LOCK_SHARE = 0.12
"""Half the width of a lock of hair at least, as a share of half a face's width: a collar's edge is narrower."""
SURELY_HAIR_SHARE = 0.06
"""How far off the template's head and neck, as a share of their height, whatever is the head's is hair: ears are nearer."""
LOOSE_HAIR_PIXELS, MIN_HAIR_PIECE_PIXELS = 2, 30
"""Pixels of the grid off the template's head from which on hair is loose, and of a piece of hair."""
FACE_SHARE, SKIN_SHARE = 0.92, 0.7
"""Share of a face's oval in which nothing is hair, and of that from which the colours of skin are learned."""
BROW_HEIGHT_SHARE = 0.25
"""How far above a face's middle, as a share of half its height, whatever is beside it is hair: there are no ears."""
FOREHEAD_SHARE = 1.05
"""How far above a face's middle its forehead ends at the latest, as a share of half its height: beyond is hair or a hat."""
MAX_SKIN_DISTANCE_LEVELS = 60.0
"""Levels from the face's median up to which a colour may be skin's."""
MAX_FAIR_SHARE = 0.2
"""Share of what is beside the template's head that may have the face's colours, for hair to be told from skin by its colour alone."""
HAIR, SKIN = 0, 1
"""What pixels of a head are told to be."""
SEGMENTATION_ROUNDS, UNUSUAL_COST = 3, 2.0
"""How often mixtures and pixels are found anew from one another, and what skin costs above the brow beside the face, beside negative logarithms
of densities."""
THROAT_SHARE = 0.4
"""Share of half a face's width to both sides of its middle in which no hair falls down the body."""
MAX_ALIKE_SHARE, MAX_FALLEN_SHARE = 0.15, 2.0
"""Share of the body's pixels that may as well be hair, beyond which nothing tells them apart; and how much hair may lie on the body, as a share of the rest.
"""
HAIR_COLOUR_VARIANCE = 20.0
"""Variance, levels squared, by which its colours differ with the light."""


def hair_beside_the_face(
    rgb: NDArray[np.uint8], head: NDArray[np.bool_], covered: NDArray[np.bool_], face: NDArray[np.floating]
) -> NDArray[np.bool_]:
    """The pixels (h, w) of a picture (h, w, 3) that show hair, a hat or a hood: what is labelled as the `head`'s, is outside of the oval of its
    `face`, and above the brow or no skin. `covered` (h, w): by the template's head; what is loose beside that has the colours of hair."""
    loose = head & ~dilate_mask(covered, LOOSE_HAIR_PIXELS)
    oval, inner = (within_oval(face * [1, 1, share, share, 1], head.shape) for share in (FACE_SHARE, SKIN_SHARE))
    if min(int(loose.sum()), int((inner & head).sum())) < MIN_MIXTURE_PIXELS:
        return np.zeros_like(head)
    colours = rgb.astype(np.float64)
    like_skin = np.abs(colours - np.median(colours[inner & head], 0)).max(-1) < MAX_SKIN_DISTANCE_LEVELS
    above_the_brow = np.arange(len(head))[:, None] < face[1] - BROW_HEIGHT_SHARE * face[3]
    graph, pixels = ContrastGraph.of(colours, head), colours[head]
    surely = (loose & ~like_skin) | (head & (distance_to(covered) > SURELY_HAIR_SHARE * mask_height(covered)))
    surely |= head & (np.arange(len(head))[:, None] < face[1] - FOREHEAD_SHARE * face[3])
    seeds = np.where((inner & like_skin)[head], SKIN, np.where(surely[head], HAIR, UNSEEDED_MARK))
    fair = like_skin[head & ~covered].mean() > MAX_FAIR_SHARE
    above_the_brow = above_the_brow & ~oval & fair  # hair of the skin's colours is where there is no face
    more = np.stack([0 * pixels[:, 0], UNUSUAL_COST * above_the_brow[head]], 1)
    found = np.where((oval | (like_skin & ~above_the_brow))[head], SKIN, HAIR)
    for _ in range(SEGMENTATION_ROUNDS):
        shown = [pixels[found == kind] for kind in (HAIR, SKIN)]
        if min(len(own) for own in shown) < MIN_MIXTURE_PIXELS:
            return np.zeros_like(head)
        mixtures = [ColourMixture.fit(own).widened(HAIR_COLOUR_VARIANCE) for own in shown]
        found = graph.cut(colour_costs(mixtures, pixels) + more, found, seeds)
    hair = np.zeros_like(head)
    hair[head] = found == HAIR
    radius = max(1, round(MIN_LOCK_SHARE * float(face[2])))
    disk = cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (2 * radius + 1, 2 * radius + 1))
    locks = cv2.morphologyEx((hair & ~oval).astype(np.uint8), cv2.MORPH_OPEN, disk) > 0
    beside = np.arange(len(head))[:, None] < face[1] + MOUTH_DEPTH_SHARE * face[3]
    locks |= hair & ~oval & beside
    return pieces_touching(
        pieces_touching(without_small_pieces(locks, MIN_HAIR_PIECE_PIXELS), loose), locks & beside
    )  # none begins below


def hair_on_the_shoulders(
    rgb: NDArray[np.uint8],
    hair: NDArray[np.bool_],
    body: NDArray[np.bool_],
    face: NDArray[np.floating],
    reach: float,
) -> NDArray[np.bool_]:
    """The pixels (h, w) of a picture (h, w, 3) at which `hair` (h, w) goes on down over the `body` (h, w), within so many pixels and on both
    sides of the throat below the `face`; none where its colours are the body's."""
    throat = np.abs(np.arange(hair.shape[1])[None] - face[0]) < THROAT_SHARE * face[2]
    window = body & (distance_to(hair) < reach) & ~throat
    nothing = np.zeros_like(hair)
    if min(int(window.sum()), int(hair.sum())) < MIN_MIXTURE_PIXELS:
        return nothing
    colours = rgb.astype(np.float64)
    of_hair = ColourMixture.fit(colours[hair]).widened(HAIR_COLOUR_VARIANCE)
    own = hair | window
    graph, pixels = ContrastGraph.of(colours, own), colours[own]
    seeds = np.where(hair[own], HAIR, UNSEEDED_MARK)
    others = window
    for _ in range(SEGMENTATION_ROUNDS):
        of_body = ColourMixture.fit(colours[others]).widened(HAIR_COLOUR_VARIANCE)
        costs = colour_costs([of_hair, of_body], pixels)
        found = nothing.copy()
        found[own] = graph.cut(costs, (costs[:, 0] > costs[:, 1]).astype(int), seeds) == HAIR
        others = window & ~found
        if others.sum() < MIN_MIXTURE_PIXELS:
            return nothing
    if (
        of_hair.negative_log_likelihood(colours[others]) < of_body.negative_log_likelihood(colours[others])
    ).mean() > MAX_ALIKE_SHARE:
        return nothing
    fallen = _hanging(found, hair) & window
    return np.asarray(fallen if fallen.sum() < MAX_FALLEN_SHARE * hair.sum() else nothing)


def _hanging(found: NDArray[np.bool_], hair: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """What of pixels (h, w) hangs from `hair` (h, w): each has some above it, a pixel aside at most."""
    hangs = hair.copy()
    for row in range(1, len(hair)):
        above = hangs[row - 1]
        beneath = above.copy()
        beneath[1:] |= above[:-1]
        beneath[:-1] |= above[1:]
        hangs[row] |= found[row] & beneath
    return hangs
