"""Legs of which one hides some of the other in the picture, crossed or seen from the side: which of them is before the other.

Beyond the paper, whose limbs that pass before others are arms.
"""

from __future__ import annotations

from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from engine.body.parts import vertex_parts
from engine.body.rig import Rig
from engine.character.fit.posed_template import PosedTemplate
from engine.character.fit.template_maps import side_maps
from engine.character.parts.labels import LEG_LABELS, OPPOSITE_LABEL
from engine.imaging.masks.mask_distance import dilate_mask, distance_to

CROSSING_RADIUS_METRES = 0.04
"""Metres around the place where legs cross within which is looked which of them is seen."""
MIN_HIDDEN_LEG_SHARE = 0.1
"""Share of a leg that the other one hides, from which on it has to be made where nobody sees it."""


def leg_before(labels: NDArray[np.integer], template: PosedTemplate, rig: Rig) -> int | None:
    """The leg that passes before the other; None where neither does, or none is seen. Where their bones cross in the picture it is
    the one that is seen there; else the template's that hides enough of the other.

    `labels` (h, w): what each pixel shows.
    """
    if not np.isin(labels, LEG_LABELS).any():
        return None
    y, x = np.mgrid[: labels.shape[0], : labels.shape[1]]
    for place in _crossings(template, rig):
        near = np.hypot(x - place[0], y - place[1]) < CROSSING_RADIUS_METRES * template.pixels_per_metre
        seen = [int((near & (labels == leg)).sum()) for leg in LEG_LABELS]
        if any(seen):
            return LEG_LABELS[int(np.argmax(seen))]
    return _hiding(template, rig, labels.shape)


def _crossings(template: PosedTemplate, rig: Rig) -> list[NDArray[np.floating]]:
    """Where the legs' bones cross in the picture, (2,) each."""
    bones = [
        [template.joints[rig.index(f"{side}{name}"), :2] for name in ("UpLeg", "Leg", "Foot")]
        for side in ("Left", "Right")
    ]
    places = [_meeting(*one, *other) for one in pairwise(bones[0]) for other in pairwise(bones[1])]
    return [place for place in places if place is not None]


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
            for leg in LEG_LABELS]  # fmt: skip
    for before, (leg, other) in zip(LEG_LABELS, (legs, legs[::-1]), strict=True):
        if (other.mask & leg.mask & (leg.depth > other.depth)).sum() > MIN_HIDDEN_LEG_SHARE * other.mask.sum():
            return before
    return None


def standing_off(labels: NDArray[np.integer], leg: int, away: NDArray[np.floating]) -> float:
    """Pixels by which what is worn on a leg stands off from it: how far `away` (h, w) from the template's its edge
    lies. It is measured on the lower half, since further up may be a skirt, and where nothing else of the person is
    beside it."""
    rows = np.flatnonzero((labels == leg).any(1))
    free = (labels == leg) & dilate_mask(labels < 0, 1)
    free[: int(rows.mean()) if len(rows) else 0] = False
    return float(np.median(away[free])) if free.any() else 0.0


def as_the_template(labels: NDArray[np.integer], template: NDArray[np.integer], before: int) -> NDArray[np.intp]:
    """Labels (h, w) in which each leg is what is nearest to that leg of the projected `template` (h, w). Where legs
    cross, one comes out behind the other in wedges, which even labels cut off. What the leg that is `before` wears
    hides as much of the other as it stands off elsewhere."""
    away = {leg: distance_to(template == leg) for leg in LEG_LABELS}
    off = standing_off(labels, before, away[before])
    front = away[before] <= np.maximum(away[OPPOSITE_LABEL[before]], off)
    return np.where(np.isin(labels, LEG_LABELS), np.where(front, before, OPPOSITE_LABEL[before]), labels)


def beside_the_other(labels: NDArray[np.integer], leg: int) -> NDArray[np.bool_]:
    """The pixels (h, w) of a leg beside which the other one shows."""
    return (labels == leg) & dilate_mask(labels == OPPOSITE_LABEL[leg], 1)


def hidden_leg(
    labels: NDArray[np.integer], before: int, template: PosedTemplate, part: NDArray[np.intp]
) -> NDArray[np.bool_]:
    """The pixels (h, w) of the leg behind the one that is `before`, wherever it may be seen: the template's, and what is worn on it,
    as on the other. `part` (T, 3): that of each corner of the template's triangles."""
    front, behind = (
        distance_to(template.covers((part == leg).all(1), labels.shape)) for leg in (before, OPPOSITE_LABEL[before])
    )
    return np.asarray(behind <= standing_off(labels, before, front))
