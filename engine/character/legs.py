"""Legs that touch in the picture: where they part, and what moves each; which of two that cross passes before the other.

Beyond the paper, in which legs are one surface where they touch.
"""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise

import cv2
import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import distance_transform_edt

from engine.body.parts import PARTS
from engine.body.rig import Rig
from engine.character.labels import LEGS
from engine.character.part_surface import Surface
from engine.character.sheets import Layer
from engine.imaging.mask_distance import grown

LEGS_APART = 0.05
"""Metres at rest between points of the legs that touch in the picture and are not joined: near the crotch they are."""
HALF = 0.5
"""Share of what moves a leg that must be its own to be believed."""
CROSSING = 0.04
"""Metres around the place where legs cross within which is looked which of them is seen."""


def leg_before(
    labels: NDArray[np.integer], joints: NDArray[np.floating], rig: Rig, pixels_per_metre: float
) -> int | None:
    """The leg that is seen where the bones of both cross in the picture; None where they do not.

    `labels` (h, w): what each pixel shows; `joints` (J, 2 or more): where the rig's are, in its pixels.
    """
    bones = [
        [joints[rig.index(f"{side}{name}"), :2] for name in ("UpLeg", "Leg", "Foot")] for side in ("Left", "Right")
    ]
    places = [_meeting(*one, *other) for one in pairwise(bones[0]) for other in pairwise(bones[1])]
    for place in places:
        if place is not None:
            y, x = np.mgrid[: labels.shape[0], : labels.shape[1]]
            near = np.hypot(x - place[0], y - place[1]) < CROSSING * pixels_per_metre
            seen = [int((near & (labels == leg)).sum()) for leg in LEGS]
            return LEGS[int(np.argmax(seen))] if any(seen) else None
    return None


def _meeting(
    a: NDArray[np.floating], b: NDArray[np.floating], c: NDArray[np.floating], d: NDArray[np.floating]
) -> NDArray[np.floating] | None:
    """Where the segment from a to b meets that from c to d (2,); None where it does not."""
    ways = np.stack([b - a, c - d], 1).astype(np.float64)
    if abs(np.linalg.det(ways)) < 1e-9:
        return None
    shares = np.linalg.solve(ways, c - a)
    return np.asarray(a + shares[0] * (b - a)) if ((shares >= 0) & (shares <= 1)).all() else None


def as_the_template(labels: NDArray[np.integer], template: NDArray[np.integer], before: int) -> NDArray[np.intp]:
    """Labels (h, w) in which each leg is what is nearest to that leg of the projected `template` (h, w): where legs cross, one
    comes out behind the other in wedges, which even labels cut off. What the leg that is `before` wears hides as much of the
    other as it stands off elsewhere."""
    away = {leg: np.asarray(cv2.distanceTransform((template != leg).astype(np.uint8), cv2.DIST_L2, 5)) for leg in LEGS}
    behind = sum(LEGS) - before
    legs = np.isin(labels, LEGS)
    free = (labels == before) & grown(labels < 0, 1)
    off = float(np.median(away[before][free])) if free.any() else 0.0
    return np.where(legs, np.where(away[before] <= np.maximum(away[behind], off), before, behind), labels)


def beside_the_other(labels: NDArray[np.integer], leg: int) -> NDArray[np.bool_]:
    """The pixels (h, w) of a leg beside which the other one shows."""
    other = labels == sum(LEGS) - leg
    return (labels == leg) & grown(other, 1)


def cut_along(labels: NDArray[np.integer], parting: NDArray[np.bool_]) -> NDArray[np.int8]:
    """Along the parting of the legs, the side to which a pixel belongs: 1 left, 2 right; 0 elsewhere (h, w)."""
    near = grown(parting, 1)
    cut = np.zeros(labels.shape, np.int8)
    for side, name in ((1, "left_leg"), (2, "right_leg")):
        cut[near & (labels == PARTS.index(name))] = side
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
            region = body.mask & below & (labels == PARTS.index(own))
            others = [k for k, name in enumerate(rig.names) if name.startswith(other)]
            kept = weights[region]
            kept[:, others] = 0
            total = kept.sum(1)
            known = np.zeros(body.mask.shape, np.bool_)
            known[region] = total > HALF
            if not known.any():
                continue
            weights[region] = kept / np.maximum(total, 1e-6)[:, None]
            _, (y, x) = distance_transform_edt(~known, return_indices=True)
            lost = region & ~known
            weights[lost] = weights[y[lost], x[lost]]
        sides.append(Surface(surface.depth, weights))
    return replace(body, front=sides[0], back=sides[1])
