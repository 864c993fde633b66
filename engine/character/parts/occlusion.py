"""Where a limb passes before the rest of the body, and the body completed behind it.

The paper's occlusion mask (section 4.2.1) and occluded region construction (4.2.2).
"""

from __future__ import annotations

from collections.abc import Sequence

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.geometry.boundary_matching import match_boundaries
from engine.geometry.deformation.mean_value_coordinates import mean_value_warp
from engine.imaging.filling.nearest import nearest_in
from engine.imaging.masks.mask_distance import dilate_mask, distance_to
from engine.imaging.masks.mask_pieces import largest_piece, outline, pieces_by_area

NEIGHBOUR_DISTANCE_METRES = 0.16
"""Metres at rest within which two points of the template are near each other on its surface."""
OCCLUSION_DILATION_SHARE = 0.02
"""By how much the occlusion pixels are dilated, as a share of the picture's height."""
MAX_GAP_WIDTH_SHARE = 0.08
"""How far the body may be hidden behind a limb, from what is seen on one of its sides to what is seen on the other, as
a share of the picture's height."""
MIN_VISIBLE_PIECE_SHARE = 0.005
"""Share of what is seen below which a piece of it is not missed."""
MIN_OCCLUSION_BORDER_PIXELS = 8
"""Pixels of border that make an occlusion."""


def rest_places(
    labels: NDArray[np.integer], label: int, template: NDArray[np.integer], rest: NDArray[np.float32]
) -> NDArray[np.float32]:
    """The template's point at rest (H, W, 3) that each pixel of a label shows; NaN elsewhere: the paper's f_l.

    `template` (H, W): the projected template's labels; `rest` (H, W, 3): its points at rest.
    """
    found = np.full((*labels.shape, 3), np.nan, np.float32)
    mask, source = largest_piece(labels == label), largest_piece(template == label)
    if mask.sum() < MIN_OCCLUSION_BORDER_PIXELS or source.sum() < MIN_OCCLUSION_BORDER_PIXELS:
        return found
    border, reference = outline(mask), outline(source)
    if len(border) < 4 or len(reference) < 4:
        return found
    partners = reference[match_boundaries(border, reference)]
    edge = _border(mask)
    ys, xs = np.nonzero(edge)
    places = np.rint(mean_value_warp(np.stack([xs, ys], 1), border, partners)).astype(int)
    x, y = np.clip(places[:, 0], 0, mask.shape[1] - 1), np.clip(places[:, 1], 0, mask.shape[0] - 1)
    rows, columns = nearest_in(source)
    found[ys, xs] = rest[rows[y, x], columns[y, x]]
    return found


def occlusion_pixels(
    labels: NDArray[np.integer],
    limb: int,
    places: Sequence[NDArray[np.float32]],
    near: float = NEIGHBOUR_DISTANCE_METRES,
) -> NDArray[np.bool_]:
    """Pixels of the limb (H, W) beside which another part shows that is not `near`, in metres, on the body's surface.
    `places`: those of each part at rest (`rest_places`)."""
    found = np.zeros(labels.shape, np.bool_)
    rows, columns = np.nonzero(labels == limb)
    for dy, dx in ((0, 1), (0, -1), (1, 0), (-1, 0)):
        at = (rows + dy) % labels.shape[0], (columns + dx) % labels.shape[1]
        beside = labels[at]
        for other in set(range(len(places))) & set(np.unique(beside).tolist()) - {limb}:
            here = beside == other
            own = rows[here], columns[here]
            with np.errstate(invalid="ignore"):
                far = np.linalg.norm(places[limb][own] - places[other][at[0][here], at[1][here]], axis=-1) > near
            found[own] |= far
    return found if found.sum() >= MIN_OCCLUSION_BORDER_PIXELS else np.zeros_like(found)


def occlusion_mask(pixels: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """The paper's O: the occlusion pixels and what is around them."""
    radius = max(2, round(OCCLUSION_DILATION_SHARE * pixels.shape[0]))
    disk = cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (2 * radius + 1, 2 * radius + 1))
    return np.asarray(cv2.dilate(pixels.astype(np.uint8), disk) > 0)


def completed(
    visible: NDArray[np.bool_], hidden_by: NDArray[np.bool_], near: NDArray[np.bool_], template: NDArray[np.bool_]
) -> NDArray[np.bool_]:
    """The region B with its spurious borders replaced by the template's (the paper's figure 5, e to g).

    `visible` (H, W): what is seen of the body; `hidden_by`: the limbs before it; `near`: the occlusion mask;
    `template`: what the body has of the projected template. Each run of B's border that lies in the occlusion
    mask beside a limb gives way to the template's border between the partners of its ends, by the similarity transform
    that takes those to its ends. B never shrinks, and grows only behind the limbs.
    """
    body = _one_piece(visible, hidden_by, template)
    border, reference = outline(body), outline(largest_piece(template))
    partners = match_boundaries(border, reference)
    beside = dilate_mask(hidden_by, 1)
    at = border.astype(int)
    spurious = beside[at[:, 1], at[:, 0]] & near[at[:, 1], at[:, 0]]
    wider = body.copy()
    for first, last in _runs(spurious):
        run = np.arange(first, last + 1) % len(border)
        a, b = border[run[0]], border[run[-1]]
        steps = int((partners[run[-1]] - partners[run[0]]) % len(reference))
        curve = reference[(partners[run[0]] + np.arange(steps + 1)) % len(reference)]
        moved = _similarity(curve, a, b)
        if moved is None:
            continue
        # what is worn is wider than the template: it goes on straight, at least
        for replaced in (moved, np.stack([a, b])):
            region = np.zeros(body.shape, np.uint8)
            polygon = np.concatenate([replaced, border[run[::-1]]])
            cv2.fillPoly(region, [np.rint(polygon).astype(np.int32)], (1,))
            wider |= (region > 0) & hidden_by
    return largest_piece(wider)


def _one_piece(
    visible: NDArray[np.bool_], hidden_by: NDArray[np.bool_], template: NDArray[np.bool_]
) -> NDArray[np.bool_]:
    """The body in one connected piece: where a limb cuts it in two, the template says what joins them, and what it does not
    have, as hair, goes on behind the limb from one side to the other."""
    pieces = pieces_by_area(visible, MIN_VISIBLE_PIECE_SHARE * visible.sum())
    if len(pieces) > 1:
        visible = visible | (hidden_by & template)
        pieces = pieces_by_area(visible, MIN_VISIBLE_PIECE_SHARE * visible.sum())
    for piece in pieces[1:]:  # hair on both sides of an arm is not the template's
        way = distance_to(pieces[0]) + distance_to(piece)
        visible = visible | (hidden_by & (way < MAX_GAP_WIDTH_SHARE * visible.shape[0]))
    return largest_piece(visible)


def _runs(flags: NDArray[np.bool_]) -> list[tuple[int, int]]:
    """Runs of true values on a circle as (first, last), last counted on beyond the end where a run goes around it."""
    if flags.all() or not flags.any():
        return []
    start = int(np.flatnonzero(~flags)[0])
    turned = np.roll(flags, -start).astype(np.int8)
    begins, ends = np.flatnonzero(np.diff(turned) == 1) + 1, np.flatnonzero(np.diff(np.append(turned, 0)) == -1)
    return [
        (int(b) + start, int(e) + start)
        for b, e in zip(begins, ends, strict=True)
        if e - b >= MIN_OCCLUSION_BORDER_PIXELS
    ]


def _similarity(
    curve: NDArray[np.float64], a: NDArray[np.float64], b: NDArray[np.float64]
) -> NDArray[np.float64] | None:
    """The curve moved, turned and scaled so that its ends come to a and b; None if it has no length."""
    z = curve @ [1, 1j]
    span = z[-1] - z[0]
    if abs(span) < 2:
        return None
    ends = np.stack([a, b]) @ [1, 1j]
    moved = ends[0] + (z - z[0]) * (ends[1] - ends[0]) / span
    return np.stack([moved.real, moved.imag], 1)


def _border(mask: NDArray[np.bool_]) -> NDArray[np.bool_]:
    return mask & ~(cv2.erode(mask.astype(np.uint8), np.ones((3, 3), np.uint8), borderValue=0) > 0)
