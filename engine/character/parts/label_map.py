"""The body label map: what each pixel of the person shows, and what that says of limbs that pass before others.

The paper's section 4.2.1. Beyond it, legs that hide one another, and hands in pockets.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from engine.body.parts import BODY_PARTS, vertex_parts
from engine.body.rig import Rig
from engine.character.fit.posed_template import PosedTemplate
from engine.character.fit.template_maps import side_maps
from engine.character.parts.colour_ownership import owned_by_colour
from engine.character.parts.crossed_labels import ArmLabels, Behind
from engine.character.parts.free_cloth import FreeCloth
from engine.character.parts.hair_behind_arms import hair_behind_arms
from engine.character.parts.held_things import held_things
from engine.character.parts.labels import (
    ARM_LABELS,
    LEG_LABELS,
    complete_labels,
    hair_beside_arms,
    refined_labels,
    rough_labels,
    without_specks,
)
from engine.character.parts.occlusion import occlusion_mask, occlusion_pixels, rest_places
from engine.character.parts.overlapping_legs import as_the_template, beside_the_other, leg_before
from engine.character.parts.pockets import parted, template_hand, with_hand_parted
from engine.character.parts.shoulders import labelled_shoulders
from engine.character.parts.unfound_hands import UnfoundHand
from engine.render.rasterisation.attributes import interpolate

MIN_LEG_SEPARATION_METRES = 0.05
"""Metres at rest between points of the legs that touch in the picture and are not joined: near the crotch they are."""


@dataclass(frozen=True)
class Labels:
    """Which part each pixel of the person shows.

    labels : (h, w) int8 indices of `engine.body.parts.BODY_PARTS`, -1 outside the person.
    occlusion : (h, w) where limbs pass before others.
    apart : those that do, a leg that passes before the other first, then arms.
    parting : (h, w) where one leg touches the other and is not joined to it.
    hidden : (h, w) int8 the arm whose hand is in a pocket there, or behind other cloth, -1 elsewhere.
    behind : of crossed arms the one that the other hides.
    cloth : what goes round both legs.
    held : (h, w) int8 the part that holds what is there, an arm, or the head of hair that stands off; -1 elsewhere, None where nothing
        is held.
    """

    labels: NDArray[np.int8]
    occlusion: NDArray[np.bool_]
    apart: NDArray[np.int8]
    parting: NDArray[np.bool_]
    hidden: NDArray[np.int8]
    behind: Behind | None = None
    cloth: FreeCloth | None = None
    held: NDArray[np.int8] | None = None

    @property
    def bare(self) -> Labels:
        """Labels of the body alone: what is held is no part of it."""
        if self.held is None:
            return self
        return replace(self, labels=np.where(self.held >= 0, -1, self.labels).astype(np.int8))

    @property
    def layered(self) -> Labels:
        """Labels by what is made in one piece: a skirt or a coat is the trunk's, and legs that come out from under it
        are apart."""
        if self.cloth is None or self.cloth.legs is None or not self.cloth.parted:
            return self
        legs = self.cloth.legs
        clothed = np.where(np.isin(self.labels, LEG_LABELS), BODY_PARTS.index("torso"), self.labels)
        return replace(
            self,
            labels=np.where(legs >= 0, legs, clothed).astype(np.int8),
            apart=np.concatenate([np.unique(legs[legs >= 0]), self.apart]).astype(np.int8),
            parting=np.zeros_like(self.parting),
        )


@dataclass(frozen=True)
class LabelHints:
    """What is known of labels (h, w) on the grid beside the picture; -1 where nothing is."""

    given: NDArray[np.int8] | None = None
    """Labels that take the place of all that are found."""
    sure: NDArray[np.int8] | None = None
    """Labels that take the place of the template's, where nothing is given."""
    unfound: Sequence[UnfoundHand] = ()
    """Hands that are looked for where they would be."""
    crossed: ArmLabels | None = None
    """Crossed arms, which are as they are here and not as the template has them."""


def label_parts(
    rgb: NDArray[np.uint8],
    mask: NDArray[np.bool_],
    template: PosedTemplate,
    rig: Rig,
    hints: LabelHints = LabelHints(),
    corrected: Callable[[NDArray[np.int8]], NDArray[np.int8]] = lambda labels: labels,
) -> Labels:
    """Label the person's pixels (h, w), on the grid; `corrected` has the last word."""
    given, sure, crossed = hints.given, hints.sure, hints.crossed
    part_of = vertex_parts(rig)[template.triangles[:, 0]]
    seen = side_maps(template.vertices, template.triangles, (mask.shape[0], mask.shape[1]), "front")
    projected = np.where(seen.mask, part_of[seen.raster.triangle], -1)
    rest = interpolate(template.rest, template.triangles, seen.raster)
    hidden, held = (np.full(mask.shape, -1, np.int8) for _ in range(2))

    def before(labels: NDArray[np.integer]) -> int | None:
        return leg_before(labels, template, rig)

    if given is not None:
        rough = complete_labels(mask, given)
    else:
        known = np.full(mask.shape, -1, np.int8) if sure is None else np.where(mask, sure, -1)
        likely = projected
        if crossed is not None:
            known = np.where(crossed.shown >= 0, crossed.shown, known)
            likely = _projected(template, part_of, ~np.isin(part_of, ARM_LABELS), mask.shape)
        shown = np.where(known >= 0, known, likely)
        rough = rough_labels(mask, shown)
        rough = np.where(known >= 0, known, rough)
        rough = hair_beside_arms(rgb, rough, projected, known)
        rough = hair_behind_arms(rgb, rough, projected, known)
        around = _with_occlusion(rough, projected, rest, hidden).occlusion
        rough = refined_labels(rgb, rough, around, shown)
        rough, plain = labelled_shoulders(rgb, rough, template, rig)
        if (leg := before(rough)) is not None:
            rough = as_the_template(rough, projected, leg)
        held = held_things(rgb, rough, template, rig)
        bare = owned_by_colour(rgb, np.where(held >= 0, -1, rough).astype(np.int8))
        rough = without_specks(np.where(held >= 0, held, bare), known, plain)
        for hand in hints.unfound:
            own = template_hand(template.vertices, template.triangles, rig, hand.arm, (mask.shape[0], mask.shape[1]))
            if (found := parted(rgb, rough, own, hand)) is not None:
                rough = without_specks(with_hand_parted(rough, found, hand.arm), known, plain)
                hidden[found.hidden] = hand.arm
    labels = corrected(rough.astype(np.int8))
    hidden[labels != rough] = -1  # whoever paints there has seen what is there
    held[labels != held] = -1
    whole = _with_occlusion(labels, projected, rest, hidden, before(labels))
    if (held >= 0).any():
        whole = replace(whole, held=held)
    if crossed is None or crossed.behind.limb not in whole.apart:
        return whole
    behind = crossed.behind
    found_so = (labels >= 0) & (labels == rough) & (given is None)  # whoever paints says what is behind nothing
    hides = (np.isin(labels, ARM_LABELS) | found_so) & (labels != behind.limb)
    return replace(whole, behind=Behind(behind.limb, behind.area & hides, behind.hand & hides))


def _projected(
    template: PosedTemplate, part_of: NDArray[np.intp], chosen: NDArray[np.bool_], shape: Sequence[int]
) -> NDArray[np.intp]:
    """The labels (h, w) of some `chosen` triangles (T,) of the template, seen without the others; `part_of` (T,): those of all."""
    seen = side_maps(template.vertices, template.triangles[chosen], (shape[0], shape[1]), "front")
    return np.where(seen.mask, part_of[chosen][seen.raster.triangle], -1)


def _with_occlusion(
    labels: NDArray[np.integer],
    projected: NDArray[np.integer],
    rest: NDArray[np.float32],
    hidden: NDArray[np.int8],
    before: int | None = None,
) -> Labels:
    """Labels with what they say of limbs before others, and where hands are `hidden` (h, w). `before` is the leg in
    front of the other."""
    places = [rest_places(labels, part, projected, rest) for part in range(len(BODY_PARTS))]
    pixels = {arm: occlusion_pixels(labels, arm, places) for arm in ARM_LABELS}
    parting = np.zeros(labels.shape, np.bool_)
    for leg in LEG_LABELS:
        only = [where if part in LEG_LABELS else np.full_like(where, np.nan) for part, where in enumerate(places)]
        parting |= occlusion_pixels(
            np.where(np.isin(labels, LEG_LABELS), labels, -1), leg, only, MIN_LEG_SEPARATION_METRES
        )
    if before is not None:
        pixels = {before: beside_the_other(labels, before)} | pixels
    return Labels(
        labels.astype(np.int8),
        occlusion_mask(np.logical_or.reduce(list(pixels.values()))),
        np.array([limb for limb, where in pixels.items() if where.any() or (hidden == limb).any()], np.int8),
        parting,
        hidden,
    )
