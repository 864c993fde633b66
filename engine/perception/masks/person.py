"""The mask of the people in a picture, soft at hair and sharp at cloth, at the picture's own resolution.

Two networks look first (`engine.perception.masks.segmentation`). Where both are sure the matter is settled; elsewhere colours
have a say (GrabCut); and along the outline an alpha matte is solved (`engine.imaging.alpha.trimap`,
`engine.imaging.alpha.alpha_matte`).
"""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.imaging.alpha.alpha_matte import alpha_matte
from engine.imaging.alpha.guided_upsample import upsample_guided
from engine.imaging.alpha.trimap import CERTAIN_BELIEF, like_plain_background, outline_trimap
from engine.imaging.masks.colour_segmentation import grab_cut
from engine.imaging.masks.mask_pieces import pieces_touching
from engine.imaging.resample import resized, size_within
from engine.media.image import is_cut_out
from engine.perception.masks.figure import figure_on_plain_ground
from engine.perception.masks.matting_network import MattingModel
from engine.perception.masks.segmentation import MATTE_SIZE_PIXELS, Mask, people_confidence

CUT_SIDE_PIXELS = 480
"""Longest side at which colours have their say."""

KEPT_CONFIDENCE = 0.6
"""Belief from which a pixel stays with the person whatever its colour."""

DOUBTFUL_BELIEF = 0.35
"""Belief of what the networks may have missed: colours decide."""

LIKELY_BELIEF = 0.99
"""Belief of what joints tell to be a person's: settled, unless it has the colours of a plain background."""

EDGE_NEIGHBOURHOOD = np.ones((9, 9), np.uint8)
"""Of a picture that is a cut-out with alpha: the neighbourhood within which the mask that perception finds may end beside the edge of that alpha."""

MAX_LEFT_OUT_SHARE = 0.1
"""Share of what is known to be the person's that a matting model may leave out: fingers are thin, outlines differ."""


def person_mask(
    rgb: NDArray[np.uint8],
    seed: Mask | None = None,
    alpha: NDArray[np.uint8] | Mask | None = None,
    model: MattingModel | None = None,
    others: NDArray[np.bool_] | None = None,
    whole: bool = False,
    people: Mask | None = None,
) -> Mask:
    """Soft mask (H, W) in [0, 1] of the people in a picture; all zero where nobody is seen.

    Parameters
    ----------
    rgb : (H, W, 3) uint8.
    seed : (H, W) float32, 1 where a person is known to be (a face's region): helps in drawings, where
        the networks see little. `LIKELY_BELIEF` where joints that were found say so, which may be misplaced; `DOUBTFUL_BELIEF` where one may
        be, although the networks see nothing.
    alpha : (H, W), the picture's own alpha channel (uint8, or float in [0, 1]). Where it cuts something
        out it is taken as the truth, less the others; a channel that is opaque throughout says nothing.
    model : a matting network of the operator's (`engine.perception.models`), used instead of all that
        follows but the last step, the guided upsampling. Where it leaves out what the seed knows, what is found
        without it is added.
    others : (H, W), where other people are known to be, who do not belong to the mask. Of what the networks believe to
        be people, colours say whose it is.
    whole : the picture shows people whole, not portraits.
    people : what `people_confidence` said of the picture, if it was asked before.
    """
    if alpha is not None:
        channel = alpha.astype(np.float32) / np.float32(255 if alpha.dtype == np.uint8 else 1)
        if is_cut_out(channel):
            if others is None or not others.any():
                return channel
            return _within(channel, person_mask(rgb, seed, None, model, others, whole), others)
    if model is not None:
        found = upsample_guided(model(rgb), resized(np.ascontiguousarray(rgb), model.size), rgb)
        if others is not None:
            found = np.where(others, 0, found).astype(np.float32)
        surely = None if seed is None else seed > CERTAIN_BELIEF
        if surely is None or (surely & (found < 0.5)).sum() <= MAX_LEFT_OUT_SHARE * surely.sum():
            return found
        return np.maximum(found, person_mask(rgb, seed, None, None, others, whole))
    small = resized(np.ascontiguousarray(rgb), size_within(rgb.shape, MATTE_SIZE_PIXELS))
    belief = resized(people_confidence(rgb, whole) if people is None else people, (small.shape[1], small.shape[0]))
    sure = np.zeros(rgb.shape[:2], np.float32) if seed is None else seed.astype(np.float32)
    sure = resized(sure, (small.shape[1], small.shape[0])).copy()
    figure = figure_on_plain_ground(small, belief, sure > CERTAIN_BELIEF)
    if figure is not None:
        belief = figure
    misplaced = (belief < DOUBTFUL_BELIEF) & (sure > DOUBTFUL_BELIEF) & (sure < 1)
    if misplaced.any():
        sure[misplaced & like_plain_background(small, (belief < 1 - CERTAIN_BELIEF) & (sure == 0))] = DOUBTFUL_BELIEF
    belief = np.maximum(belief, sure)
    if others is not None:
        apart = resized(others.astype(np.float32), (small.shape[1], small.shape[0]))
        belief = np.asarray(belief * (1 - apart), np.float32)
    if figure is None:
        belief = settle_by_colour(small, belief)
    trimap = outline_trimap(small, belief)
    known = np.where(sure > CERTAIN_BELIEF, 1, trimap.known).astype(np.float32)
    matte = alpha_matte(small, known, trimap.prior, trimap.weight)
    return matte if small.shape == rgb.shape else upsample_guided(matte, small, rgb)


def _within(channel: Mask, found: Mask, others: NDArray[np.bool_]) -> Mask:
    """The part of a cut-out (H, W) that is the one person found in it. Where no others are, that is whole pieces of it;
    where somebody is connected with others, it is what was found. That ends somewhere near the cut-out's own edge,
    which is the truth: there it counts as it does a little further in."""
    shared = pieces_touching(channel > 0, others, connectivity=8)
    inside = cv2.erode((channel > CERTAIN_BELIEF).astype(np.uint8), EDGE_NEIGHBOURHOOD, borderValue=1)
    own = np.where(inside > 0, found, np.maximum(found, cv2.dilate(found * inside, EDGE_NEIGHBOURHOOD)))
    return np.where(shared, np.minimum(channel, own), channel).astype(np.float32)


def settle_by_colour(rgb: NDArray[np.uint8], belief: Mask) -> Mask:
    """The belief (H, W) averaged with what GrabCut makes of the colours where it is not sure; what the networks
    rather believe than not (grey hair before a pale wall), colours do not take away."""
    size = size_within(belief.shape, CUT_SIDE_PIXELS)
    small, rough = resized(rgb, size), resized(belief, size)
    foreground, background = rough > CERTAIN_BELIEF, rough < 1 - CERTAIN_BELIEF
    if not (foreground.any() and background.any()):
        return belief
    person = grab_cut(small, foreground, background, rough > 0.5, rounds=2).astype(np.float32)
    settled = (belief + resized(person, (belief.shape[1], belief.shape[0]))) / 2
    kept = np.where(belief > KEPT_CONFIDENCE, belief - KEPT_CONFIDENCE + 0.5, 0)
    return np.maximum(settled, kept).astype(np.float32)
