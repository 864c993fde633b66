"""Whose pixels beside a border of two parts are, by the colours within both.

Labels come from the template first, and a border that is drawn through a hand or a sleeve gives some of it to what is behind: it is
relabelled. What is left about borders is neither's: mixed pixels, the shadow of a hand on a thigh, the wall between two legs. Seen, it
passes; left behind on the thigh when the hand is gone, it is a scar.
"""

from __future__ import annotations

import cv2
import numpy as np
from numba import prange
from numpy.typing import NDArray

from engine.character.parts.labels import ARM_LABELS, LEG_LABELS, TRUNK_LABEL
from engine.compiled import njit
from engine.imaging.masks.mask_distance import dilate_mask, distance_inside, distance_to
from engine.imaging.masks.mask_pieces import pieces_touching

OWN, LIKE_THE_OTHER, LIKE_NEITHER = 0, 1, 2
"""What is said of a pixel's colour."""
BAND_PIXELS, BAND_THICKNESS_SHARE = 8.0, 0.45
"""How far from another part a pixel is looked at: pixels of the grid, and as a share of half of the part's own thickness there, whichever is less."""
THICKNESS_WINDOW_PIXELS = 21
"""Pixels of the window in which a part's thickness is taken."""
COLOUR_SEARCH_RADIUS_PIXELS, COLOUR_SEARCH_STEP_PIXELS = 16, 2
"""How far around a pixel its part is looked at for a colour like its own, and every how many pixels."""
MAX_COLOUR_DISTANCE = 12.0
"""CIE Lab distance up to which two colours are alike."""
MIN_ALIKE_SHARE = 0.05
"""Share of its part's inside around it that has a pixel's colour, at least."""
MIN_SHADOW_DEPTH, MIN_MIXED_SHARE = 6.0, 0.25
"""CIE lightness by which a shadow is darker than its part's darkest; share of another's colour in a mixture that is no more its part's."""
MAX_RELABELLING_ROUNDS = 6
"""Times that borders are looked at anew: what is held may reach further than one look."""
MIXED_COLOUR_PIXELS, EVENED_PIXELS = 2, 3
"""Pixels from a border in which colours of both parts are mixed, and around what was relabelled in which the border is smoothed."""
SMOOTHING_SIGMA_PIXELS = 0.8
"""Pixels over which colours are smoothed before they are compared."""


def owned_by_colour(rgb: NDArray[np.uint8], labels: NDArray[np.int8]) -> NDArray[np.int8]:
    """Labels (h, w) of a picture (h, w, 3) in which pixels beside an arm that are the arm's by their colours are labelled so, and pixels of an arm
    beside trunk or leg that are theirs."""
    lab, found = _smooth_lab(rgb), labels.copy()
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
    beside = _beside(owner, there)
    if beside.any():
        within = there & (distance_to(owner) > MIXED_COLOUR_PIXELS)
        like = _judged(lab, beside, owner & ~beside, within) == LIKE_THE_OTHER
        moved = pieces_touching(like | there, there) & like
        labels[moved] = other
        _evened(labels, own, other, dilate_mask(moved, EVENED_PIXELS))


def _evened(labels: NDArray[np.int8], one: int, other: int, where: NDArray[np.bool_]) -> None:
    """Smooth the border of two parts `where` (h, w), in place."""
    shares = [cv2.GaussianBlur((labels == part).astype(np.float32), (0, 0), EVENED_PIXELS / 2) for part in (one, other)]
    both = where & np.isin(labels, (one, other))
    labels[both] = np.where(shares[0] >= shares[1], one, other)[both]


def strange_colours(rgb: NDArray[np.uint8], labels: NDArray[np.integer]) -> NDArray[np.bool_]:
    """The pixels (h, w) of a picture (h, w, 3) whose colours are not those of their part in `labels` (h, w). They are
    close to a limb that is not theirs, or of a limb and close to what is not its. No colour of their part's inside is
    around them. Theirs is one of what is beside it, a mixture of both, or a darker one: the print on a shirt has none
    of these. Where a part has no inside nearby nothing is said; nor of heads, nor where legs come out of the trunk: a
    hem and a belt are seen always."""
    lab = _smooth_lab(rgb)
    found = np.zeros(labels.shape, np.bool_)
    for part in (TRUNK_LABEL, *ARM_LABELS, *LEG_LABELS):
        own = labels == part
        others = (labels >= 0) & ~own
        if part not in ARM_LABELS:
            others = np.isin(labels, [limb for limb in (*ARM_LABELS, *LEG_LABELS) if limb != part])
        if part == TRUNK_LABEL:
            others = np.isin(labels, ARM_LABELS)
        beside = _beside(own, others)
        if beside.any():
            found |= _judged(lab, beside, own & ~beside, ~own) != OWN
    return found


def _smooth_lab(rgb: NDArray[np.uint8]) -> NDArray[np.float32]:
    smooth = cv2.GaussianBlur(rgb, (0, 0), SMOOTHING_SIGMA_PIXELS).astype(np.float32) / 255
    return np.asarray(cv2.cvtColor(smooth, cv2.COLOR_RGB2LAB), np.float32)


def _beside(own: NDArray[np.bool_], others: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """The pixels (h, w) of a part that are so near to others that they may be theirs."""
    if not own.any() or not others.any():
        return np.zeros_like(own)
    window = cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (THICKNESS_WINDOW_PIXELS, THICKNESS_WINDOW_PIXELS))
    half = cv2.dilate(distance_inside(own), window)
    return np.asarray(own & (distance_to(others) <= np.minimum(BAND_PIXELS, BAND_THICKNESS_SHARE * half)))


@njit(parallel=True, boundscheck=False, error_model="numpy")
def _judged(lab: np.ndarray, asked: np.ndarray, inside: np.ndarray, beyond: np.ndarray) -> np.ndarray:
    """Whether pixels (h, w) of those `asked` for are like what is `inside`, like what is `beyond`, or a mixture of both or darker than all."""
    height, width = asked.shape
    found = np.zeros((height, width), np.uint8)
    for y in prange(height):
        for x in range(width):
            if not asked[y, x]:
                continue
            own, own_alike, own_darker, other, other_alike = 0, 0, 0, 0, 0
            own_mean, other_mean = np.zeros(3, np.float32), np.zeros(3, np.float32)
            for v in range(
                max(y - COLOUR_SEARCH_RADIUS_PIXELS, 0),
                min(y + COLOUR_SEARCH_RADIUS_PIXELS + 1, height),
                COLOUR_SEARCH_STEP_PIXELS,
            ):
                for u in range(
                    max(x - COLOUR_SEARCH_RADIUS_PIXELS, 0),
                    min(x + COLOUR_SEARCH_RADIUS_PIXELS + 1, width),
                    COLOUR_SEARCH_STEP_PIXELS,
                ):
                    if not (inside[v, u] or beyond[v, u]):
                        continue
                    apart = np.float32(0)
                    for k in range(3):
                        apart += (lab[y, x, k] - lab[v, u, k]) ** 2
                    if inside[v, u]:
                        own += 1
                        own_alike += int(apart < MAX_COLOUR_DISTANCE**2)
                        own_darker += int(lab[v, u, 0] < lab[y, x, 0] + MIN_SHADOW_DEPTH)
                        for k in range(3):
                            own_mean[k] += lab[v, u, k]
                    else:
                        other += 1
                        other_alike += int(apart < MAX_COLOUR_DISTANCE**2)
                        for k in range(3):
                            other_mean[k] += lab[v, u, k]
            if own_alike >= MIN_ALIKE_SHARE * own or other == 0:
                continue
            between, length = np.float32(0), np.float32(1e-6)
            for k in range(3):
                own_mean[k] /= own
                other_mean[k] = other_mean[k] / other - own_mean[k]
                between += (lab[y, x, k] - own_mean[k]) * other_mean[k]
                length += other_mean[k] ** 2
            share = min(max(between / length, np.float32(0)), np.float32(1))
            off = np.float32(0)
            for k in range(3):
                off += (lab[y, x, k] - own_mean[k] - share * other_mean[k]) ** 2
            if other_alike >= MIN_ALIKE_SHARE * other:
                found[y, x] = LIKE_THE_OTHER
            elif own_darker <= MIN_ALIKE_SHARE * own or (off < MAX_COLOUR_DISTANCE**2 and share > MIN_MIXED_SHARE):
                found[y, x] = LIKE_NEITHER
    return found
