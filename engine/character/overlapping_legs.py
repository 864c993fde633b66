"""Legs of which one hides some of the other in the picture, crossed or seen from the side: which of them is before the other.

Beyond the paper, whose limbs that pass before others are arms.
"""

from __future__ import annotations

from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from engine.body.parts import vertex_parts
from engine.body.rig import Rig
from engine.character.labels import LEGS
from engine.character.posed_template import PosedTemplate
from engine.character.template_maps import side_maps
from engine.imaging.mask_distance import distance_to, grown

CROSSING = 0.04
"""Metres around the place where legs cross within which is looked which of them is seen."""
HIDDEN = 0.1
"""Share of a leg that the other one hides, from which on it has to be made where nobody sees it."""
THIGH = 0.125
"""Metres around the hip within which thighs that touch hide some of each other from anywhere."""


def leg_before(labels: NDArray[np.integer], template: PosedTemplate, rig: Rig) -> int | None:
    """The leg that passes before the other; None where neither does. Where their bones cross in the picture it is the one that
    is seen there; else the template's that hides enough of the other.

    `labels` (h, w): what each pixel shows.
    """
    if (place := _crossing(template, rig)) is None:
        return _hiding(template, rig, labels.shape)
    y, x = np.mgrid[: labels.shape[0], : labels.shape[1]]
    near = np.hypot(x - place[0], y - place[1]) < CROSSING * template.pixels_per_metre
    seen = [int((near & (labels == leg)).sum()) for leg in LEGS]
    return LEGS[int(np.argmax(seen))] if any(seen) else None


def _crossing(template: PosedTemplate, rig: Rig) -> NDArray[np.floating] | None:
    """Where the legs' bones cross in the picture (2,)."""
    bones = [
        [template.joints[rig.index(f"{side}{name}"), :2] for name in ("UpLeg", "Leg", "Foot")]
        for side in ("Left", "Right")
    ]
    places = [_meeting(*one, *other) for one in pairwise(bones[0]) for other in pairwise(bones[1])]
    return next((place for place in places if place is not None), None)


def _meeting(
    a: NDArray[np.floating], b: NDArray[np.floating], c: NDArray[np.floating], d: NDArray[np.floating]
) -> NDArray[np.floating] | None:
    """Where the segment from a to b meets that from c to d (2,); None where it does not."""
    ways = np.stack([b - a, c - d], 1).astype(np.float64)
    if abs(np.linalg.det(ways)) < 1e-9:
        return None
    shares = np.linalg.solve(ways, c - a)
    return np.asarray(a + shares[0] * (b - a)) if ((shares >= 0) & (shares <= 1)).all() else None


def _hiding(template: PosedTemplate, rig: Rig, shape: tuple[int, ...]) -> int | None:
    """The template's leg that hides the other, on a grid (h, w)."""
    part = vertex_parts(rig)[template.triangles]
    legs = [side_maps(template.vertices, template.triangles[(part == leg).all(1)], (shape[0], shape[1]), "front")
            for leg in LEGS]  # fmt: skip
    y, x = np.mgrid[: shape[0], : shape[1]]
    for before, (leg, other) in enumerate((legs, legs[::-1])):
        hip = template.joints[rig.index(f"{('Right', 'Left')[before]}UpLeg"), :2]
        below = other.mask & (np.hypot(x - hip[0], y - hip[1]) > THIGH * template.pixels_per_metre)
        hidden = below & leg.mask & (leg.depth > other.depth)
        if hidden.sum() > HIDDEN * below.sum():
            return LEGS[before]
    return None


def standing_off(labels: NDArray[np.integer], leg: int, away: NDArray[np.floating]) -> float:
    """Pixels by which what is worn on a leg stands off from it: how far `away` (h, w) from the template's its edge lies, where
    nothing else of the person is beside it."""
    free = (labels == leg) & grown(labels < 0, 1)
    return float(np.median(away[free])) if free.any() else 0.0


def as_the_template(labels: NDArray[np.integer], template: NDArray[np.integer], before: int) -> NDArray[np.intp]:
    """Labels (h, w) in which each leg is what is nearest to that leg of the projected `template` (h, w): where legs cross, one
    comes out behind the other in wedges, which even labels cut off. What the leg that is `before` wears hides as much of the
    other as it stands off elsewhere."""
    away = {leg: distance_to(template == leg) for leg in LEGS}
    behind = sum(LEGS) - before
    off = standing_off(labels, before, away[before])
    return np.where(
        np.isin(labels, LEGS), np.where(away[before] <= np.maximum(away[behind], off), before, behind), labels
    )


def beside_the_other(labels: NDArray[np.integer], leg: int) -> NDArray[np.bool_]:
    """The pixels (h, w) of a leg beside which the other one shows."""
    other = labels == sum(LEGS) - leg
    return (labels == leg) & grown(other, 1)


def hidden_leg(
    labels: NDArray[np.integer], before: int, template: PosedTemplate, part: NDArray[np.intp]
) -> NDArray[np.bool_]:
    """The pixels (h, w) of the leg behind the one that is `before`, wherever it may be seen: the template's, and what is worn on it,
    as on the other. `part` (T, 3): that of each corner of the template's triangles."""
    front, behind = (
        distance_to(template.covers((part == leg).all(1), labels.shape)) for leg in (before, sum(LEGS) - before)
    )
    return np.asarray(behind <= standing_off(labels, before, front))
