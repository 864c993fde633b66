"""Whose hands and arms are bare, and what of a picture shows something else where they are.

The fitted hand lies a finger's width beside the pictured one, or before a hip that hides it. So what is seen there counts as the hand's only
where it has the tone of the same person's face and hands. A sleeve may reach beyond the wrist; a glove has a colour of its own,
and of who has no skin, as drawings, nothing is said.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

import cv2
import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import median_filter, minimum_filter

from engine.character.fit.template_fit import load_human
from engine.character.parts.labels import ARM_LABELS
from engine.character.shell.template_mesh import template_mesh
from engine.geometry.rigging.joint_names import SIDE_NAMES
from engine.imaging.histogram_matching import to_lab
from engine.performances.modelling.hands import HandBones, hand_bones
from engine.performances.modelling.skin_tone import of_skin_s_hue
from engine.render.rasterisation.attributes import interpolate
from engine.render.rasterisation.rasteriser import rasterise

RING_METRES = 0.005
"""Metres along a hand in which it is looked whether a sleeve covers it: it goes all around."""
KNUCKLES_METRES = 0.08
"""Metres past the wrist at which fingers begin."""
MIN_HAND_SKIN_SHARE = 0.2
"""Share of what is seen of a hand that is skin where it is bare: else it is in a glove, or a sleeve hangs over it."""
HEM_RINGS = 5
"""Rings that agree on whether an arm is bare there."""
MIN_BARE_RING_SHARE = 0.5
"""Share of what is seen of a ring that is skin where it is bare."""
SHADED_LIGHTNESS_WEIGHT, MAX_SHADED_SKIN_DISTANCE = 0.25, 14.0
"""How much lightness counts where skin in deep shade is told from cloth, and the distance in CIELAB, so weighted, up to which it is skin."""
MIN_SEEN_HAND_PIXELS, MIN_NOSE_PIXELS = 12, 25
"""Pixels of the grid from which on a hand, and a face's skin, is seen."""
MIN_SKIN_HUE_SHARE = 0.5
"""Share of a face's pixels that have to be of skin's hues."""


@dataclass(frozen=True)
class BareHand:
    """A hand without a glove: the `tone` (3,) CIELAB of the skin that both show, or else the face, and the metres past the wrist up to which a sleeve reaches (`cuff`)."""

    tone: NDArray[np.float32]
    cuff: float


@dataclass(frozen=True)
class BareSkin:
    """The skin of somebody who has any.

    tone : (3,) CIELAB, of face and hands.
    hands : the left and the right one; None of one in a glove.
    strange : (h, w) bool, pixels of the grid at bare hands and arms that show something else.
    """

    tone: NDArray[np.float32]
    hands: tuple[BareHand | None, BareHand | None]
    strange: NDArray[np.bool_]


def bare_skin(
    rgb: NDArray[np.uint8],
    face: NDArray[np.uint8],
    labels: NDArray[np.integer],
    pictured: NDArray[np.floating],
    triangles: NDArray[np.integer],
) -> BareSkin | None:
    """The skin of a person in the grid's picture `rgb` (h, w, 3), of whose `face` (M, 3) are colours and whose parts are `labels` (h, w). What is
    shown of the template is `triangles` (T, 3) of the vertices `pictured` (V, 3). None of whom the face shows no skin."""
    if len(face) < MIN_NOSE_PIXELS or of_skin_s_hue(face).mean() < MIN_SKIN_HUE_SHARE:
        return None
    raster = rasterise(pictured * [1, 1, -1], triangles, labels.shape)
    lab, skin = to_lab(rgb).reshape(rgb.shape), np.median(to_lab(face), 0)
    strange = np.zeros(labels.shape, np.bool_)
    gloved, own, cuffs = [], [], []
    for side, arm in enumerate(ARM_LABELS):
        past = metres_past_wrists()[side]
        attributes = interpolate(np.column_stack([np.nan_to_num(past), np.isfinite(past)]), triangles, raster)
        there = (raster.triangle >= 0) & (attributes[..., 1] > 0.99) & (labels == arm)
        along = attributes[there][:, 0]
        hand, like = along > 0, shaded_skin(lab[there], skin)
        bare = _bare_rings(along, like)
        few = hand.sum() < MIN_SEEN_HAND_PIXELS
        gloved.append(not few and like[hand].mean() < MIN_HAND_SKIN_SHARE)
        cuffs.append(0.0 if few else _cuff(along, bare))
        surely = _rings(along, bare, HEM_RINGS)
        strange[there] = ~like & surely & ~(hand & gloved[-1])
        own.append(lab[there][like & hand & (along > cuffs[-1])])
    seen = np.concatenate(own)
    tone = np.asarray(np.median(seen, 0) if len(seen) > MIN_SEEN_HAND_PIXELS else skin, np.float32)
    hands = [None if glove else BareHand(tone, cuff) for glove, cuff in zip(gloved, cuffs, strict=True)]
    return BareSkin(
        np.asarray((skin + tone) / 2, np.float32), (hands[0], hands[1]), cv2.medianBlur(strange.astype(np.uint8), 3) > 0
    )


@cache
def hands_of_the_template() -> tuple[HandBones, HandBones]:
    """The left and the right hand of the mean body, once for the process."""
    human = load_human()
    left, right = (hand_bones(human.rig, human.space.mean, side, human.space.joint_mean) for side in SIDE_NAMES)
    return left, right


@cache
def metres_past_wrists() -> NDArray[np.float32]:
    """Metres (2, V) by which vertices of the left and the right arm are past its wrist on the mean body, negative before it; NaN of all others."""
    mesh = template_mesh()
    places = load_human().space.mean[mesh.ids].astype(np.float64)
    found = np.full((2, len(places)), np.nan, np.float32)
    for side, (arm, bones) in enumerate(zip(ARM_LABELS, hands_of_the_template(), strict=True)):
        own = mesh.parts[:, arm] > 0.5
        found[side, own] = (places[own] - bones.wrist) @ bones.along
    return found


def shaded_skin(lab: NDArray[np.floating], skin: NDArray[np.floating]) -> NDArray[np.bool_]:
    """(N,) which colours (N, 3) are of a `skin` (3,), lit or in deep shade; both CIELAB."""
    off = (lab - skin) * np.array([SHADED_LIGHTNESS_WEIGHT, 1, 1], np.float32)
    return np.asarray(np.linalg.norm(off, axis=-1) < MAX_SHADED_SKIN_DISTANCE)


def _rings(along: NDArray[np.floating], own: NDArray[np.bool_], margin: int) -> NDArray[np.bool_]:
    """Whether each of N pixels, `along` (N,) metres past the wrist, is in rings that are all `own` (N,), and so a `margin` of rings around it."""
    if not len(along):
        return own
    ring = np.floor((along - along.min()) / RING_METRES).astype(np.intp)
    whole = np.bincount(ring, ~own) == 0
    return np.asarray(minimum_filter(whole, 2 * margin + 1, mode="nearest")[ring], np.bool_)


def _bare_rings(along: NDArray[np.floating], like: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Whether each of N pixels, `along` (N,) metres past the wrist, is where an arm is bare: of its ring most is `like` (N,) skin, or on the hand, beside which there is much else, some. No sleeve begins on a hand: beyond a bare ring before the knuckles all of it is bare."""
    if not len(along):
        return np.zeros(0, np.bool_)
    ring = np.floor((along - along.min()) / RING_METRES).astype(np.intp)
    seen = np.bincount(ring)
    share = np.bincount(ring, like) / np.maximum(seen, 1)
    told = np.flatnonzero(seen)
    past = along.min() + RING_METRES * np.arange(len(seen))
    least = np.where(past > 0, MIN_HAND_SKIN_SHARE, MIN_BARE_RING_SHARE)
    rings = median_filter(np.interp(np.arange(len(seen)), told, share[told]) > least, HEM_RINGS, mode="nearest")
    on_hand = np.flatnonzero(rings & (past > 0) & (past < KNUCKLES_METRES))
    if len(on_hand):
        rings[on_hand[0] :] = True
    return np.asarray(rings[ring], np.bool_)


def _cuff(along: NDArray[np.floating], bare: NDArray[np.bool_]) -> float:
    """Metres past the wrist up to which a sleeve covers a hand, by which pixels, `along` (N,) metres past it, are in `bare` (N,) rings."""
    first = along[bare & (along > 0)]
    return max(float(first.min()) - RING_METRES, 0.0) if len(first) else KNUCKLES_METRES
