"""Whose pixels beside a border of two parts are, by the colours within both.

Labels come from the template first, and a border that is drawn through a hand or a sleeve gives some of it to what is
behind: it is relabelled. What is neither's is left to `engine.character.parts.strange_colours`.
"""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.character.parts.border_colours import LIKE_THE_OTHER, judged_colours, pixels_beside, smoothed_lab
from engine.character.parts.labels import ARM_LABELS, LEG_LABELS, TRUNK_LABEL
from engine.imaging.masks.mask_distance import dilate_mask, distance_to
from engine.imaging.masks.mask_pieces import pieces_touching

MAX_RELABELLING_ROUNDS = 6
"""Times that borders are looked at anew: what is held may reach further than one look."""
MIXED_COLOUR_PIXELS, EVENED_PIXELS = 2, 3
"""Pixels from a border in which colours of both parts are mixed, and around what was relabelled in which the border is smoothed."""


def owned_by_colour(rgb: NDArray[np.uint8], labels: NDArray[np.int8]) -> NDArray[np.int8]:
    """Labels (h, w) of a picture (h, w, 3) in which pixels beside an arm that are the arm's by their colours are labelled so, and pixels of an arm
    beside trunk or leg that are theirs."""
    lab, found = smoothed_lab(rgb), labels.copy()
    for _ in range(MAX_RELABELLING_ROUNDS):
        before = found.copy()
        for arm in ARM_LABELS:
            for body in (TRUNK_LABEL, *LEG_LABELS):
                _owned(lab, found, body, arm)
                _owned(lab, found, arm, body)
        if (found == before).all():
            break
    return found


def _owned(lab: NDArray[np.float32], labels: NDArray[np.int8], own: int, other: int) -> None:
    """Label pixels of a part that are another's by their colours so (h, w), in place: what is within reach of the border, and touches it."""
    owner, there = labels == own, labels == other
    beside = pixels_beside(owner, there)
    if beside.any():
        within = there & (distance_to(owner) > MIXED_COLOUR_PIXELS)
        like = judged_colours(lab, beside, owner & ~beside, within) == LIKE_THE_OTHER
        moved = pieces_touching(like | there, there) & like
        labels[moved] = other
        _evened(labels, own, other, dilate_mask(moved, EVENED_PIXELS))


def _evened(labels: NDArray[np.int8], one: int, other: int, where: NDArray[np.bool_]) -> None:
    """Smooth the border of two parts `where` (h, w), in place."""
    shares = [cv2.GaussianBlur((labels == part).astype(np.float32), (0, 0), EVENED_PIXELS / 2) for part in (one, other)]
    both = where & np.isin(labels, (one, other))
    labels[both] = np.where(shares[0] >= shares[1], one, other)[both]
