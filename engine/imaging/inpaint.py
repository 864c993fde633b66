"""The background plate: the picture as it would be if the person were not there.

Texture by patches that vote, from coarse to fine (Wexler, Shechtman, Irani, "Space-time completion of
video", PAMI 2007; patches found by `engine.imaging.patchmatch`), begun from a membrane stretched over
the hole, which is already right for plain backgrounds. Only a band behind the outline can ever become
visible, so only that is filled in full detail; deeper inside the coarse picture stands.
"""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.imaging.patchmatch import RADIUS, match_patches, valid_centres, vote
from engine.imaging.resample import resized

COARSEST = 48
"""Longest side, in pixels, of the coarsest picture."""

MARGIN = 0.006
"""How far the hole reaches beyond the last trace of the person, as a share of the longer side."""


LEAST_REACH = 20.0
"""Pixels filled behind the outline on every level, so that detail fades with depth instead of ending."""


def background_plate(
    rgb: NDArray[np.uint8], alpha: NDArray[np.float32], reach: float | None = None, seed: int = 0
) -> NDArray[np.uint8]:
    """The picture (H, W, 3) uint8 with the layer of `alpha` (H, W) taken away and filled from around it.

    Parameters
    ----------
    reach : how far behind the outline, in pixels, the plate is filled in full detail (default: a tenth of
        the square root of the layer's area, about what a head that moves by 10% of its size lays bare).
    seed : of the randomised search.

    Pixels away from the layer are unchanged. A layer that covers the whole picture leaves nothing to fill
    from: its plate is the picture's mean colour.
    """
    hole = hole_behind(alpha)
    if not hole.any():
        return rgb.copy()
    if hole.all():
        return np.broadcast_to(rgb.mean((0, 1)).astype(np.uint8), rgb.shape).copy()
    if reach is None:
        reach = 0.1 * float(np.sqrt(alpha.sum()))
    filled = _fill(rgb.astype(np.float32), hole, reach + MARGIN * max(rgb.shape), seed)
    return np.where(hole[..., None], np.clip(filled + 0.5, 0, 255), rgb).astype(np.uint8)


def hole_behind(alpha: NDArray[np.float32]) -> NDArray[np.bool_]:
    """Pixels (H, W) that carry any trace of the layer, with a margin for its soft edge and glow."""
    margin = max(2, round(MARGIN * max(alpha.shape)))
    disk = cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (2 * margin + 1, 2 * margin + 1))
    return np.asarray(cv2.dilate((alpha > 0.02).astype(np.uint8), disk) > 0)


def _fill(image: NDArray[np.float32], hole: NDArray[np.bool_], reach: float, seed: int) -> NDArray[np.float32]:
    pictures, holes = [image], [hole]
    while max(holes[-1].shape) > COARSEST:
        half = (max(1, holes[-1].shape[1] // 2), max(1, holes[-1].shape[0] // 2))
        known = resized((~holes[-1]).astype(np.float32), half)
        mean = resized(pictures[-1] * ~holes[-1][..., None], half) / np.maximum(known, 1e-6)[..., None]
        next_hole = known < 0.5
        if valid_centres(~next_hole).sum() < 32 or next_hole.all():
            break
        pictures.append(mean.astype(np.float32))
        holes.append(next_hole)
    guess = membrane_fill(pictures[-1], holes[-1])
    field: NDArray[np.int32] | None = None
    for level in range(len(pictures) - 1, -1, -1):
        picture, empty = pictures[level], holes[level]
        size = (empty.shape[1], empty.shape[0])
        sources = valid_centres(~empty)
        guess = np.where(empty[..., None], resized(guess, size), picture).astype(np.float32)
        if not sources.any():
            continue
        depth = cv2.distanceTransform(empty.astype(np.uint8), cv2.DIST_L2, 3)
        active = empty & (depth <= max(reach / 2**level, LEAST_REACH)) if level < len(pictures) - 1 else empty
        targets = _centres_over(active)
        weight = np.where(empty, 1.2 ** -np.minimum(depth, 40), 1.0).astype(np.float32)
        field = _start(field, targets, sources, seed)
        guess = _refine(guess, weight, active, targets, sources, field, level, len(pictures) - 1 - level, seed)
    return guess


def _refine(
    guess: NDArray[np.float32],
    weight: NDArray[np.float32],
    active: NDArray[np.bool_],
    targets: NDArray[np.bool_],
    sources: NDArray[np.bool_],
    field: NDArray[np.int32],
    level: int,
    step: int,
    seed: int,
) -> NDArray[np.float32]:
    cost = np.zeros(active.shape, np.float32)
    rounds, sweeps, tries = ((10, 4, 8), (8, 2, 8), (4, 2, 6), (2, 2, 4), (1, 1, 2))[min(step, 4)]
    for turn in range(rounds):
        match_patches(guess, weight, targets, sources, field, cost, sweeps, True, tries, seed + 31 * level + turn)
        sharpness = max(float(np.percentile(cost[targets], 75)), 4.0)
        if turn == rounds - 1:
            sharpness /= 2
        vote(guess.copy(), weight, active, targets, field, cost, sharpness, guess)
    return guess


def _centres_over(active: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Centres of the patches that touch an active pixel and lie inside the picture."""
    side = 2 * RADIUS + 1
    touched = cv2.dilate(active.astype(np.uint8), np.ones((side, side), np.uint8)) > 0
    return touched & valid_centres(np.ones_like(active))


def _start(
    coarse: NDArray[np.int32] | None, targets: NDArray[np.bool_], sources: NDArray[np.bool_], seed: int
) -> NDArray[np.int32]:
    """A first field: that of the coarser picture where it points to a source, else anywhere."""
    random = np.random.default_rng(seed)
    height, width = targets.shape
    ys, xs = np.nonzero(sources)
    pick = random.integers(0, len(ys), (height, width))
    field = np.stack([ys[pick], xs[pick]], -1).astype(np.int32)
    if coarse is not None:
        rows, columns = np.indices((height, width))
        up_y, up_x = np.minimum(rows // 2, coarse.shape[0] - 1), np.minimum(columns // 2, coarse.shape[1] - 1)
        found = coarse[up_y, up_x] * 2 + np.stack([rows - 2 * up_y, columns - 2 * up_x], -1)
        found = np.clip(found, 0, [height - 1, width - 1])
        fits = sources[found[..., 0], found[..., 1]]
        field = np.where(fits[..., None], found, field).astype(np.int32)
    return np.ascontiguousarray(field)


def membrane_fill(image: NDArray[np.float32], hole: NDArray[np.bool_]) -> NDArray[np.float32]:
    """`image` (H, W, C) with the hole covered by a membrane: Laplace's equation, borders free."""
    guess = np.where(hole[..., None], image[~hole].mean(0), image).astype(np.float32)
    for _ in range(4 * max(hole.shape)):
        padded = np.pad(guess, ((1, 1), (1, 1), (0, 0)), mode="edge")
        mean = (padded[:-2, 1:-1] + padded[2:, 1:-1] + padded[1:-1, :-2] + padded[1:-1, 2:]) / 4
        guess = np.where(hole[..., None], mean, image).astype(np.float32)
    return guess
