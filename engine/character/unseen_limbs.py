"""Limbs of which the picture shows nothing, behind the trunk or another limb: the fitted template's, in the colours of the other
side's.

Beyond the paper, whose limbs are all seen. Left to the body, such a limb would be one surface with the trunk that hides it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.body.parts import vertex_parts
from engine.body.rig import Rig
from engine.character.depth_order import limb_behind
from engine.character.label_map import Labels
from engine.character.labels import ARMS, LEGS
from engine.character.occlusion import largest
from engine.character.part_surface import Surface
from engine.character.posed_template import PosedTemplate
from engine.character.sheets import Layer
from engine.character.solid_limb import SolidLimb, solid_limb

LEAST = 50
"""Pixels from which on a limb is seen."""
WITHIN = 0.6
"""Share of the template's limb that is within the person's outline where the person hides it: else nobody knows of it."""
OFF = 2
"""Pixels from the outline within which nothing of a hidden limb can be."""
OTHER = {one: other for pair in (ARMS, LEGS) for one, other in (pair, pair[::-1])}
"""The limb of the other side."""


@dataclass(frozen=True)
class UnseenLimb:
    """A `limb`, an index of `PARTS`, that is hidden all over: its template's `triangles` (T,), and where it is (h, w)."""

    limb: int
    triangles: NDArray[np.bool_]
    mask: NDArray[np.bool_]


def unseen_limbs(labels: Labels, template: PosedTemplate, rig: Rig) -> list[UnseenLimb]:
    """Those of a person. Legs under a skirt are not looked for."""
    part = vertex_parts(rig)[template.triangles]
    person = (labels.labels >= 0).astype(np.uint8)
    inner = cv2.erode(person, np.ones((3, 3), np.uint8), iterations=OFF, borderValue=0) > 0
    seen = [limb for limb in OTHER if (labels.labels == limb).sum() >= LEAST or (labels.hidden == limb).any()]
    skirt = labels.cloth is not None and labels.cloth.hangs
    found = []
    for limb, other in OTHER.items():
        if limb in seen or other not in seen or (limb in LEGS and skirt):
            continue
        triangles = (part == limb).any(1)
        covered = template.covers(triangles, inner.shape)
        mask = largest(covered & inner)
        if mask.sum() > WITHIN * covered.sum():
            found.append(UnseenLimb(limb, triangles, mask))
    return found


def unseen_layer(one: UnseenLimb, layers: Sequence[Layer], labels: Labels, template: PosedTemplate, rig: Rig) -> Layer:
    """The limb, in the colours of the other side's, behind all that is seen before it: the body, first of the `layers`, and limbs."""
    limb = solid_limb(one.triangles, one.mask, template, rig, np.zeros_like(one.mask))
    limb = replace(limb, like=_other_side(one.limb, labels, template, rig))
    unused = np.zeros((*one.mask.shape, 0), np.float32)
    layer = Layer(np.isfinite(limb.front), Surface(limb.front, unused), Surface(limb.back, unused), limb=one.limb)
    apart = [other.limb for other in layers[1:]]
    for before in layers:
        own = labels.labels == before.limb if before.limb >= 0 else ~np.isin(labels.labels, apart)
        layer = limb_behind(layer, before, own)
    everywhere = np.ones(len(limb.vertices), np.bool_)
    return replace(layer, solid=limb.moved(layer.front.depth, layer.back.depth, everywhere))


def _other_side(limb: int, labels: Labels, template: PosedTemplate, rig: Rig) -> SolidLimb:
    """The limb of the other side, where the picture shows it."""
    own = labels.labels == OTHER[limb]
    chosen = (vertex_parts(rig)[template.triangles] == OTHER[limb]).any(1)
    return solid_limb(chosen, largest(own), template, rig, own)
