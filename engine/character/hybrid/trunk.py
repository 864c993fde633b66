"""The relief of the trunk: what is left of a person without arms and legs, completed behind them.

The paper's occluded regions (section 4.2.2) with every limb taken as one that passes before the body. What goes on in arms and legs
is the shell's; nothing of them is cut here but the border at which they leave.
"""

from __future__ import annotations

from dataclasses import replace

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.body.parts import vertex_parts
from engine.body.rig import Rig
from engine.character.fit.posed_template import PosedTemplate
from engine.character.parts.label_map import Labels
from engine.character.parts.labels import ARM_LABELS, HEAD_LABEL, LEG_LABELS, TRUNK_LABEL
from engine.character.parts.occlusion import completed
from engine.character.parts.regions import Region
from engine.character.surface.drape import drape
from engine.character.surface.face_warp import Face
from engine.character.surface.front_and_back import Layer
from engine.character.surface.layers import layer_of
from engine.character.surface.skirt_weights import moved_by_both
from engine.imaging.masks.mask_distance import dilate_mask
from engine.imaging.masks.mask_pieces import largest_piece

LIMB_LABELS = (*ARM_LABELS, *LEG_LABELS)
TRUNK_BORDER_SMOOTHING_PIXELS = 5.0
"""Pixels over which the trunk's border beside and behind limbs is smoothed: nobody sees it until they move away."""
TRUNK_BEHIND_LIMBS_PIXELS = 3
"""Pixels by which the trunk goes on behind limbs everywhere: what lies between two borders of pixels would gape."""


def trunk_labels(labels: Labels) -> Labels:
    """Labels in which every limb is apart, and cloth that hangs round both legs is the trunk's."""
    found, cloth = labels.labels, labels.cloth
    if cloth is not None and cloth.hangs:
        legs = np.full(found.shape, -1, np.int8) if cloth.legs is None else cloth.legs
        clothed = np.where(np.isin(found, LEG_LABELS), TRUNK_LABEL, found)
        found = np.where(legs >= 0, legs, clothed).astype(np.int8)
    apart = np.array([limb for limb in LIMB_LABELS if (found == limb).any()], np.int8)
    return replace(labels, labels=found, apart=apart, parting=np.zeros_like(labels.parting), behind=None)


def before_the_trunk(labels: Labels) -> NDArray[np.bool_]:
    """The pixels (h, w) that limbs have, or what hands hold."""
    limbs = np.isin(labels.labels, LIMB_LABELS)
    return np.asarray(limbs if labels.held is None else limbs | (labels.held >= 0))


def trunk_region(labels: Labels, template: PosedTemplate, rig: Rig) -> Region:
    """The trunk's pixels with the head's, in one piece, and the template's triangles that are theirs. `labels`: of `trunk_labels`."""
    part = vertex_parts(rig)[template.triangles]
    limbs = before_the_trunk(labels)
    others = LIMB_LABELS if (labels.labels == HEAD_LABEL).any() else (*LIMB_LABELS, HEAD_LABEL)
    own = np.asarray((~np.isin(part, others)).any(1), np.bool_)
    if labels.cloth is not None and labels.cloth.hangs:
        own = own | _within_cloth(labels, template, part)
    seen = (labels.labels >= 0) & ~limbs
    whole = template.covers(own, seen.shape)
    body = completed(seen, limbs, labels.occlusion, whole)
    even = cv2.GaussianBlur(body.astype(np.float32), (0, 0), TRUNK_BORDER_SMOOTHING_PIXELS) > 0.5
    beside = limbs | (seen & dilate_mask(np.isin(labels.labels, ARM_LABELS), TRUNK_BEHIND_LIMBS_PIXELS))
    body = np.where(beside, even, body)
    if labels.held is not None:  # hair has a surface of its own, and no shoulder goes up behind it
        beside = beside & (labels.held != HEAD_LABEL)
    return Region(largest_piece(body | (beside & dilate_mask(body, TRUNK_BEHIND_LIMBS_PIXELS))), own)


def soft_beside_limbs(layer: Layer, labels: Labels) -> NDArray[np.float32]:
    """The trunk's mask (h, w) about limbs, smoothed: its border is where that is 0.5, between the pixels; 1 elsewhere."""
    smooth = cv2.GaussianBlur(layer.mask.astype(np.float32), (0, 0), TRUNK_BORDER_SMOOTHING_PIXELS / 2)
    beside = dilate_mask(before_the_trunk(labels), TRUNK_BEHIND_LIMBS_PIXELS)
    return np.where(beside, smooth, 1).astype(np.float32)


def _within_cloth(labels: Labels, template: PosedTemplate, part: NDArray[np.intp]) -> NDArray[np.bool_]:
    """The template's triangles (T,) of legs above the hem from under which they come."""
    within = np.asarray(np.isin(part, LEG_LABELS).any(1), np.bool_)
    for leg in LEG_LABELS:
        own = labels.labels == leg
        if own.any():
            hem = float(np.median(own.argmax(0)[own.any(0)]))
            within = within & ~((part == leg).all(1) & (template.vertices[template.triangles, 1].min(1) > hem))
    return np.asarray(within)


def trunk_layer(labels: Labels, template: PosedTemplate, rig: Rig, face: Face | None) -> Layer:
    """Front and back of the trunk, its head by its `face` if there is one."""
    layer = layer_of(trunk_region(labels, template, rig), template, rig, face)
    if labels.cloth is None:
        return layer
    draped = drape(layer, labels.cloth)
    return moved_by_both(draped, labels.cloth, rig, layer) if labels.cloth.hangs else draped
