"""Which part of the body each pixel shows: the paper's body label map (section 4.2.1, equations 12 to 19)."""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.body.parts import BODY_PARTS
from engine.geometry.graph_cut import alpha_expansion, grid_edges
from engine.imaging.masks.colour_segmentation import (
    MIN_MIXTURE_PIXELS,
    UNSEEDED_MARK,
    ColourMixture,
    ContrastGraph,
    colour_costs,
    log_likelihood_ratio,
)
from engine.imaging.masks.mask_distance import dilate_mask, distance_to
from engine.imaging.masks.mask_pieces import pieces_touching

HEAD_LABEL, TRUNK_LABEL = BODY_PARTS.index("head"), BODY_PARTS.index("torso")
ARM_LABELS = (BODY_PARTS.index("left_arm"), BODY_PARTS.index("right_arm"))
LEG_LABELS = (BODY_PARTS.index("left_leg"), BODY_PARTS.index("right_leg"))
OPPOSITE_LABEL = {one: other for pair in (ARM_LABELS, LEG_LABELS) for one, other in (pair, pair[::-1])}
"""The limb of the other side."""
MIN_LIMB_PIXELS = 50
"""Pixels of a limb that is worth being a part of its own."""

ROUGH_HEIGHT_PIXELS = 160
"""Pixels of height at which labels are found first."""
ROUGH_SMOOTHNESS_WEIGHT = 16.0
"""How much neighbours agree at first: the paper's value."""
SMOOTHNESS_HEIGHT_PIXELS = 640
"""Pixels of height for which it is taken to be meant: costs of areas grow with the cube of the size, those
of borders with the size itself."""
LABELLING_ROUNDS = 3
"""How often mixtures and labels are found anew from one another."""
SLEEVE_REACH_SHARE, BEYOND_SLEEVE_COST = 0.04, 2.0
"""How far sleeves reach beyond the template's arms, as a share of the height, and by how much more than its distance a pixel
further away is unlikely to be an arm's."""
BORDER_SMOOTHING_PIXELS = 0.7
"""Pixels of the small labels over which their borders are smoothed."""
MIN_LABEL_PIECE_PIXELS = 40
"""Pixels below which a piece of a label is an error of the colours' model: a crease, a cuff, a shadow."""
MIN_SECOND_PIECE_SHARE = 0.25
"""Share of an arm's largest piece below which another one is not the arm's."""
BARE_ARM_MARGIN_SHARE = 0.008
"""How far beyond the template's arm no hair is looked for, as a share of the height."""
STRAY_PIXEL_COST = 0.25
"""What a pixel that the template covers costs with the label of a part of it that is one pixel away, in units of
equation 16. It is too little where colours differ, as those of hand and trousers. The colours of a sleeve and of the
trunk beside it say nothing."""
UNSHOWN_LABEL_COST_PIXELS = 1e3
"""The cost, in pixels, of a label that the template does not show."""


def rough_labels(mask: NDArray[np.bool_], template: NDArray[np.integer]) -> NDArray[np.intp]:
    """L_init: labels (H, W), -1 outside `mask`, that resemble the projected template's (`template` (H, W), -1 where
    it is not) in shape and hang together. Equations 12 to 14, found at `ROUGH_HEIGHT_PIXELS`."""
    height, width = mask.shape
    factor = min(1.0, ROUGH_HEIGHT_PIXELS / height)
    size = (max(1, round(width * factor)), max(1, round(height * factor)))
    small = cv2.resize(mask.astype(np.uint8), size, interpolation=cv2.INTER_NEAREST_EXACT) > 0
    seen = cv2.resize(template.astype(np.int16), size, interpolation=cv2.INTER_NEAREST_EXACT)
    unary = np.stack([_distance_to(seen == label)[small] for label in range(len(BODY_PARTS))], 1)  # equation 13
    for arm in ARM_LABELS:  # sleeves are wider than arms, but not as wide as the skirt beside one
        unary[:, arm] += BEYOND_SLEEVE_COST * np.maximum(unary[:, arm] - SLEEVE_REACH_SHARE * size[1], 0)
    edges, _ = grid_edges(small)
    gamma = ROUGH_SMOOTHNESS_WEIGHT * (size[1] / SMOOTHNESS_HEIGHT_PIXELS) ** 2
    found = np.full(small.shape, -1, np.intp)
    found[small] = alpha_expansion(unary, edges, np.full(len(edges), gamma), unary.argmin(1))
    return _enlarged(complete_labels(np.ones_like(small), found), mask)


def _enlarged(labels: NDArray[np.intp], mask: NDArray[np.bool_]) -> NDArray[np.intp]:
    """Labels (h, w) at the size of the mask (H, W), -1 outside of it, without the steps that their pixels would make there."""
    size = (mask.shape[1], mask.shape[0])
    around = BORDER_SMOOTHING_PIXELS * mask.shape[0] / labels.shape[0]
    likely = []
    for label in range(len(BODY_PARTS)):
        large = cv2.resize((labels == label).astype(np.float32), size, interpolation=cv2.INTER_LINEAR)
        likely.append(cv2.GaussianBlur(large, (0, 0), around))
    return np.where(mask, np.stack(likely).argmax(0), -1)


def complete_labels(mask: NDArray[np.bool_], labels: NDArray[np.integer]) -> NDArray[np.intp]:
    """Labels (H, W) for all of `mask` and nothing else: where one is missing it is the nearest."""
    out = labels.astype(np.intp)
    missing = mask & (out < 0)
    out[missing] = _nearest_label(out)[missing]
    return np.where(mask, out, -1)


def hair_beside_arms(
    rgb: NDArray[np.uint8], labels: NDArray[np.integer], template: NDArray[np.integer], sure: NDArray[np.integer]
) -> NDArray[np.intp]:
    """Labels (H, W) in which hair is the head's where a raised arm is nearer. Such pixels are not of the arms of the
    projected `template` (H, W), and not `sure` (H, W). They have the colours of hair rather than those of the arm, and
    hang together with the head."""
    found = labels.astype(np.intp).copy()
    head = BODY_PARTS.index("head")
    colours = rgb.astype(np.float64)
    hair = (labels == head) & (template != head)
    for arm in ARM_LABELS:
        own = labels == arm
        close = dilate_mask(template == arm, max(1, round(BARE_ARM_MARGIN_SHARE * labels.shape[0])))
        doubtful = own & ~close & (sure != arm)
        if min(int(one.sum()) for one in (hair, doubtful, own & close)) < MIN_MIXTURE_PIXELS:
            continue
        of_arm, of_hair = (ColourMixture.fit(colours[area]) for area in (own & close, hair))
        given = doubtful & (log_likelihood_ratio(colours, doubtful, of_hair, of_arm, 2.0) > 0)
        found[given & pieces_touching(given | (labels == head), labels == head)] = head
    return found


def without_specks(
    labels: NDArray[np.integer], sure: NDArray[np.integer], plain: NDArray[np.bool_]
) -> NDArray[np.intp]:
    """Labels (H, W) whose small pieces have gone over to what is around them; each keeps its largest piece. An arm has
    no other pieces, either: nothing smaller than the one with its hand, or than a share of the largest. The hand is
    `sure` (H, W; -1 where nothing is). Pieces stay where the other arm passes before them, or at a shoulder where
    labels are `plain` (H, W)."""
    kept = labels.astype(np.intp).copy()
    for part in range(len(BODY_PARTS)):
        count, pieces, stats, _ = cv2.connectedComponentsWithStats((labels == part).astype(np.uint8), connectivity=4)
        if count < 3:
            continue
        areas = stats[:count, cv2.CC_STAT_AREA]
        known = np.bincount(pieces[(sure == part) & (pieces > 0)], minlength=count)
        small = areas < MIN_LABEL_PIECE_PIXELS
        if part in ARM_LABELS:
            other = (labels == OPPOSITE_LABEL[part]).astype(np.uint8)
            met = np.unique(pieces[(cv2.dilate(other, np.ones((5, 5), np.uint8)) > 0) | plain])
            least = areas[known.argmax()] if known.any() else MIN_SECOND_PIECE_SHARE * areas[1:].max()
            small |= (areas < least) & ~np.isin(np.arange(count), met)
        small[[0, 1 + int(np.argmax(areas[1:]))]] = False
        kept[small[pieces]] = -1
    return complete_labels(labels >= 0, kept)


def refined_labels(
    rgb: NDArray[np.uint8],
    rough: NDArray[np.integer],
    occlusion: NDArray[np.bool_],
    template: NDArray[np.integer],
) -> NDArray[np.intp]:
    """L: the labels where limbs pass before others, moved to where colours change. Equations 15 to 19; beyond them, where
    colours say little, what the template covers keeps its label.

    `rgb` (H, W, 3); `rough` (H, W) labels, -1 outside the person; `occlusion` (H, W) the mask O within which labels may
    change; `template` (H, W) the projected template's labels, -1 where it is not. Those outside of O hold their neighbours.
    """
    labels = rough.astype(np.intp).copy()
    inside = occlusion & (labels >= 0)
    if not inside.any():
        return labels
    # each of the regions of O knows only the labels that meet there
    _, regions = cv2.connectedComponents(inside.astype(np.uint8))
    colours = rgb.astype(np.float64)
    for region in range(1, regions.max() + 1):
        _refine(colours, labels, inside & (regions == region), template)
    return labels


def _refine(
    colours: NDArray[np.float64], labels: NDArray[np.intp], region: NDArray[np.bool_], template: NDArray[np.integer]
) -> None:
    """Refine the labels within one region, in place."""
    around = dilate_mask(region, 7)
    near = around & (labels >= 0)
    meeting = [int(label) for label in np.unique(labels[region])]
    if len(meeting) < 2:
        return
    graph = ContrastGraph.of(colours, near)
    pixels, inner, first = colours[near], region[near], labels[near]
    astray = STRAY_PIXEL_COST * np.stack([_distance_to(template == label)[near] for label in meeting], 1)
    astray[template[near] < 0] = 0
    index = {label: k for k, label in enumerate(meeting)}
    seeds = np.where(inner, UNSEEDED_MARK, [index.get(int(label), len(meeting)) for label in first])
    current = first
    for _ in range(LABELLING_ROUNDS):
        shown = [pixels[current == label] for label in meeting]
        if min(len(own) for own in shown) < MIN_MIXTURE_PIXELS:
            break
        costs = colour_costs([ColourMixture.fit(own) for own in shown], pixels) + astray
        start = np.array([index.get(int(label), 0) for label in current])
        found = np.array(meeting)[graph.cut(costs, start, seeds)]
        fresh = np.where(inner, found, first)
        if (fresh == current).all():
            break
        current = fresh
    labels[near] = current


def _distance_to(mask: NDArray[np.bool_]) -> NDArray[np.float64]:
    if not mask.any():
        return np.full(mask.shape, UNSHOWN_LABEL_COST_PIXELS)
    return np.asarray(distance_to(mask), np.float64)


def _nearest_label(labels: NDArray[np.intp]) -> NDArray[np.intp]:
    distances = np.stack([_distance_to(labels == label) for label in range(len(BODY_PARTS))])
    return np.asarray(distances.argmin(0), np.intp)
