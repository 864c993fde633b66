"""The one door to fills of holes in pictures and maps: by patches, by whole exemplars, or smoothly."""

from __future__ import annotations

from typing import Literal, TypeVar

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.imaging.filling.exemplar_fill import exemplar_fill
from engine.imaging.filling.harmonic_fill import harmonic_fill
from engine.imaging.filling.nearest import nearest_in
from engine.imaging.filling.patch_fill import patch_fill
from engine.imaging.filling.patchmatch import valid_centres
from engine.imaging.masks.mask_pieces import bounding_box

Method = Literal["patches", "exemplars", "harmonic"]
"""`patches` that overlap and vote, coarse to fine: for pictures of any size. `exemplars`, laid from the edge inward, lines
first: for small pictures, as it tries every one. `harmonic`: each value is the mean of its neighbours, without any detail."""
Values = TypeVar("Values", np.uint8, np.float32)

SOFT_EDGE = 0.006
"""How far colours around a hole are mixed with what was in it, as a share of the longer side."""
MIN_SOFT_EDGE_PIXELS = 2
"""Pixels around a hole in which colours are mixed with what was in it, at least."""


def inpaint(
    image: NDArray[Values],
    hole: NDArray[np.bool_],
    source: NDArray[np.bool_],
    method: Method = "patches",
    *,
    reach: float | None = None,
    margin: int | None = None,
    seed: int = 0,
) -> NDArray[Values]:
    """The picture with its hole filled from what is named as source, and from nothing else.

    Parameters
    ----------
    image : (H, W, 3), uint8 or float32 grey levels; if `harmonic`, (H, W, C) of any unit.
    hole : (H, W), what is filled. All else stays.
    source : (H, W), what may be copied from and must be matched; what is neither hole nor source has no say.
    reach : how far behind its edge, in pixels, a hole is filled with patches in full detail (default: the square root of
        its area).
    margin : pixels around the hole that are no source, either, as its edge is soft (default: as `grown_by_margin` has it).
    seed : of the randomised search for patches.

    Without a hole or a source the picture comes back as it was; where the margin takes all of the source, the hole has
    its mean.
    """
    out = image.copy()
    if not hole.any() or not source.any():
        return out
    box = bounding_box(hole | source)
    part = np.ascontiguousarray(image[box], np.float32)
    share = SOFT_EDGE * max(part.shape[:2]) if margin is None else 0.0
    unclean = grown_by_margin(hole[box], margin)
    known = source[box] & ~unclean
    if not known.any():
        out[hole] = _as(image, image[source].mean(0))
        return out
    if method == "patches":
        reach = float(np.sqrt(hole.sum())) if reach is None else reach
        found = patch_fill(part, unclean, known, reach + share, seed)
    elif method == "exemplars":
        centres = valid_centres(known)
        found = np.where(known[..., None], part, part[nearest_in(known)])
        found = exemplar_fill(found, unclean, centres, known) if centres.any() else found
    else:
        found = harmonic_fill(known, unclean)(np.where(known[..., None], part, 0))
    out[hole] = _as(image, found[hole[box]])
    return out


def grown_by_margin(mask: NDArray[np.bool_], margin: int | None = None) -> NDArray[np.bool_]:
    """A mask (H, W) grown by a disk of `margin` pixels (default: `SOFT_EDGE` of the longer side, and `MIN_SOFT_EDGE_PIXELS` at least)."""
    margin = max(MIN_SOFT_EDGE_PIXELS, round(SOFT_EDGE * max(mask.shape))) if margin is None else margin
    disk = cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (2 * margin + 1, 2 * margin + 1))
    return np.asarray(cv2.dilate(mask.astype(np.uint8), disk) > 0)


def _as(image: NDArray[Values], values: NDArray[np.floating]) -> NDArray[Values]:
    """Values as those of the image are: whole grey levels, or as they come."""
    return np.clip(values + 0.5, 0, 255).astype(np.uint8) if image.dtype == np.uint8 else values.astype(image.dtype)
