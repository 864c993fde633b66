"""Which of two surfaces lies before the other where both cover a pixel: a limb before the body that it hides, what they share
beneath the body.

The paper's section 4.2.3. Beyond it, hands in pockets.
"""

from __future__ import annotations

from dataclasses import replace

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.character.surface.front_and_back import MIN_HALF_DEPTH_PIXELS, Layer
from engine.character.surface.part_surface import Surface
from engine.imaging.masks.mask_distance import dilate_mask, distance_to
from engine.imaging.masks.mask_pieces import largest_piece

MIN_BODY_DEPTH_SHARE = 0.5
"""Share of its depth that the body keeps behind a limb, at least."""
MAX_FORWARD_PIXELS = 16.0
"""Pixels by which a limb may come forth."""
LIMB_BEND_PIXELS = 6
"""Pixels over which a limb bends to where it passes before the body."""
INSET_PIXELS = 1.5
"""Pixels by which what overlaps lies beneath the body's surface."""
HIDDEN_HAND_PERCENTILE, FOREARM_BEND_PIXELS = 90.0, 50.0
"""Percent of a hidden hand that lies beneath the body's surface without being flattened, and pixels over which the arm
bends to it."""


def hand_beneath(arm: Layer, body: Layer, hidden: NDArray[np.bool_]) -> Layer:
    """An arm with its `hidden` hand (h, w) beneath the body's surface; the forearm bends to where it is."""
    hand = hidden & arm.mask & body.mask
    if not hand.any():
        return arm
    further = max(
        float(np.percentile((arm.front.depth - _reach(body) + INSET_PIXELS)[hand], HIDDEN_HAND_PERCENTILE)), 0.0
    )
    away = distance_to(hand)
    bent = further * (0.5 + 0.5 * np.cos(np.pi * np.minimum(away / FOREARM_BEND_PIXELS, 1)))
    front, back = (Surface((side.depth - bent).astype(np.float32), side.weights) for side in (arm.front, arm.back))
    return replace(arm, front=front, back=back)


def body_behind(body: Layer, limb: Layer, own: NDArray[np.bool_]) -> Layer:
    """The body with its front beneath the limb's where the limb is seen (`own` (h, w)) and so hides it; at most as deep as
    leaves it `MIN_BODY_DEPTH_SHARE`. Where the limb is behind the middle and shows beside the body, the body was thought to
    go on too far."""
    hidden = body.mask & limb.mask & own
    middle = (body.front.depth + body.back.depth) / 2
    reach = _reach(limb) - INSET_PIXELS
    shown = body.mask & ~own
    beside = dilate_mask(shown, 1)  # or what is between pixels would gape
    mask = largest_piece(body.mask & ~(hidden & (reach < middle) & ~_between(shown) & ~beside))
    front = body.front.depth.copy()
    front[hidden] = np.clip(reach, body.back.depth + MIN_BODY_DEPTH_SHARE * (front - body.back.depth), front)[hidden]
    return replace(body, mask=mask, front=Surface(front, body.front.weights))


def body_within(body: Layer, limb: Layer, shared: NDArray[np.bool_]) -> Layer:
    """The body with its back, too, beneath the limb's where both have the joint (`shared` (h, w))."""
    inside = np.clip(limb.back.depth + INSET_PIXELS, body.back.depth, body.front.depth - 2 * MIN_HALF_DEPTH_PIXELS)
    back = np.where(shared & body.mask & limb.mask, inside, body.back.depth)
    return replace(body, back=Surface(back, body.back.weights))


def limb_before(limb: Layer, body: Layer, own: NDArray[np.bool_]) -> Layer:
    """The limb before the body where it is seen (`own` (h, w)) and has to come no further than `MAX_FORWARD_PIXELS`:
    what the picture shows is before what it does not show. One that would have to come further passes behind."""
    further = np.maximum(body.front.depth + INSET_PIXELS - _reach(limb), 0)
    needed = np.where(body.mask & limb.mask & own & (further < MAX_FORWARD_PIXELS), further, 0).astype(np.float32)
    return _moved(limb, _gently(needed, limb.mask))


def limb_behind(limb: Layer, before: Layer, hidden: NDArray[np.bool_]) -> Layer:
    """The limb as far back as it has to be where another before it hides it (`hidden` (h, w)), as thick as it was."""
    further = np.maximum(limb.front.depth + INSET_PIXELS - _reach(before), 0)
    needed = np.where(before.mask & limb.mask & hidden, further, 0).astype(np.float32)
    return _moved(limb, -_gently(needed, limb.mask))


def limb_around(before: Layer, limb: Layer, body: Layer, hidden: NDArray[np.bool_]) -> Layer:
    """The limb with its back as far behind as it has to be where it hides another (`hidden` (h, w)) and no body is behind: a hand
    that is tucked away is not seen from behind either."""
    further = np.maximum(before.back.depth - limb.back.depth + INSET_PIXELS, 0)
    needed = np.where(before.mask & limb.mask & hidden & ~body.mask, further, 0).astype(np.float32)
    back = np.asarray(before.back.depth - _gently(needed, before.mask), np.float32)
    return replace(before, back=Surface(back, before.back.weights))


def _gently(needed: NDArray[np.float32], mask: NDArray[np.bool_]) -> NDArray[np.float32]:
    """Pixels (h, w) by which a limb moves in depth, no less than `needed`, spread within its mask: it bends, but is not torn."""
    around = np.ones((4 * LIMB_BEND_PIXELS + 1, 4 * LIMB_BEND_PIXELS + 1), np.uint8)
    wide = np.where(mask, cv2.dilate(needed, around), 0).astype(np.float32)
    share = cv2.GaussianBlur(mask.astype(np.float32), (0, 0), LIMB_BEND_PIXELS)
    return np.maximum(needed, cv2.GaussianBlur(wide, (0, 0), LIMB_BEND_PIXELS) / np.maximum(share, 1e-3)).astype(
        np.float32
    )


def _moved(limb: Layer, nearer: NDArray[np.float32]) -> Layer:
    front, back = (Surface(side.depth + nearer, side.weights) for side in (limb.front, limb.back))
    return replace(limb, front=front, back=back)


def overlap_beneath(limb: Layer, body: Layer, own: NDArray[np.bool_], deep: bool = False) -> Layer:
    """A limb whose pixels that are not its `own` (h, w), those of the overlap, lie just beneath the body's surface: there
    they are not seen until the limb is lifted. One that passes behind lies `deep`, no further forth than the body's middle. What
    of it is further than the body's back stays."""
    behind = (limb.front.depth + limb.back.depth) / 2 < body.back.depth
    over = body.mask & limb.mask & ~own & ~behind
    front, back = limb.front.depth.copy(), limb.back.depth.copy()
    most = _reach(body) - INSET_PIXELS
    if deep:
        most = np.minimum(most, (body.front.depth + body.back.depth) / 2)
    front[over] = np.minimum(front, most)[over]
    back[over] = np.minimum(np.maximum(back, body.back.depth + INSET_PIXELS), front - 2 * MIN_HALF_DEPTH_PIXELS)[over]
    return replace(limb, front=Surface(front, limb.front.weights), back=Surface(back, limb.back.weights))


def _reach(layer: Layer) -> NDArray[np.float32]:
    """How far towards the viewer a layer's mesh surely reaches at each of its pixels: at its border both sides meet."""
    middle = (layer.front.depth + layer.back.depth) / 2
    inside = cv2.erode(layer.mask.astype(np.uint8), np.ones((3, 3), np.uint8), borderValue=0) > 0
    reaches = np.where(inside, layer.front.depth, middle)
    reaches = np.where(layer.mask, reaches, np.inf).astype(np.float32)
    return np.asarray(cv2.erode(reaches, np.ones((3, 3), np.uint8), borderType=cv2.BORDER_REPLICATE), np.float32)


def _between(mask: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """What has some of the mask on its left and right, or above and below."""
    sides = []
    for axis in (0, 1):
        before = np.logical_or.accumulate(mask, axis=axis)
        after = np.flip(np.logical_or.accumulate(np.flip(mask, axis), axis=axis), axis)
        sides.append(before & after)
    return np.asarray(sides[0] | sides[1])
