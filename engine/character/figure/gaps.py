"""Where the background is seen between an arm and the trunk, or between the legs.

The network that cuts people out fills such gaps. Joints say where to look: inside of arms and legs, but on none of them. Colours
say what is there: the background's nearby, rather than those of the limbs and the trunk around.
"""

from __future__ import annotations

from collections.abc import Callable

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.imaging.masks.colour_segmentation import (
    MIN_MIXTURE_PIXELS,
    UNSEEDED_MARK,
    ColourMixture,
    ContrastGraph,
    log_likelihood_ratio,
)
from engine.imaging.masks.mask_distance import dilate_mask, distance_inside, distance_to
from engine.imaging.masks.mask_pieces import bounding_box, mask_height, pieces_by_area, pieces_touching

WORKING_HEIGHT_PIXELS = 500
"""Pixels of the person's height at which gaps are looked for."""
SURE_ARM_WIDTH_SHARE, SURE_LEG_WIDTH_SHARE = 0.035, 0.04
"""Width of what is surely an arm or a leg, as a share of the person's height."""
POSSIBLE_HAND_WIDTH_SHARE, FINGERTIP_TO_KNUCKLE_RATIO = 0.03, 2.2
"""Width of where a hand may be, and how much further its tips are from the wrist than its knuckles."""
BACKGROUND_REACH_SHARE, COLOUR_REACH_SHARE = 0.125, 0.05
"""How far from the person background is, and how far from a place colours tell of it, as shares of their height."""
MIN_BACKGROUND_LOG_LIKELIHOOD_RATIO, MIN_BACKGROUND_LOG_LIKELIHOOD_RATIO_IN_DOUBT = 2.0, 1.2
"""By how much (a logarithm) background has to be likelier, and where networks waver and the colours are those close by."""
MAX_LOG_LIKELIHOOD_RATIO, MAX_LOG_LIKELIHOOD_RATIO_AT_EDGES = 10.0, 3.0
"""By how much a pixel's colours count at most (a logarithm): where gaps are looked for, and where their edges are."""
MIN_GAP_AREA_SHARE, MIN_GAP_WIDTH_SHARE = 2.4e-4, 0.01
"""Area of a gap as a share of the height's square, and its width as a share of the height, at least: what is smaller is a
crease or a braid."""
GAP_EDGE_BAND_PIXELS, MIN_GAP_EDGE_CONTRAST_LEVELS = 4, 8.0
"""Pixels around a gap within which its edge is found, and levels by which colours differ there."""
MIN_CONTRAST_EDGE_SHARE = 0.2
"""Share of a gap's edge at which colours differ by as much, at least: a fold in dark cloth fades into it."""
GAP_GROWTH_SHARE, BODY_CORE_SHARE = 0.1, 0.015
"""How far a gap may go on beyond the piece that is found, and how far within the joints' limbs and trunk it surely ends, as shares
of the height."""
MAX_PERSON_PROBABILITY = 0.85
"""The networks' mean belief in a person from which a piece is no gap: in one they waver, in the shade of a leg they do not."""


def gaps(
    rgb: NDArray[np.uint8],
    alpha: NDArray[np.float32],
    belief: NDArray[np.float32],
    point: Callable[[str], NDArray[np.floating]],
) -> NDArray[np.float32]:
    """How much of the mask (H, W) [0, 1] is gap: 0 nearly everywhere.

    `rgb` (H, W, 3) the picture, `alpha` (H, W) the person's mask, `belief` (H, W) what networks believe to be a
    person; `point` gives a joint's place by its name.
    """
    tall = mask_height(alpha > 0.5)
    none = np.zeros(alpha.shape, np.float32)
    if not tall:
        return none
    scale = min(1.0, WORKING_HEIGHT_PIXELS / tall)
    size = (max(1, round(rgb.shape[1] * scale)), max(1, round(rgb.shape[0] * scale)))
    small = np.asarray(cv2.resize(rgb, size, interpolation=cv2.INTER_AREA), np.uint8)
    mask, believed = (
        np.asarray(cv2.resize(of, size, interpolation=cv2.INTER_AREA), np.float32) for of in (alpha, belief)
    )
    height = tall * scale
    inside, limbs, hands = _by_joints(lambda name: point(name) * scale, mask.shape, height)
    found = _by_colour(small, mask, believed, inside & ~limbs & (mask > 0.5), limbs, height)
    if not found.any():
        return none
    found = _to_their_ends(small, mask, found, limbs, hands, height)
    around = dilate_mask(found, GAP_EDGE_BAND_PIXELS)
    large = cv2.resize(found.astype(np.float32), (rgb.shape[1], rgb.shape[0]), interpolation=cv2.INTER_LINEAR)
    reach = max(2, round(GAP_EDGE_BAND_PIXELS / scale))
    fine = cv2.ximgproc.guidedFilter(rgb, large, reach, MIN_GAP_EDGE_CONTRAST_LEVELS**2)
    near = cv2.resize(around.astype(np.uint8), (rgb.shape[1], rgb.shape[0]), interpolation=cv2.INTER_NEAREST) > 0
    return np.where(near, np.clip(1.5 * np.asarray(fine) - 0.25, 0, 1), 0).astype(np.float32)


def _by_joints(
    point: Callable[[str], NDArray[np.floating]], shape: tuple[int, ...], height: float
) -> tuple[NDArray[np.bool_], NDArray[np.bool_], NDArray[np.bool_]]:
    """What lies inside of arms and legs (h, w), what is surely a limb or the trunk (h, w), and where hands may be (h, w)."""
    inside, limbs, hands = (np.zeros((shape[0], shape[1]), np.uint8) for _ in range(3))

    def places(*names: str) -> NDArray[np.int32]:
        return np.rint(np.stack([point(name) for name in names])).astype(np.int32)

    for side in ("Left", "Right"):
        arm = [f"{side}{joint}" for joint in ("Shoulder", "Elbow", "Wrist")]
        leg = [f"{side}{joint}" for joint in ("Hip", "Knee", "Ankle")]
        cv2.fillPoly(inside, [places(*arm, f"{side}Hip")], (1,))
        for chain, wide in ((arm, SURE_ARM_WIDTH_SHARE), (leg, SURE_LEG_WIDTH_SHARE)):
            cv2.polylines(limbs, [places(*chain)], False, (1,), max(1, round(wide * height)))
        wrist, *knuckles = places(f"{side}Wrist", f"{side}Index", f"{side}Pinky")
        tips = np.rint(wrist + FINGERTIP_TO_KNUCKLE_RATIO * (np.mean(knuckles, axis=0) - wrist)).astype(np.int32)
        cv2.polylines(hands, [np.stack([wrist, tips])], False, (1,), max(1, round(POSSIBLE_HAND_WIDTH_SHARE * height)))
    cv2.fillPoly(inside, [places("LeftHip", "LeftAnkle", "RightAnkle", "RightHip")], (1,))
    cv2.fillPoly(limbs, [places("LeftShoulder", "RightShoulder", "RightHip", "LeftHip")], (1,))
    return inside > 0, limbs > 0, hands > 0


def _by_colour(
    rgb: NDArray[np.uint8],
    alpha: NDArray[np.float32],
    belief: NDArray[np.float32],
    asked: NDArray[np.bool_],
    limbs: NDArray[np.bool_],
    height: float,
) -> NDArray[np.bool_]:
    """The gaps (h, w) in what is `asked` (h, w): by the colours near all of it, and by those near each of its pieces, where light
    falls otherwise."""
    lab = cv2.cvtColor(rgb, cv2.COLOR_RGB2LAB).astype(np.float64)
    outside = (alpha < 0.05) & (
        cv2.dilate((alpha > 0.5).astype(np.uint8), _square(BACKGROUND_REACH_SHARE * height)) > 0
    )
    in_doubt = np.where(
        belief < MAX_PERSON_PROBABILITY,
        MIN_BACKGROUND_LOG_LIKELIHOOD_RATIO_IN_DOUBT,
        MIN_BACKGROUND_LOG_LIKELIHOOD_RATIO,
    )
    large = pieces_by_area(asked, MIN_GAP_AREA_SHARE * height**2)
    found = np.zeros(asked.shape, np.bool_)
    for part, enough in (
        (asked, np.full_like(in_doubt, MIN_BACKGROUND_LOG_LIKELIHOOD_RATIO)),
        *((piece, in_doubt) for piece in large),
    ):
        near = cv2.dilate(part.astype(np.uint8), _square(COLOUR_REACH_SHARE * height)) > 0
        close = outside & near
        own, behind = limbs & near & (alpha > 0.9), close if close.sum() >= 6 * MIN_MIXTURE_PIXELS else outside
        if min(int(own.sum()), int(behind.sum()), int(part.sum())) >= MIN_MIXTURE_PIXELS:
            likely = part & (_likelier(lab, part, own, behind) > enough)
            found |= _large_with_edges(lab, likely, alpha, belief, height)
    return found


def _large_with_edges(
    lab: NDArray[np.float64],
    likely: NDArray[np.bool_],
    alpha: NDArray[np.float32],
    belief: NDArray[np.float32],
    height: float,
) -> NDArray[np.bool_]:
    """The pieces of what is `likely` (h, w) a gap that are one: large enough, with an edge, and no certain person."""
    found = np.zeros(likely.shape, np.bool_)
    depth = np.asarray(cv2.distanceTransform(likely.astype(np.uint8), cv2.DIST_L2, 5))
    rest = (alpha > 0.5) & ~likely
    edge = likely & dilate_mask(rest, 1)
    steps = np.linalg.norm(_around(lab, likely) - _around(lab, rest), axis=2) > MIN_GAP_EDGE_CONTRAST_LEVELS
    for own in pieces_by_area(likely, MIN_GAP_AREA_SHARE * height**2):
        if belief[own].mean() > MAX_PERSON_PROBABILITY or 2 * depth[own].max() < MIN_GAP_WIDTH_SHARE * height:
            continue
        if steps[own & edge].sum() >= MIN_CONTRAST_EDGE_SHARE * edge[own].sum():
            found |= own
    return found


def _to_their_ends(
    rgb: NDArray[np.uint8],
    alpha: NDArray[np.float32],
    found: NDArray[np.bool_],
    limbs: NDArray[np.bool_],
    hands: NDArray[np.bool_],
    height: float,
) -> NDArray[np.bool_]:
    """The gaps (h, w) with what hangs together with them and is background by its colours, too: they go on where joints' limbs and
    trunk are wider than the person's."""
    reach = round(GAP_GROWTH_SHARE * height)
    near = distance_to(found) < reach
    box = bounding_box(near, reach)
    person, gap = alpha[box] > 0.5, found[box]
    asked = near[box] & person & ~(distance_inside(limbs)[box] > BODY_CORE_SHARE * height) & ~hands[box]
    body, behind = person & ~asked & ~gap, gap | (alpha[box] < 0.05)
    if min(int(body.sum()), int(gap.sum()), int(asked.sum())) < MIN_MIXTURE_PIXELS:
        return found
    lab = cv2.cvtColor(np.ascontiguousarray(rgb[box]), cv2.COLOR_RGB2LAB).astype(np.float64)
    background = _cut(lab, asked, gap, ColourMixture.fit(lab[body]), ColourMixture.fit(lab[behind]))
    whole = found.copy()
    whole[box] = pieces_touching(background, gap)
    return whole


def _cut(
    lab: NDArray[np.float64],
    asked: NDArray[np.bool_],
    gap: NDArray[np.bool_],
    body: ColourMixture,
    behind: ColourMixture,
) -> NDArray[np.bool_]:
    """The `gap` (h, w) and what of the pixels that are `asked` (h, w) is more of it, up to where colours (h, w, 3) change: those of a
    white shirt before a white wall say little of themselves."""
    core = distance_inside(gap) > 1
    zone = dilate_mask(asked | gap, 1)
    pixels = lab[zone]
    likelier = body.negative_log_likelihood(pixels) - behind.negative_log_likelihood(pixels)
    likelier = np.clip(
        likelier - MIN_BACKGROUND_LOG_LIKELIHOOD_RATIO,
        -MAX_LOG_LIKELIHOOD_RATIO_AT_EDGES,
        MAX_LOG_LIKELIHOOD_RATIO_AT_EDGES,
    )
    costs = np.stack([np.maximum(likelier, 0), np.maximum(-likelier, 0)], 1)
    seeds = np.where(core, 1, np.where(asked | gap, UNSEEDED_MARK, 0))[zone]
    out = np.zeros_like(gap)
    out[zone] = ContrastGraph.of(lab, zone).cut(costs, gap[zone].astype(np.intp), seeds) > 0
    return out


def _likelier(
    lab: NDArray[np.float64], asked: NDArray[np.bool_], own: NDArray[np.bool_], behind: NDArray[np.bool_]
) -> NDArray[np.float32]:
    """By how much (h, w), a logarithm, pixels that are `asked` (h, w) rather have the colours (h, w, 3) of what is `behind` (h, w)
    than the person's `own` (h, w)."""
    of_own, of_background = ColourMixture.fit(lab[own]), ColourMixture.fit(lab[behind])
    return log_likelihood_ratio(lab, asked, of_background, of_own, 1.5, MAX_LOG_LIKELIHOOD_RATIO)


def _around(lab: NDArray[np.float64], where: NDArray[np.bool_]) -> NDArray[np.float64]:
    """The mean colour (h, w, 3) around each pixel of those `where` (h, w) is true."""
    weight = where.astype(np.float64)
    mass = np.maximum(cv2.GaussianBlur(weight, (0, 0), 2), 1e-9)
    return np.asarray(cv2.GaussianBlur(lab * weight[..., None], (0, 0), 2) / mass[..., None])


def _square(reach: float) -> NDArray[np.uint8]:
    return np.ones((2 * max(1, round(reach)) + 1,) * 2, np.uint8)
