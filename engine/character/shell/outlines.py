"""Where the borders of the parts are in the picture: what a shell's rims are drawn to.

The outline of the whole person is not enough: a trunk beside a hanging arm, and a leg beside the other one, have no border there.
"""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.body.parts import BODY_PARTS
from engine.character.figure.silhouette import GRID_HEIGHT_PIXELS
from engine.character.parts.free_cloth import FreeCloth
from engine.character.parts.label_map import Labels
from engine.character.parts.labels import ARM_LABELS, HEAD_LABEL, LEG_LABELS, TRUNK_LABEL

MIN_OUTLINED_PART_PIXELS = 60
"""Pixels of a part whose border is looked at."""
MIN_FOLLOWED_BORDER_PIXELS = 30
"""Pixels of a border that is worth following."""
DIRECTION_SMOOTHING_PIXELS = 2.5
"""Pixels over which a border's direction is smoothed."""
NEIGHBOUR_PIXELS = 3.0
"""Pixels beyond a border at which is looked what is beside it."""
HANGING_CLOTH_HEIGHT_SHARE = 0.075
"""How far above the crotch, as a share of the person's height, cloth that hangs is no more the body's."""
BORDER_OFFSET_PIXELS = 0.6
"""How far beyond the centres of a part's outermost pixels its border is."""
PART_UNDERLAP_PIXELS = 2.0
"""Pixels by which parts go on under one another, so that no gap opens between them."""
ARM_BORDER_WEIGHT, LEG_BORDER_WEIGHT, HIDDEN_TRUNK_BORDER_WEIGHT = 0.5, 0.4, 0.4
"""How much the border of an arm before others counts, of a leg beside the other, and of what an arm hides, where the person's
own outline counts 1."""


@dataclass(frozen=True)
class Outlines:
    """Points of the parts' borders on the grid.

    points : (M, 2) float64, pixels.
    normals : (M, 2) float64, unit, away from the part.
    part : (M,) int, index of `BODY_PARTS`.
    weight : (M,) float64, how much a point counts.
    hidden : (M,) bool, where the part may as well reach further, beneath what is before it.
    """

    points: NDArray[np.float64]
    normals: NDArray[np.float64]
    part: NDArray[np.intp]
    weight: NDArray[np.float64]
    hidden: NDArray[np.bool_]

    def of(self, part: int) -> Outlines:
        """Those of one part alone, an index of `BODY_PARTS`."""
        own = self.part == part
        return Outlines(self.points[own], self.normals[own], self.part[own], self.weight[own], self.hidden[own])


def part_outlines(labels: Labels) -> Outlines:
    """The borders of all parts of `labels`. Of cloth that hangs free the body says nothing, and has none there."""
    map_ = labels.labels.astype(np.intp)
    height, width = map_.shape
    loose = np.zeros(map_.shape, np.uint8) if labels.cloth is None else hanging(labels.cloth, map_).astype(np.uint8)
    free = cv2.dilate(loose, np.ones((5, 5), np.uint8)) == 0
    found = []
    for part in range(len(BODY_PARTS)):
        own = map_ == part
        if own.sum() < MIN_OUTLINED_PART_PIXELS:
            continue
        points, normals = border_points(own)
        x, y = np.rint(points + NEIGHBOUR_PIXELS * normals).astype(int).T
        beside = map_[np.clip(y, 0, height - 1), np.clip(x, 0, width - 1)]
        weight, hidden = np.where(beside < 0, 1.0, 0.0), np.zeros(len(points), np.bool_)
        if part in ARM_LABELS:
            weight[np.isin(beside, (TRUNK_LABEL, HEAD_LABEL, *LEG_LABELS))] = ARM_BORDER_WEIGHT
        else:
            if part in LEG_LABELS:
                weight[np.isin(beside, LEG_LABELS) & (beside != part)] = LEG_BORDER_WEIGHT
            if part != HEAD_LABEL:
                hidden = np.isin(beside, ARM_LABELS)
                weight[hidden] = HIDDEN_TRUNK_BORDER_WEIGHT
        if labels.held is not None:
            weight[labels.held[np.clip(y, 0, height - 1), np.clip(x, 0, width - 1)] >= 0] = 0
        x, y = points.astype(int).T
        kept = (weight > 0) & free[y, x] & (np.arange(len(points)) % 2 == 0)
        points = points + np.where(weight < 1, PART_UNDERLAP_PIXELS, BORDER_OFFSET_PIXELS)[:, None] * normals
        found.append((points[kept], normals[kept], np.full(kept.sum(), part), weight[kept], hidden[kept]))
    points, normals, parts, weights, hidden = (np.concatenate(values) for values in zip(*found, strict=True))
    return Outlines(points, normals, parts, weights, hidden)


def border_points(mask: NDArray[np.bool_]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Pixels (N, 2) of the contours of a mask (h, w), those of its holes too, and their outward normals (N, 2)."""
    contours, _ = cv2.findContours(mask.astype(np.uint8), cv2.RETR_CCOMP, cv2.CHAIN_APPROX_NONE)
    points = np.concatenate(
        [np.zeros((0, 2), np.intp)] + [one[:, 0] for one in contours if len(one) >= MIN_FOLLOWED_BORDER_PIXELS]
    )
    soft = cv2.GaussianBlur(mask.astype(np.float32), (0, 0), DIRECTION_SMOOTHING_PIXELS)
    slopes = [cv2.Sobel(soft, cv2.CV_32F, dx, 1 - dx)[points[:, 1], points[:, 0]] for dx in (1, 0)]
    away = -np.stack(slopes, 1).astype(np.float64)
    return points.astype(np.float64), away / np.maximum(np.linalg.norm(away, axis=1, keepdims=True), 1e-6)


def hanging(cloth: FreeCloth, labels: NDArray[np.integer]) -> NDArray[np.bool_]:
    """The pixels (h, w) of a skirt, or of a coat's tails, from a little above the crotch on: cloth that hangs and follows neither
    trunk nor legs."""
    area = np.zeros(labels.shape, np.bool_)
    if cloth.hangs:
        first = (
            cloth.rings[min(cloth.above, len(cloth.rings) - 1)].row - HANGING_CLOTH_HEIGHT_SHARE * GRID_HEIGHT_PIXELS
        )
        for _, row, columns in cloth.rows():
            if row >= first:
                area[row, columns] = True
    return np.asarray(area & cloth.worn & ~np.isin(labels, (*ARM_LABELS, HEAD_LABEL)))
