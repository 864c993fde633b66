"""A hole filled with overlapping patches of what is around it.

On a small picture a membrane is stretched over the hole, which is already right for plain grounds, and patches grow into it
from the edge, lines first (`engine.imaging.filling.exemplar_fill`). From there on, coarse to fine, overlapping patches vote (Wexler,
Shechtman, Irani, "Space-time completion of video", PAMI 2007; found by `engine.imaging.filling.patchmatch`). Only a band behind the
hole's edge is filled in full detail; deeper inside the coarse picture stands.
"""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.imaging.filling.continued_lines import continue_lines
from engine.imaging.filling.exemplar_fill import exemplar_fill
from engine.imaging.filling.nearest import nearest_in
from engine.imaging.filling.patchmatch import PATCH_SIDE_PIXELS, PatchField, colour_planes, valid_centres
from engine.imaging.filling.poisson import membrane
from engine.imaging.filling.seams import heal_seams
from engine.imaging.masks.mask_distance import dilate_mask
from engine.imaging.resample import resized

COARSEST_SIDE = 120
"""Longest side, in pixels, of the coarsest picture."""
CONFIDENCE_DECAY = 1.4
"""Factor by which a guessed pixel counts less with each pixel that it lies deeper in the hole."""
MIN_FILLED_REACH_PIXELS = 20.0
"""Pixels filled behind the hole's edge on every level, so that detail fades with depth instead of ending."""


def patch_fill(
    image: NDArray[np.float32], hole: NDArray[np.bool_], source: NDArray[np.bool_], reach: float, seed: int = 0
) -> NDArray[np.float32]:
    """`image` (H, W, 3), grey levels, with `hole` (H, W) filled with patches of its `source` (H, W), which is not empty.

    Lines that end at the hole are drawn on first. What is neither a hole nor a source has no say and stays.

    Parameters
    ----------
    reach : how far behind the hole's edge, in pixels, it is filled in full detail.
    seed : of the randomised search.
    """
    unknown = hole | ~source
    lines = continue_lines(image, unknown, reach)
    found = _fill(lines.picture, unknown & ~lines.painted, hole & ~lines.painted, reach, seed)
    return np.where(hole[..., None], found, image).astype(np.float32)


@dataclass(frozen=True)
class _Level:
    """One picture of the pyramid: 0 is the finest. `hole`: what is not known of it; `wanted`: what of this is asked for."""

    number: int
    picture: NDArray[np.float32]
    hole: NDArray[np.bool_]
    wanted: NDArray[np.bool_]


def _fill(
    image: NDArray[np.float32], hole: NDArray[np.bool_], wanted: NDArray[np.bool_], reach: float, seed: int
) -> NDArray[np.float32]:
    levels = _pyramid(image, hole, wanted)
    coarsest = levels[-1]
    around = coarsest.picture[nearest_in(~coarsest.hole)]  # what is not asked for only has to be plausible
    stretched = membrane(around, coarsest.wanted, cycles=6)
    guess = np.where(coarsest.wanted[..., None], stretched, around).astype(np.float32)
    if (sources := valid_centres(~coarsest.hole)).any():
        filled = coarsest.hole & dilate_mask(coarsest.wanted, PATCH_SIDE_PIXELS)
        guess = exemplar_fill(guess, filled, sources, ~coarsest.hole)
    field: PatchField | None = None
    for level in reversed(levels):
        sources = valid_centres(~level.hole)
        size = (level.hole.shape[1], level.hole.shape[0])
        guess = np.where(level.hole[..., None], resized(guess, size), level.picture).astype(np.float32)
        if not sources.any():
            continue
        depth = np.asarray(cv2.distanceTransform(level.hole.astype(np.uint8), cv2.DIST_L2, 3))
        active = level.wanted & ((depth <= max(reach / 2**level.number, MIN_FILLED_REACH_PIXELS)) | (level is coarsest))
        targets = _centres_over(active)
        field = PatchField.start(targets, sources, seed, field)
        weight = np.where(level.hole, CONFIDENCE_DECAY ** -np.minimum(depth, 40), 1.0).astype(np.float32)
        effort = _effort(len(levels) - 1 - level.number, level)
        guess = _refine(guess, weight, active, field, effort, seed)
        guess = heal_seams(guess, field.nearest, active & targets)
    return guess


def _pyramid(image: NDArray[np.float32], hole: NDArray[np.bool_], wanted: NDArray[np.bool_]) -> list[_Level]:
    """The picture at full size, half, quarter, ...; means of known pixels only, while enough is known."""
    levels = [_Level(0, image, hole, wanted)]
    while max(hole.shape) > COARSEST_SIDE:
        half = (max(1, hole.shape[1] // 2), max(1, hole.shape[0] // 2))
        known = resized((~hole).astype(np.float32), half)
        image = (resized(image * ~hole[..., None], half) / np.maximum(known, 1e-6)[..., None]).astype(np.float32)
        hole = known < 0.5
        wanted = hole & (resized(wanted.astype(np.float32), half) > 0)
        if valid_centres(~hole).sum() < 32:
            break
        levels.append(_Level(len(levels), image, hole, wanted))
    return levels


@dataclass(frozen=True)
class _Effort:
    """How often patches are matched and vote, sweeps each time, random tries a patch, and whether the last vote keeps grain."""

    rounds: int
    sweeps: int
    tries: int
    keep_grain: bool


def _effort(steps: int, level: _Level) -> _Effort:
    """Much where it is cheap and decides about structure; at full size the field only needs settling."""
    if level.number == 0:
        return _Effort(1, 1, 1, True)
    rounds, tries = ((3, 6), (3, 4), (2, 4), (2, 2), (1, 2))[min(steps, 4)]
    return _Effort(rounds, 2, tries, level.number == 1)


def _refine(
    guess: NDArray[np.float32],
    weight: NDArray[np.float32],
    active: NDArray[np.bool_],
    field: PatchField,
    effort: _Effort,
    seed: int,
) -> NDArray[np.float32]:
    """Match and vote in turn; `field` is improved in place."""
    for turn in range(effort.rounds):
        planes = colour_planes(guess)
        field.match(planes, weight, effort.sweeps, effort.tries, seed + turn)
        last = turn == effort.rounds - 1
        sharpness = 0.0 if last and effort.keep_grain else max(float(np.median(field.cost[field.targets])), 4.0)
        guess = field.vote(planes, weight, active, sharpness)
    return guess


def _centres_over(active: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Centres of the patches that touch an active pixel and lie inside the picture."""
    touched = cv2.dilate(active.astype(np.uint8), np.ones((PATCH_SIDE_PIXELS, PATCH_SIDE_PIXELS), np.uint8)) > 0
    return touched & valid_centres(np.ones_like(active))
