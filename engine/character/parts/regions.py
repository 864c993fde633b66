"""Which pixels are the body's, and which those of a limb that passes before it, also where one hides the other.

The paper's occluded region construction (section 4.2.2). Around the joint limb and body both have what is there, of the
template and of the picture: as the limb is lifted, neither shows a gap. Beyond the paper, so does a leg that passes before
the other.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.body.parts import BODY_PARTS, vertex_parts
from engine.body.rig import Rig
from engine.character.fit.posed_template import PosedTemplate
from engine.character.parts.label_map import Labels
from engine.character.parts.labels import ARM_LABELS, LEG_LABELS
from engine.character.parts.occlusion import completed
from engine.character.parts.overlapping_legs import hidden_leg
from engine.imaging.masks.mask_distance import dilate_mask, distance_to
from engine.imaging.masks.mask_pieces import largest_piece

SHOULDER_OVERLAP_METRES, HIP_OVERLAP_METRES = 0.105, 0.125
"""Metres around the joint in which arm or leg and the body overlap."""
BODY_UNDERLAP_PIXELS = 3
"""Pixels by which the body goes on behind an arm everywhere: what lies between two borders of pixels would gape."""
PATH_TOLERANCE_PIXELS = 4.0
"""Pixels by which a way from the sleeve to a hidden hand may be longer than the shortest."""
MIN_TEMPLATE_SHOWN_SHARE = 0.5
"""Share of a limb that the template shows where it is not seen, below which it is taken to be behind the body there."""
SINGLE_PIECE_SHARE = 0.9
"""Share of a limb in one piece, below which another is taken to pass before it."""


@dataclass(frozen=True)
class Region:
    """What a part of the person covers: its pixels `mask` (h, w), in one piece, and the template's `triangles` (T,) bool."""

    mask: NDArray[np.bool_]
    triangles: NDArray[np.bool_]


@dataclass(frozen=True)
class LimbRegion(Region):
    """That of a `limb`, an index of `BODY_PARTS`. Around its shoulder or hip it overlaps with the body: the template's triangles
    `overlap` (T,) and the pixels `joint` (h, w). One that passes `behind` the body hides nothing of it."""

    limb: int
    overlap: NDArray[np.bool_]
    joint: NDArray[np.bool_]
    behind: bool = False


def find_regions(
    labels: Labels, apart: Sequence[int], template: PosedTemplate, rig: Rig, unseen: Sequence[int] = ()
) -> tuple[Region, list[LimbRegion]]:
    """The body's region and those of the limbs that are `apart` (indices of `BODY_PARTS`), in their order; the body ends where
    legs come out from under its cloth, and has nothing of limbs that are `unseen`."""
    part = vertex_parts(rig)[template.triangles]
    limbs = [_limb_region(labels, limb, apart, template, rig, part) for limb in apart]
    own = np.logical_or.reduce([(~np.isin(part, [*apart, *unseen])).any(1), *(limb.overlap for limb in limbs)])
    legs = None if labels.cloth is None else labels.cloth.legs
    if legs is not None:
        own &= ~_below(legs, template, part)
        labels = replace(labels, labels=np.where(legs >= 0, -1, labels.labels))
    return Region(body_in_one_piece(labels, limbs, template, part, own), own), limbs


def _below(legs: NDArray[np.int8], template: PosedTemplate, part: NDArray[np.intp]) -> NDArray[np.bool_]:
    """The template's triangles (T,) of legs below the hem from under which they come (`legs` (h, w), -1 elsewhere)."""
    below = np.zeros(len(part), np.bool_)
    for leg in np.unique(legs[legs >= 0]):
        own = legs == leg
        hem = float(np.median(own.argmax(0)[own.any(0)]))
        below |= (part == leg).all(1) & (template.vertices[template.triangles, 1].min(1) > hem)
    return below


def limb_in_one_piece(
    labels: Labels,
    limb: int,
    apart: Sequence[int],
    template: PosedTemplate,
    triangles: NDArray[np.bool_],
    joint: NDArray[np.bool_],
) -> tuple[NDArray[np.bool_], bool]:
    """The pixels (h, w) of a limb in one piece, and whether it passes behind the body.

    They are what is seen of the limb, what it shares with the body around its `joint` (h, w), what of it goes on behind
    the other arm, and its hidden hand. The body, or another limb that is `apart`, may pass before it: it comes out in
    two places, or does not reach its joint. Then they are what the template has there, too: its `triangles` (T,) bool.
    """
    own, person = labels.labels == limb, labels.labels >= 0
    if labels.behind is not None and labels.behind.limb == limb:
        own = own | labels.behind.area
    seen = own | (person & joint & dilate_mask(own, round(SHOULDER_OVERLAP_METRES / 2 * template.pixels_per_metre)))
    lost, behind = not (largest_piece(seen) & joint).any(), False
    if lost or _torn(seen):
        between = dilate_mask(template.covers(triangles, own.shape), BODY_UNDERLAP_PIXELS)
        beneath = between & np.isin(labels.labels, apart)
        led = between & person
        shown = template.shows(triangles, own.shape) & led
        hidden = lost and shown.sum() < MIN_TEMPLATE_SHOWN_SHARE * led.sum()
        behind = hidden or _torn(seen | beneath)
        seen = own | led if behind else seen | (led if lost else beneath)
    return largest_piece(_with_hand(seen, labels.hidden == limb)), behind


def _with_hand(arm: NDArray[np.bool_], hidden: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """An arm (h, w) with its `hidden` hand (h, w), and what is between them: the template's wrist need not be at the cuff."""
    if not (hidden.any() and arm.any()):
        return arm | hidden
    to_arm, to_hand = distance_to(arm), distance_to(hidden)
    return np.asarray(arm | hidden | (to_arm + to_hand <= to_arm[hidden].min() + PATH_TOLERANCE_PIXELS))


def _torn(mask: NDArray[np.bool_]) -> bool:
    """Whether much of a mask is not in one piece."""
    return bool(largest_piece(mask).sum() < SINGLE_PIECE_SHARE * mask.sum())


def _limb_region(
    labels: Labels, limb: int, apart: Sequence[int], template: PosedTemplate, rig: Rig, part: NDArray[np.intp]
) -> LimbRegion:
    """`part` (T, 3): that of each corner of the template's triangles."""
    overlap, joint = _around_joint(limb, template, rig, labels.labels.shape)
    mask, behind = limb_in_one_piece(labels, limb, apart, template, (part == limb).all(1), joint)
    if limb in LEG_LABELS:
        without_arms = template.covers(np.asarray((~np.isin(part, ARM_LABELS)).all(1)), mask.shape)
        hand = np.isin(labels.labels, ARM_LABELS) & ~without_arms
        mask = largest_piece(mask & ((_inner(labels) & ~hand) | (labels.labels == limb)))
    return LimbRegion(mask, (part == limb).any(1) | overlap, limb, overlap, joint, behind)


def body_in_one_piece(
    labels: Labels,
    limbs: Sequence[LimbRegion],
    template: PosedTemplate,
    part: NDArray[np.intp],
    triangles: NDArray[np.bool_],
) -> NDArray[np.bool_]:
    """The pixels (h, w) of the body in one piece, completed behind the limbs. `part` (T, 3): that of each corner of the template's
    triangles; `triangles` (T,): which of them are the body's."""
    apart = np.isin(labels.labels, [one.limb for one in limbs])
    covered = np.logical_or.reduce([np.zeros_like(apart), *(one.mask for one in limbs)])
    body = (labels.labels >= 0) & ~(apart & covered)
    if not limbs:
        return largest_piece(body)
    before = np.isin(labels.labels, [one.limb for one in limbs if not one.behind])
    crossing = np.zeros_like(before)
    for leg in (one.limb for one in limbs if one.limb in LEG_LABELS):
        crossing = labels.labels == leg
        body = body | (crossing & hidden_leg(labels.labels, leg, template, part))
    whole = template.covers(triangles, before.shape)
    body = completed(body, before & covered, labels.occlusion | crossing, whole)
    body = body | (before & np.where(crossing, dilate_mask(body, 1), dilate_mask(body, BODY_UNDERLAP_PIXELS)))
    for one in limbs:
        if one.behind:  # what lies between two borders of pixels would gape; a shoulder beside it is no trunk's
            body = body | ((labels.labels == one.limb) & ~one.joint & dilate_mask(body, 1))
    for one in limbs:  # not behind another, as a hand that hangs beside the hip, where no trunk is
        of_both = before & one.joint & ((labels.labels == one.limb) | whole)
        body = largest_piece(body | (of_both & (_inner(labels) | ~crossing)))
    return body


def _around_joint(
    limb: int, template: PosedTemplate, rig: Rig, shape: Sequence[int]
) -> tuple[NDArray[np.bool_], NDArray[np.bool_]]:
    """The template's triangles (T,), and the grid's pixels (h, w), around an arm's shoulder or a leg's hip."""
    side = "Left" if BODY_PARTS[limb].startswith("left") else "Right"
    bone, reach = ("Arm", SHOULDER_OVERLAP_METRES) if limb in ARM_LABELS else ("UpLeg", HIP_OVERLAP_METRES)
    joint = rig.index(f"{side}{bone}")
    close = np.linalg.norm(template.rest - template.rest_joints[joint], axis=1) < reach
    y, x = np.mgrid[: shape[0], : shape[1]]
    distance = np.hypot(x - template.joints[joint, 0], y - template.joints[joint, 1])
    return close[template.triangles].all(1), distance < reach * template.pixels_per_metre


def _inner(labels: Labels) -> NDArray[np.bool_]:
    """The person's pixels (h, w) away from the outline: at the sides of the hips one of body and leg alone is seen."""
    person = (labels.labels >= 0).astype(np.uint8)
    return np.asarray(cv2.erode(person, np.ones((3, 3), np.uint8), iterations=BODY_UNDERLAP_PIXELS) > 0)
