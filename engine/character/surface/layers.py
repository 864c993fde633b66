"""The person taken apart: the body, and each limb that passes before it, each a surface with a front and a back.

The paper's sections 4.2.2 and 4.2.3.
"""

from __future__ import annotations

from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from engine.body.parts import vertex_parts
from engine.body.rig import Rig
from engine.character.fit.posed_template import PosedTemplate
from engine.character.fit.template_maps import SideMaps, weights_at
from engine.character.parts.crossed_labels import Behind
from engine.character.parts.label_map import Labels
from engine.character.parts.labels import LEG_LABELS, MIN_LIMB_PIXELS, OPPOSITE_LABEL
from engine.character.parts.regions import Region, find_regions
from engine.character.parts.unseen_limbs import UnseenLimb, unseen_limbs
from engine.character.surface.depth_order import (
    body_behind,
    body_within,
    hand_beneath,
    limb_around,
    limb_before,
    limb_behind,
    overlap_beneath,
)
from engine.character.surface.drape import drape
from engine.character.surface.face_warp import Face, with_face
from engine.character.surface.front_and_back import Layer
from engine.character.surface.legs import cut_along, each_by_its_own
from engine.character.surface.legs_beneath import going_with, legs_beneath
from engine.character.surface.part_surface import Surface, Warp, part_surface, warp_part
from engine.character.surface.skirt_weights import moved_by_both
from engine.character.surface.solid_limb import SolidLimb, solid_arms, solid_limb
from engine.imaging.masks.mask_pieces import largest_piece

BARE_JOINT_NAMES = ("Head", "Neck", "Jaw", "Eye", "Hand", "Foot", "Toe")
"""What is in the names of joints that move skin, hair or shoes, not cloth."""


def build_layers(labels: Labels, template: PosedTemplate, rig: Rig, face: Face | None = None) -> list[Layer]:
    """The body comes first, its head by its `face` if there is one. Then come legs out from under its cloth, each limb
    that is apart and large enough, and those that are not seen. `labels`: taken apart (`Labels.layered`)."""
    beneath = legs_beneath(labels, template, rig)
    legs = [leg.limb for leg in beneath]
    apart = [int(limb) for limb in labels.apart
             if limb not in legs and largest_piece(labels.labels == limb).sum() >= MIN_LIMB_PIXELS]  # fmt: skip
    unseen = unseen_limbs(labels, template, rig)
    region, limbs = find_regions(labels, apart, template, rig, [one.limb for one in unseen])
    cloth = labels.cloth
    parting = labels.parting & (not any(limb in LEG_LABELS for limb in apart))
    parting[: cloth.rings[-1].row + 1 if cloth else 0] = False
    body = replace(layer_of(region, template, rig, face), cut=cut_along(labels.labels, parting))
    body = each_by_its_own(body, labels.labels, parting, rig)
    if cloth:
        body = moved_by_both(drape(body, cloth), cloth, rig, body)
    layers = []
    solid = solid_arms(template, rig)
    for leg in beneath:
        own = labels.labels == leg.limb
        below = leg.mask & (cloth.legs >= 0) if cloth and cloth.legs is not None else own
        under = overlap_beneath(going_with(layer_of(leg, template, rig), body, below), body, own)
        layers.append(replace(under, limb=leg.limb))
    if cloth and cloth.before is not None:
        layers = _leg_behind(layers, cloth.before, labels)
    for one in limbs:
        own = labels.labels == one.limb
        if one.limb in solid and not (labels.hidden == one.limb).any():
            limb = _solid_layer(solid_limb(one.triangles, one.mask, template, rig, own))
        else:
            limb = hand_beneath(layer_of(one, template, rig), body, labels.hidden == one.limb)
        body = body_behind(body, limb, own)
        if one.limb in LEG_LABELS:
            body = body_within(body, limb, own & one.joint)
        limb = limb_before(limb, body, own)
        if limb.solid is None:
            beneath_it = overlap_beneath(limb, body, own, one.behind)
        else:
            beneath_it = _solid_beneath(limb, body, own | ~one.joint)
        layers.append(replace(beneath_it, limb=one.limb))
    layers += [_unseen_layer(one, [body, *layers], labels, template, rig) for one in unseen]
    if labels.behind is not None:
        layers = arm_behind_the_other(layers, body, labels.behind, labels)
    return [body, *layers]


def arm_behind_the_other(layers: Sequence[Layer], body: Layer, behind: Behind, labels: Labels) -> list[Layer]:
    """The layers of limbs with the arm that goes on `behind` the other beneath its surface there."""
    found = list(layers)
    place = {layer.limb: k for k, layer in enumerate(found)}
    other = OPPOSITE_LABEL[behind.limb]
    if {behind.limb, other} <= set(place):
        before = found[place[other]]
        hidden = behind.area & (labels.labels == other)
        moved = _where_it_lies(limb_behind(found[place[behind.limb]], before, hidden))
        found[place[behind.limb]] = moved
        if before.solid is None:
            found[place[other]] = limb_around(before, moved, body, hidden)
    return found


def _leg_behind(legs: Sequence[Layer], before: int, labels: Labels) -> list[Layer]:
    """Legs that come out from under cloth, the one that another is `before` behind that one."""
    front = [leg for leg in legs if leg.limb == before]
    shown = labels.labels == before
    return [leg if leg.limb == before or not front else limb_behind(leg, front[0], shown) for leg in legs]


def layer_of(region: Region, template: PosedTemplate, rig: Rig, face: Face | None = None) -> Layer:
    """A region's front and back. `face` changes the front's warp."""
    sides = template.sides(region.triangles, region.mask.shape)
    warp = warp_part(region.mask, sides.front.mask)
    bare = np.array([any(part in name for part in BARE_JOINT_NAMES) for name in rig.names])

    def rebuilt(own: Warp, side: SideMaps) -> Surface:
        weights = weights_at(side.raster, sides.triangles, rig.bones, rig.weights, len(rig.names))
        return part_surface(region.mask, own, side, weights, bare)

    with ThreadPoolExecutor(1, thread_name_prefix="back") as beside:
        back = beside.submit(rebuilt, warp, sides.back)
        front = rebuilt(warp if face is None else with_face(warp, face), sides.front)
    return Layer(region.mask, front, back.result())


def _solid_layer(limb: SolidLimb) -> Layer:
    """A limb that is the template's, and the pixels that it covers."""
    unused = np.zeros((*limb.front.shape, 0), np.float32)
    return Layer(np.isfinite(limb.front), Surface(limb.front, unused), Surface(limb.back, unused), solid=limb)


def _where_it_lies(layer: Layer) -> Layer:
    """A layer of which all that is solid has come to where its depths are."""
    if layer.solid is None:
        return layer
    everywhere = np.ones(len(layer.solid.vertices), np.bool_)
    return replace(layer, solid=layer.solid.moved(layer.front.depth, layer.back.depth, everywhere))


def _unseen_layer(one: UnseenLimb, layers: Sequence[Layer], labels: Labels, template: PosedTemplate, rig: Rig) -> Layer:
    """A limb that is not seen, in the colours of the other side's, behind all that is seen before it: the body, first of the
    `layers`, and limbs."""
    other = OPPOSITE_LABEL[one.limb]
    own, chosen = labels.labels == other, (vertex_parts(rig)[template.triangles] == other).any(1)
    whole = next((layer.mask for layer in layers if layer.limb == other and layer.solid is None), largest_piece(own))
    like = solid_limb(chosen, whole, template, rig, own | (labels.hidden == other))
    limb = solid_limb(one.triangles, one.mask, template, rig, np.zeros_like(own))
    layer = replace(_solid_layer(replace(limb, like=like)), limb=one.limb)
    apart = [before.limb for before in layers[1:]]
    for before in layers:
        hides = labels.labels == before.limb if before.limb >= 0 else ~np.isin(labels.labels, apart)
        layer = limb_behind(layer, before, hides)
    return _where_it_lies(layer)


def _solid_beneath(limb: Layer, body: Layer, own: NDArray[np.bool_]) -> Layer:
    """A solid limb where its layer has come, and of its pixels that are not its `own` (h, w) the upper arm's beneath the body's
    surface: nothing else of it overlaps with the body."""
    solid = _where_it_lies(limb).solid
    assert solid is not None
    beneath = overlap_beneath(limb, body, own)
    return replace(beneath, solid=solid.moved(beneath.front.depth, beneath.back.depth, solid.upper))
