"""The person taken apart: the body, and each limb that passes before it, each a surface with a front and a back.

The paper's sections 4.2.2 and 4.2.3.
"""

from __future__ import annotations

from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from engine.body.rig import Rig
from engine.character.crossed_labels import Behind
from engine.character.depth_order import (
    body_behind,
    body_within,
    hand_beneath,
    limb_around,
    limb_before,
    limb_behind,
    overlap_beneath,
)
from engine.character.drape import drape
from engine.character.face_warp import Face, with_face
from engine.character.label_map import Labels
from engine.character.labels import ARMS, LEGS
from engine.character.legs import cut_along, each_by_its_own
from engine.character.legs_beneath import going_with, legs_beneath
from engine.character.occlusion import largest
from engine.character.part_surface import Surface, Warp, part_surface, warp_part
from engine.character.posed_template import PosedTemplate
from engine.character.regions import LimbRegion, Region, find_regions
from engine.character.sheets import Layer
from engine.character.skirt_weights import moved_by_both
from engine.character.solid_limb import solid_arms, solid_limb
from engine.character.template_maps import SideMaps, weights_at
from engine.character.unseen_limbs import unseen_layer, unseen_limbs

BARE = ("Head", "Neck", "Jaw", "Eye", "Hand", "Foot", "Toe")
"""What is in the names of joints that move skin, hair or shoes, not cloth."""
LEAST = 50
"""Pixels of a limb that is worth being a part of its own."""


def build_layers(labels: Labels, template: PosedTemplate, rig: Rig, face: Face | None = None) -> list[Layer]:
    """The body first, its head by its `face` if there is one; then legs that come out from under its cloth, and each limb that
    is apart and large enough. `labels`: taken apart (`Labels.layered`)."""
    beneath = legs_beneath(labels, template, rig)
    legs = [leg.limb for leg in beneath]
    apart = [int(limb) for limb in labels.apart
             if limb not in legs and largest(labels.labels == limb).sum() >= LEAST]  # fmt: skip
    region, limbs = find_regions(labels, apart, template, rig)
    cloth = labels.cloth
    parting = labels.parting & (not any(limb in LEGS for limb in apart))
    parting[: cloth.rings[-1].row + 1 if cloth else 0] = False
    body = replace(_layer(region, template, rig, face), cut=cut_along(labels.labels, parting))
    body = each_by_its_own(body, labels.labels, parting, rig)
    if cloth:
        body = moved_by_both(drape(body, cloth), cloth, rig)
    layers = []
    solid = solid_arms(template, rig)
    for leg in beneath:
        own = labels.labels == leg.limb
        under = overlap_beneath(going_with(_layer(leg, template, rig), body, own), body, own)
        layers.append(replace(under, limb=leg.limb))
    if cloth and cloth.before is not None:
        layers = _leg_behind(layers, cloth.before, labels)
    for one in limbs:
        own = labels.labels == one.limb
        if one.limb in solid and not (labels.hidden == one.limb).any():
            limb = _solid_layer(one, template, rig, own)
        else:
            limb = hand_beneath(_layer(one, template, rig), body, labels.hidden == one.limb)
        body = body_behind(body, limb, own)
        if one.limb in LEGS:
            body = body_within(body, limb, own & one.joint)
        limb = limb_before(limb, body, own)
        if limb.solid is None:
            beneath_it = overlap_beneath(limb, body, own, one.behind)
        else:
            beneath_it = _solid_beneath(limb, body, own | ~one.joint)
        layers.append(replace(beneath_it, limb=one.limb))
    layers += [unseen_layer(one, [body, *layers], labels, template, rig) for one in unseen_limbs(labels, template, rig)]
    if labels.behind is not None:
        layers = _behind_the_other(layers, body, labels.behind, labels)
    return [body, *layers]


def _behind_the_other(layers: Sequence[Layer], body: Layer, behind: Behind, labels: Labels) -> list[Layer]:
    """The layers of limbs with the arm that goes on `behind` the other beneath its surface there."""
    found = list(layers)
    place = {layer.limb: k for k, layer in enumerate(found)}
    other = next(arm for arm in ARMS if arm != behind.limb)
    if {behind.limb, other} <= set(place):
        before = found[place[other]]
        hidden = behind.area & (labels.labels == other)
        moved = limb_behind(found[place[behind.limb]], before, hidden)
        if moved.solid is not None:
            all_of_it = np.ones(len(moved.solid.vertices), np.bool_)
            moved = replace(moved, solid=moved.solid.moved(moved.front.depth, moved.back.depth, all_of_it))
        found[place[behind.limb]] = moved
        if before.solid is None:
            found[place[other]] = limb_around(before, moved, body, hidden)
    return found


def _leg_behind(legs: Sequence[Layer], before: int, labels: Labels) -> list[Layer]:
    """Legs that come out from under cloth, the one that another is `before` behind that one."""
    front = [leg for leg in legs if leg.limb == before]
    shown = labels.labels == before
    return [leg if leg.limb == before or not front else limb_behind(leg, front[0], shown) for leg in legs]


def _layer(region: Region, template: PosedTemplate, rig: Rig, face: Face | None = None) -> Layer:
    """A region's front and back. `face` changes the front's warp."""
    sides = template.sides(region.triangles, region.mask.shape)
    warp = warp_part(region.mask, sides.front.mask)
    bare = np.array([any(part in name for part in BARE) for name in rig.names])

    def rebuilt(own: Warp, side: SideMaps) -> Surface:
        weights = weights_at(side.raster, sides.triangles, rig.bones, rig.weights, len(rig.names))
        return part_surface(region.mask, own, side, weights, bare)

    with ThreadPoolExecutor(1, thread_name_prefix="back") as beside:
        back = beside.submit(rebuilt, warp, sides.back)
        front = rebuilt(warp if face is None else with_face(warp, face), sides.front)
    return Layer(region.mask, front, back.result())


def _solid_layer(one: LimbRegion, template: PosedTemplate, rig: Rig, own: NDArray[np.bool_]) -> Layer:
    """A limb that is the template's, and the pixels that it covers."""
    limb = solid_limb(one.triangles, one.mask, template, rig, own)
    unused = np.zeros((*own.shape, 0), np.float32)
    return Layer(np.isfinite(limb.front), Surface(limb.front, unused), Surface(limb.back, unused), solid=limb)


def _solid_beneath(limb: Layer, body: Layer, own: NDArray[np.bool_]) -> Layer:
    """A solid limb where its layer has come, and of its pixels that are not its `own` (h, w) the upper arm's beneath the body's
    surface: nothing else of it overlaps with the body."""
    assert limb.solid is not None
    solid = limb.solid.moved(limb.front.depth, limb.back.depth, np.ones(len(limb.solid.vertices), np.bool_))
    beneath = overlap_beneath(limb, body, own)
    return replace(beneath, solid=solid.moved(beneath.front.depth, beneath.back.depth, solid.upper))
