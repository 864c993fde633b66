"""The person taken apart: the body, and each arm that passes before it, each a surface with a front and a back.

The paper's sections 4.2.2 and 4.2.3. Around the shoulder the arm and the body both have what is there, of the template and
of the picture: as the arm is lifted, neither shows a gap. Beyond the paper, so is a leg that crosses before the other.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.body.parts import PARTS, vertex_parts
from engine.body.rig import Rig
from engine.character.drape import drape
from engine.character.face_warp import Face, with_face
from engine.character.free_cloth import free_cloth
from engine.character.labels import (
    ARMS,
    LEGS,
    complete_labels,
    hair_beside_arms,
    refined_labels,
    rough_labels,
    without_specks,
)
from engine.character.legs import LEGS_APART, as_the_template, beside_the_other, cut_along, each_by_its_own, leg_before
from engine.character.occlusion import completed, largest, occlusion_mask, occlusion_pixels, rest_places
from engine.character.part_surface import Surface, part_surface, warp_part
from engine.character.pockets import HandAtHip, parted, template_hand, with_hand_parted
from engine.character.sheets import THINNEST, Layer
from engine.character.skirt_weights import moved_by_both
from engine.character.template_maps import SideMaps, side_maps, weights_at
from engine.render.attributes import interpolate

SHOULDER, HIP = 0.105, 0.125
"""Metres around the joint in which arm or leg and the body overlap."""
UNDER = 3
"""Pixels by which the body goes on behind an arm everywhere: what lies between two borders of pixels would gape."""
FLESH = 0.02
"""Metres from the outline of the template's leg, within which it may be wider than the person's."""
WHOLE = 0.9
"""Share of an arm in one piece, below which the other arm is taken to pass before it."""
THIN = 0.5
"""Share of its depth that the body keeps behind an arm, at least."""
FORTH = 16.0
"""Pixels by which an arm may come forth."""
GENTLY = 6
"""Pixels over which an arm bends to where it passes before the body."""
BENEATH = 1.5
"""Pixels by which what overlaps lies beneath the body's surface."""
MOSTLY, FOREARM = 90.0, 50.0
"""Percent of a hidden hand that lies beneath the body's surface without being flattened, and pixels over which the arm
bends to it."""
BARE = ("Head", "Neck", "Jaw", "Eye", "Hand", "Foot", "Toe")
"""What is in the names of joints that move skin, hair or shoes, not cloth."""
LEAST = 50
"""Pixels of an arm that is worth being a part of its own."""


@dataclass(frozen=True)
class PosedTemplate:
    """The fitted template on the grid on which a character is made.

    `vertices` (V, 3) in picture space and `rest` (V, 3) in T-pose, metres; `triangles` (T, 3); `joints` (J, 3) in picture
    space and `rest_joints` (J, 3); `pixels_per_metre`.
    """

    vertices: NDArray[np.float64]
    rest: NDArray[np.float32]
    triangles: NDArray[np.int32]
    joints: NDArray[np.float64]
    rest_joints: NDArray[np.float32]
    pixels_per_metre: float


@dataclass(frozen=True)
class Labels:
    """`labels` (h, w) int8: indices of `engine.body.parts.PARTS`, -1 outside the person; `occlusion` (h, w): where
    limbs pass before others; `apart`: those that do, a leg that crosses before the other first, then arms; `parting`
    (h, w): where one leg touches the other and is not joined to it; `hidden` (h, w) int8: the arm whose hand is in a pocket
    there, or behind other cloth, -1 elsewhere."""

    labels: NDArray[np.int8]
    occlusion: NDArray[np.bool_]
    apart: NDArray[np.int8]
    parting: NDArray[np.bool_]
    hidden: NDArray[np.int8]


def label_parts(
    rgb: NDArray[np.uint8],
    mask: NDArray[np.bool_],
    template: PosedTemplate,
    rig: Rig,
    given: NDArray[np.int8] | None = None,
    corrected: Callable[[NDArray[np.int8]], NDArray[np.int8]] = lambda labels: labels,
    sure: NDArray[np.int8] | None = None,
    at_hips: Sequence[HandAtHip] = (),
) -> Labels:
    """Label the person's pixels (h, w), on the grid. `given` (h, w) labels take the place of those that are found, and
    where nothing is given, those that are `sure` (h, w; -1 where nothing is) that of the template's; hands `at_hips`
    that were not found are looked for there; `corrected` has the last word."""
    part_of = vertex_parts(rig)[template.triangles[:, 0]]
    seen = side_maps(template.vertices, template.triangles, (mask.shape[0], mask.shape[1]), "front")
    projected = np.where(seen.mask, part_of[seen.raster.triangle], -1)
    rest = interpolate(template.rest, template.triangles, seen.raster)
    hidden = np.full(mask.shape, -1, np.int8)

    def before(labels: NDArray[np.integer]) -> int | None:
        return leg_before(labels, template.joints, rig, template.pixels_per_metre)

    if given is not None:
        rough = complete_labels(mask, given)
    else:
        known = np.full(mask.shape, -1, np.int8) if sure is None else np.where(mask, sure, -1)
        rough = rough_labels(mask, np.where(known >= 0, known, projected))
        rough = np.where(known >= 0, known, rough)
        rough = hair_beside_arms(rgb, rough, projected, known)
        around = _occluded(rough, projected, rest, hidden).occlusion
        rough = refined_labels(rgb, rough, around)
        if (leg := before(rough)) is not None:
            rough = as_the_template(rough, projected, leg)
        rough = without_specks(rough, known)
        for hand in at_hips:
            own = template_hand(template.vertices, template.triangles, rig, hand.arm, (mask.shape[0], mask.shape[1]))
            if (found := parted(rgb, rough, own, hand)) is not None:
                rough = without_specks(with_hand_parted(rough, found, hand.arm), known)
                hidden[found.hidden] = hand.arm
    labels = corrected(rough.astype(np.int8))
    hidden[labels != rough] = -1  # whoever paints there has seen what is there
    return _occluded(labels, projected, rest, hidden, before(labels))


def _occluded(
    labels: NDArray[np.integer],
    projected: NDArray[np.integer],
    rest: NDArray[np.float32],
    hidden: NDArray[np.int8],
    before: int | None = None,
) -> Labels:
    """Labels with what they say of limbs before others, and where hands are `hidden` (h, w); `before`: the leg that passes
    before the other."""
    places = [rest_places(labels, part, projected, rest) for part in range(len(PARTS))]
    pixels = {arm: occlusion_pixels(labels, arm, places) for arm in ARMS}
    left, right = (PARTS.index(f"{side}_leg") for side in ("left", "right"))
    parting = np.zeros(labels.shape, np.bool_)
    for leg, other in ((left, right), (right, left)):
        only = [where if part in (left, right) else np.full_like(where, np.nan) for part, where in enumerate(places)]
        parting |= occlusion_pixels(np.where(np.isin(labels, (leg, other)), labels, -1), leg, only, LEGS_APART)
    if before is not None:
        pixels = {before: beside_the_other(labels, before)} | pixels
    return Labels(
        labels.astype(np.int8),
        occlusion_mask(np.logical_or.reduce(list(pixels.values()))),
        np.array([limb for limb, where in pixels.items() if where.any() or (hidden == limb).any()], np.int8),
        parting,
        hidden,
    )


def build_layers(
    mask: NDArray[np.bool_], found: Labels, template: PosedTemplate, rig: Rig, face: Face | None = None
) -> list[Layer]:
    """The body first, its head by its `face` if there is one; then each limb that is apart and large enough."""
    apart = [int(arm) for arm in found.apart if largest(found.labels == arm).sum() >= LEAST]
    crossed = [limb for limb in apart if limb in LEGS]
    part = vertex_parts(rig)[template.triangles]
    near = {arm: _near_joint(arm, template, rig, mask.shape) for arm in apart}
    of_body: NDArray[np.bool_] = np.asarray(~np.isin(part, apart)).any(1)  # type: ignore[assignment]
    for triangles, _ in near.values():
        of_body = np.asarray(of_body | triangles)
    arms = np.isin(found.labels, apart)
    before = np.isin(found.labels, crossed)
    # at the sides of the hips one of body and leg alone is seen
    inner = cv2.erode(mask.astype(np.uint8), np.ones((3, 3), np.uint8), iterations=UNDER) > 0
    limbs = {arm: _limb(arm, found, mask, template, near[arm][1], arms, part) for arm in apart}
    for leg in crossed:
        limbs[leg] = largest(limbs[leg] & (inner | before))
    lost = arms & ~np.logical_or.reduce([np.zeros_like(mask), *limbs.values()])
    visible = mask & (~arms | lost)
    body = largest(visible)
    sides = _sides(template, of_body, mask.shape)
    if apart:
        for leg in crossed:
            visible = visible | (before & _bone(sum(LEGS) - leg, template, part, mask.shape))
        body = completed(visible, arms & ~lost, found.occlusion | before, sides.front.mask)
        under = cv2.dilate(body.astype(np.uint8), np.ones((3, 3), np.uint8), iterations=UNDER) > 0
        beside = cv2.dilate(body.astype(np.uint8), np.ones((3, 3), np.uint8)) > 0
        body = body | (arms & np.where(before, beside, under))
        for _, pixels in near.values():
            body = largest(body | (arms & pixels & (inner | ~before)))
    clothed = np.asarray(of_body | np.isin(part, crossed).any(1))
    whole = _sides(template, clothed, mask.shape) if crossed else sides
    shown = np.where(whole.front.mask, part[:, 0][clothed][whole.front.raster.triangle], -1)
    cloth = (body | before) & ~np.isin(found.labels, [arm for arm in ARMS if arm not in apart])
    around_legs = free_cloth(cloth, shown, whole.front.depth, whole.back.depth, found.parting)
    if crossed and around_legs and around_legs.hangs:  # what goes round both legs is one piece with them
        return build_layers(mask, replace(found, apart=np.setdiff1d(found.apart, crossed)), template, rig, face)
    parting = np.zeros_like(mask) if crossed else found.parting.copy()
    parting[: around_legs.rings[-1].row + 1 if around_legs else 0] = False
    trunk = _layer(body, sides, rig, cut_along(found.labels, parting), face)
    trunk = each_by_its_own(trunk, found.labels, parting, rig)
    if around_legs:
        trunk = moved_by_both(drape(trunk, around_legs), around_legs, rig)
    layers = [trunk]
    for arm, reached in limbs.items():
        both = _sides(template, np.asarray((part == arm).any(1) | near[arm][0]), mask.shape)
        limb = _put_in(_layer(reached, both, rig), layers[0], found.hidden == arm)
        own = found.labels == arm
        layers[0] = _behind(layers[0], limb, own)
        if arm in LEGS:
            layers[0] = _within(layers[0], limb, own & near[arm][1])
        layers.append(_sunk(_before(limb, layers[0], own), layers[0], own))
    return layers


def _limb(
    arm: int,
    found: Labels,
    mask: NDArray[np.bool_],
    template: PosedTemplate,
    shoulder: NDArray[np.bool_],
    arms: NDArray[np.bool_],
    part: NDArray[np.intp],
) -> NDArray[np.bool_]:
    """The pixels (h, w) of an arm in one piece: what is seen of it, what it shares with the body around the shoulder, and,
    where the other arm passes before it or it does not reach the shoulder, what the template has there; and its hidden hand."""
    own = found.labels == arm
    reach = np.ones((3, 3), np.uint8)
    beside = cv2.dilate(own.astype(np.uint8), reach, iterations=round(SHOULDER / 2 * template.pixels_per_metre)) > 0
    seen = own | (mask & shoulder & beside)
    piece = largest(seen)
    torn, lost = piece.sum() < WHOLE * seen.sum(), not (piece & shoulder).any()
    if torn or lost:
        hidden = side_maps(
            template.vertices, template.triangles[(part == arm).all(1)], (mask.shape[0], mask.shape[1]), "front"
        )
        between = cv2.dilate(hidden.mask.astype(np.uint8), reach, iterations=UNDER) > 0
        seen = seen | (between & (mask if lost else arms))
    return largest(seen | (found.hidden == arm))


def _bone(leg: int, template: PosedTemplate, part: NDArray[np.intp], shape: Sequence[int]) -> NDArray[np.bool_]:
    """The pixels (h, w) surely inside of a leg of the template, whatever is before it: what joins the leg's pieces. Its outline
    is left to what is seen above and below."""
    whole = side_maps(template.vertices, template.triangles[(part == leg).all(1)], (shape[0], shape[1]), "front").mask
    depth = np.asarray(cv2.distanceTransform(whole.astype(np.uint8), cv2.DIST_L2, 5))
    return depth > FLESH * template.pixels_per_metre


def _near_joint(
    arm: int, template: PosedTemplate, rig: Rig, shape: Sequence[int]
) -> tuple[NDArray[np.bool_], NDArray[np.bool_]]:
    """The template's triangles (T,), and the grid's pixels (h, w), around an arm's shoulder or a leg's hip."""
    side = "Left" if PARTS[arm].startswith("left") else "Right"
    bone, reach = ("Arm", SHOULDER) if arm in ARMS else ("UpLeg", HIP)
    joint = rig.index(f"{side}{bone}")
    close = np.linalg.norm(template.rest - template.rest_joints[joint], axis=1) < reach
    y, x = np.mgrid[: shape[0], : shape[1]]
    distance = np.hypot(x - template.joints[joint, 0], y - template.joints[joint, 1])
    return close[template.triangles].all(1), distance < reach * template.pixels_per_metre


@dataclass(frozen=True)
class _Sides:
    """Some triangles (T, 3) of the template, seen from both sides."""

    triangles: NDArray[np.int32]
    front: SideMaps
    back: SideMaps


def _sides(template: PosedTemplate, chosen: NDArray[np.bool_], shape: Sequence[int]) -> _Sides:
    triangles, size = template.triangles[chosen], (shape[0], shape[1])
    front, back = (side_maps(template.vertices, triangles, size, side) for side in ("front", "back"))
    return _Sides(triangles, front, back)


def _layer(
    mask: NDArray[np.bool_],
    sides: _Sides,
    rig: Rig,
    cut: NDArray[np.int8] | None = None,
    face: Face | None = None,
) -> Layer:
    warp = warp_part(mask, sides.front.mask)
    bare = np.array([any(part in name for part in BARE) for name in rig.names])
    front, back = (
        part_surface(
            mask, own, side, weights_at(side.raster, sides.triangles, rig.bones, rig.weights, len(rig.names)), bare
        )
        for own, side in ((warp if face is None else with_face(warp, face), sides.front), (warp, sides.back))
    )
    return Layer(mask, front, back, np.zeros(mask.shape, np.int8) if cut is None else cut)


def _sunk(limb: Layer, body: Layer, own: NDArray[np.bool_]) -> Layer:
    """A limb whose pixels that are not its `own` (h, w), those of the overlap, lie just beneath the body's surface: there
    they are not seen until the limb is lifted. What of it is further than the body's back passes behind and stays."""
    behind = (limb.front.depth + limb.back.depth) / 2 < body.back.depth
    over = body.mask & limb.mask & ~own & ~behind
    front, back = limb.front.depth.copy(), limb.back.depth.copy()
    front[over] = np.minimum(front, _drawn(body) - BENEATH)[over]
    back[over] = np.minimum(np.maximum(back, body.back.depth + BENEATH), front - 2 * THINNEST)[over]
    return replace(limb, front=Surface(front, limb.front.weights), back=Surface(back, limb.back.weights))


def _put_in(limb: Layer, body: Layer, hidden: NDArray[np.bool_]) -> Layer:
    """A limb with its `hidden` hand (h, w) beneath the body's surface; the forearm bends to where it is."""
    hand = hidden & limb.mask & body.mask
    if not hand.any():
        return limb
    further = max(float(np.percentile((limb.front.depth - _drawn(body) + BENEATH)[hand], MOSTLY)), 0.0)
    away = np.asarray(cv2.distanceTransform((~hand).astype(np.uint8), cv2.DIST_L2, 5))
    bent = further * (0.5 + 0.5 * np.cos(np.pi * np.minimum(away / FOREARM, 1)))
    front, back = (Surface((side.depth - bent).astype(np.float32), side.weights) for side in (limb.front, limb.back))
    return replace(limb, front=front, back=back)


def _behind(body: Layer, limb: Layer, own: NDArray[np.bool_]) -> Layer:
    """The body with its front beneath the limb's where the limb is seen (`own` (h, w)) and so hides it; at most as deep as
    leaves it `THIN`. Where the limb is behind the middle and shows beside the body, the body was thought to go on too far."""
    hidden = body.mask & limb.mask & own
    middle = (body.front.depth + body.back.depth) / 2
    reach = _drawn(limb) - BENEATH
    shown = body.mask & ~own
    beside = cv2.dilate(shown.astype(np.uint8), np.ones((3, 3), np.uint8)) > 0  # or what is between pixels would gape
    mask = largest(body.mask & ~(hidden & (reach < middle) & ~_between(shown) & ~beside))
    front = body.front.depth.copy()
    front[hidden] = np.clip(reach, body.back.depth + THIN * (front - body.back.depth), front)[hidden]
    return replace(body, mask=mask, front=Surface(front, body.front.weights))


def _within(body: Layer, limb: Layer, shared: NDArray[np.bool_]) -> Layer:
    """The body with its back, too, beneath the limb's where both have the hip (`shared` (h, w))."""
    inside = np.clip(limb.back.depth + BENEATH, body.back.depth, body.front.depth - 2 * THINNEST)
    back = np.where(shared & body.mask & limb.mask, inside, body.back.depth)
    return replace(body, back=Surface(back, body.back.weights))


def _before(limb: Layer, body: Layer, own: NDArray[np.bool_]) -> Layer:
    """The limb before the body where it is seen (`own` (h, w)) and has to come no further than `FORTH`: what the picture shows
    is before what it does not show. One that would have to come further passes behind."""
    further = np.maximum(body.front.depth + BENEATH - _drawn(limb), 0)
    needed = np.where(body.mask & limb.mask & own & (further < FORTH), further, 0).astype(np.float32)
    around = np.ones((4 * GENTLY + 1, 4 * GENTLY + 1), np.uint8)
    wide = np.where(limb.mask, cv2.dilate(needed, around), 0).astype(np.float32)
    share = cv2.GaussianBlur(limb.mask.astype(np.float32), (0, 0), GENTLY)
    nearer = np.maximum(needed, cv2.GaussianBlur(wide, (0, 0), GENTLY) / np.maximum(share, 1e-3))
    front, back = (Surface(side.depth + nearer, side.weights) for side in (limb.front, limb.back))
    return replace(limb, front=front, back=back)


def _between(mask: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """What has some of the mask on its left and right, or above and below."""
    sides = []
    for axis in (0, 1):
        before = np.logical_or.accumulate(mask, axis=axis)
        after = np.flip(np.logical_or.accumulate(np.flip(mask, axis), axis=axis), axis)
        sides.append(before & after)
    return np.asarray(sides[0] | sides[1])


def _drawn(layer: Layer) -> NDArray[np.float32]:
    """How far towards the viewer a layer's mesh surely reaches at each of its pixels: at its border both sides meet."""
    middle = (layer.front.depth + layer.back.depth) / 2
    inside = cv2.erode(layer.mask.astype(np.uint8), np.ones((3, 3), np.uint8), borderValue=0) > 0
    reaches = np.where(inside, layer.front.depth, middle)
    reaches = np.where(layer.mask, reaches, np.inf).astype(np.float32)
    return np.asarray(cv2.erode(reaches, np.ones((3, 3), np.uint8), borderType=cv2.BORDER_REPLICATE), np.float32)
