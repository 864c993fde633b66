"""Legs that touch in the picture: where they part, and what moves each.

Beyond the paper, in which legs are one surface where they touch.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import distance_transform_edt

from engine.body.parts import BODY_PARTS
from engine.body.rig import Rig
from engine.character.surface.front_and_back import Layer
from engine.character.surface.part_surface import Surface
from engine.imaging.masks.mask_distance import dilate_mask

MIN_OWN_LEG_WEIGHT = 0.5
"""Share of what moves a leg that must be its own to be believed."""


def cut_along(labels: NDArray[np.integer], parting: NDArray[np.bool_]) -> NDArray[np.int8]:
    """Along the parting of the legs, the side to which a pixel belongs: 1 left, 2 right; 0 elsewhere (h, w)."""
    near = dilate_mask(parting, 1)
    cut = np.zeros(labels.shape, np.int8)
    for side, name in ((1, "left_leg"), (2, "right_leg")):
        cut[near & (labels == BODY_PARTS.index(name))] = side
    return cut


def each_by_its_own(body: Layer, labels: NDArray[np.integer], parting: NDArray[np.bool_], rig: Rig) -> Layer:
    """The body without what moves its left leg by the right one's joints, or the other way round: where legs touch the warp
    may lead from one to the other. Only below where they begin to part."""
    rows = np.flatnonzero(parting.any(1))
    if not len(rows):
        return body
    below = np.zeros(body.mask.shape, np.bool_)
    below[rows[0] :] = True
    sides = []
    for surface in (body.front, body.back):
        weights = surface.weights.copy()
        for own, other in (("left_leg", "Right"), ("right_leg", "Left")):
            region = body.mask & below & (labels == BODY_PARTS.index(own))
            others = [k for k, name in enumerate(rig.names) if name.startswith(other)]
            kept = weights[region]
            kept[:, others] = 0
            total = kept.sum(1)
            known = np.zeros(body.mask.shape, np.bool_)
            known[region] = total > MIN_OWN_LEG_WEIGHT
            if not known.any():
                continue
            weights[region] = kept / np.maximum(total, 1e-6)[:, None]
            _, (y, x) = distance_transform_edt(~known, return_indices=True)
            lost = region & ~known
            weights[lost] = weights[y[lost], x[lost]]
        sides.append(Surface(surface.depth, weights))
    return replace(body, front=sides[0], back=sides[1])
