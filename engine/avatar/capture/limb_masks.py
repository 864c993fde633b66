"""Hands, arms and legs in the masks of a person: what networks lose first, and what colours cannot tell from a dark floor.

Where they are is known in space, by landmarks on which views agree. That marks them in every frame, also in those that
show them blurred, small or from behind. Colours near by tell how far they reach.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.avatar.landmarks.spatial import SpatialLandmarks
from engine.body.fitting.hand_fitting import HAND_BONES
from engine.body.fitting.residuals import MIN_DEPTH_METRES
from engine.geometry.camera import Camera
from engine.geometry.rigging.joint_names import SIDE_NAMES
from engine.imaging.masks.colour_segmentation import grab_cut
from engine.imaging.masks.mask_distance import near_lines

PALM_CORNER_LANDMARKS = ("Wrist", "Index", "Pinky")
"""The corners of a palm, without their side."""
BONE_LANDMARKS = (("Shoulder", "Elbow"), ("Elbow", "Wrist"), ("Hip", "Knee"), ("Knee", "Ankle"))
"""Both ends of what is long, without their side."""
MAX_LOST_SHARE = 0.2
"""Share of a limb's marks outside of masks, in the mean of all frames, beyond which the landmarks are wrong: networks
do not lose a limb so often."""
LIMB_REACH_LENGTHS, BONE_REACH_SHARE = 0.35, 0.2
"""How far a hand, and how far an arm or a leg may reach beyond its marks, in lengths of what is marked."""
LOST_SHARE = 0.1
"""Of the marks of an arm or a leg, which networks mostly find: where fewer are outside of a mask, it stays as it is."""
SURE_LIMB_HALF_WIDTH_LENGTHS = 0.03
"""Half the width of what is surely within a limb around its marks, in their lengths."""
LIMB_SURROUNDINGS_LENGTHS = 0.8
"""How much of what is around a limb tells its colours, in lengths of what is marked."""
SETTLED_PIXELS = 3
"""From the outline of the mask, where away from limbs the mask stands."""
MIN_LIMB_LENGTH_PIXELS = 6
"""Along a limb: of a smaller one nothing can be told."""


@dataclass(frozen=True)
class Limb:
    """A limb in space.

    lines : (L, 2, 3) within it.
    reach : how far it may go beyond them, in lengths of all of them.
    lost : the share of them that must lack in a mask for it to be looked for.
    """

    lines: NDArray[np.float64]
    reach: float = LIMB_REACH_LENGTHS
    lost: float = 0.0


def limbs_of(landmarks: SpatialLandmarks) -> list[Limb]:
    """The person's arms, legs and hands, as far as they are known."""
    limbs = []
    for k, side in enumerate(SIDE_NAMES):
        for ends in BONE_LANDMARKS:
            both = [landmarks.body.get(f"{side}{end}") for end in ends]
            if all(place is not None for place in both):
                limbs.append(Limb(np.array([both], np.float64), BONE_REACH_SHARE, LOST_SHARE))
        named = [landmarks.body.get(f"{side}{corner}") for corner in PALM_CORNER_LANDMARKS]
        if all(place is not None for place in named):
            a, b, c = (np.asarray(place) for place in named)
            limbs.append(Limb(np.array([[a, b], [b, c], [c, a]])))
        hand = landmarks.hands[k]
        bones = np.array([[hand[a], hand[b]] for a, b in HAND_BONES])
        known = np.isfinite(bones).all((1, 2))
        if known.any():
            limbs.append(Limb(bones[known]))
    return limbs


def shown_limbs(limbs: Sequence[Limb], masks: Sequence[NDArray[np.bool_]], cameras: Sequence[Camera]) -> list[Limb]:
    """Those of the limbs that the masks (h, w) mostly show, of frames of `cameras` of their size; hands, which networks lose
    anywhere, are all kept."""
    kept = []
    for limb in limbs:
        shares = [_lost_share(mask, lines) for mask, lines in _seen_lines(limb, masks, cameras)] if limb.lost else []
        if not shares or float(np.mean(shares)) < MAX_LOST_SHARE:
            kept.append(limb)
    return kept


def _seen_lines(
    limb: Limb, masks: Sequence[NDArray[np.bool_]], cameras: Sequence[Camera]
) -> Iterator[tuple[NDArray[np.bool_], NDArray[np.float64]]]:
    """The masks of those frames that have all of a limb in their picture, with its lines (L, 2, 2) there."""
    for mask, camera in zip(masks, cameras, strict=True):
        ends = limb.lines.reshape(-1, 3)
        if camera.depth(ends).min() < MIN_DEPTH_METRES:
            continue
        pixels = np.asarray(camera.project(ends, np.float64)[:, :2])
        if (pixels >= 0).all() and (pixels <= np.array(mask.shape[::-1]) - 1).all():
            yield mask, pixels.reshape(-1, 2, 2)


def with_limbs(
    rgb: NDArray[np.uint8], mask: NDArray[np.bool_], camera: Camera, limbs: Sequence[Limb]
) -> NDArray[np.bool_]:
    """The mask (h, w) of a person in a frame (h, w, 3) of a `camera` of that size, with their limbs."""
    out = mask.copy()
    for limb in limbs:
        if camera.depth(limb.lines.reshape(-1, 3)).min() < MIN_DEPTH_METRES:
            continue
        lines = np.asarray(camera.project(limb.lines.reshape(-1, 3), np.float64)[:, :2]).reshape(-1, 2, 2)
        length = float(np.linalg.norm(np.ptp(lines.reshape(-1, 2), axis=0)))
        if length < MIN_LIMB_LENGTH_PIXELS:
            continue
        height, width = mask.shape
        least = np.maximum(np.floor(lines.min((0, 1)) - LIMB_SURROUNDINGS_LENGTHS * length).astype(int), 0)
        most = np.minimum(
            np.ceil(lines.max((0, 1)) + LIMB_SURROUNDINGS_LENGTHS * length).astype(int) + 1, [width, height]
        )
        if (most - least < MIN_LIMB_LENGTH_PIXELS).any():
            continue
        part = np.s_[least[1] : most[1], least[0] : most[0]]
        if _lost_share(out[part], lines - least) >= limb.lost:
            out[part] = _limb(np.ascontiguousarray(rgb[part]), out[part], lines - least, length, limb.reach)
    return out


def _lost_share(mask: NDArray[np.bool_], lines: NDArray[np.float64]) -> float:
    """Of lines (L, 2, 2), which share of what is in the picture a mask lacks."""
    marks = near_lines(mask.shape, lines, 0.5)
    return float((marks & ~mask).sum() / max(marks.sum(), 1))


def _limb(
    rgb: NDArray[np.uint8], mask: NDArray[np.bool_], lines: NDArray[np.float64], length: float, reach: float
) -> NDArray[np.bool_]:
    """The mask of what is around a limb, which is free within the limb's reach alone."""
    near = near_lines(mask.shape, lines, reach * length)
    sure = near_lines(mask.shape, lines, SURE_LIMB_HALF_WIDTH_LENGTHS * length)
    kernel = np.ones((2 * SETTLED_PIXELS + 1,) * 2, np.uint8)
    inner = cv2.erode(mask.astype(np.uint8), kernel) > 0
    ours = sure | inner
    others = ~near & ~mask
    if not (ours.any() and others.any()):
        return mask | sure
    found = grab_cut(rgb, ours, others & ~ours, mask | sure, rounds=3)
    return np.where(near, found | sure, mask)
