"""Both halves of a turned head: what is badly seen of the far one is what the near one shows in its place, in the far one's light.

Beyond the paper. The template's halves correspond cell by cell, so a place and its mirror image are known exactly. One line from the crown to
the chin parts what the far half shows itself from what it has from the near one. It runs where both are alike and through no eye.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeVar

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.character.shell.colours.head_map import HeadMap
from engine.character.shell.colours.seam_path import cheapest_path, sides_cost
from engine.character.shell.colours.unrolled import UNROLLED_COLUMNS

T = TypeVar("T", bound=np.generic)

SEEN_COSINES = (0.3, 0.8)
"""Cosines to the viewer from which on a cell counts in the choice of halves, and from which on it does so wholly."""
SURE_CELLS = 4.0
"""Cells from the border of what is seen from which on it counts wholly: at a contour colours are mixed with what is behind."""
OWN_SHARE = 0.65
"""How well, as a share of its mirror image, a place must be seen to be the better one: it is in its own light and expression."""
MIN_OTHER_WEIGHT = 0.3
"""How well, from 0 to 1, a place must be seen to be shown on the other half, too."""
MIN_OTHER_CELLS = 9
"""Cells that must be shown of the other half side by side: a narrow strip has nothing that is missed."""
CROSSING_COST_OF_LAB = 0.06
"""What it costs that a line runs where both halves differ by 1 of CIE Lab, in cells that are seen by one half alone."""
EYE_CROSSING_COST = 12.0
"""What it costs that it runs through a cell of an eye."""
EYE_RADIANS, EYE_ROWS = (0.12, 0.56), 7
"""Radians from the face's middle between which eyes are, and rows above and below their middle."""
LINE_STEP_CELLS, LINE_STEP_COST = 2, 0.4
"""Cells by which the line moves at most from row to row, and what each costs."""
BLEND_CELLS = 4.0
"""Cells on each side of the line over which one half goes over into the other."""
MIN_LIGHT_WEIGHT, LIGHT_ROWS = 0.1, 6.0
"""How well, from 0 to 1, a place must be seen on both halves for their light to be compared there, and rows over which that is averaged."""
SURE_LIGHT_CELLS, SURE_LIGHT_CELLS_OF_A_ROW = 300.0, 6.0
"""Cells, in all and of a row, whose light counts half: that of fewer is nearer to that of the other half, and to that of the other rows."""
LEVELS_ADDED_TO_BLACK = 4.0
"""sRGB levels that are added before light is compared: black has no ratio."""
MAX_LIGHT_RATIO = 2.2
"""By how much one half may be lighter than the other."""
OTHER_LIGHT_LOG_RATIO = 0.6
"""Logarithm of how much lighter or darker the other half is by which it counts a third: what lies in the shade is no good image of what is lit."""


@dataclass(frozen=True)
class BothHalves:
    """A head's cells, (A, `UNROLLED_COLUMNS`) each.

    colours : (A, `UNROLLED_COLUMNS`, 3) float32.
    known : bool, which are seen, there or on the other half.
    facing : float32, cosine to the viewer of where they were seen.
    own : float32, how far they are what the picture shows in that place, from 0 to 1.
    """

    colours: NDArray[np.float32]
    known: NDArray[np.bool_]
    facing: NDArray[np.float32]
    own: NDArray[np.float32]


def both_halves(
    head: HeadMap, colours: NDArray[np.float32], known: NDArray[np.bool_], facing: NDArray[np.float32]
) -> BothHalves:
    """Both halves of a head of which some cells are `known` (A, `UNROLLED_COLUMNS`), from the chin up."""
    second = _second_half(head, colours, known, facing)
    first = _second_half(head, colours[:, ::-1], known[:, ::-1], facing[:, ::-1])
    return BothHalves(
        _joined(first.colours, second.colours),
        _joined(first.known, second.known),
        _joined(first.facing, second.facing),
        _joined(first.own, second.own),
    )


def _joined(mirrored: NDArray[T], second: NDArray[T]) -> NDArray[T]:
    """Of cells (A, `UNROLLED_COLUMNS`, ...) the second half, and of others its mirror image as the first."""
    half = UNROLLED_COLUMNS // 2
    return np.concatenate([mirrored[:, : half - 1 : -1], second[:, half:]], 1)


def _second_half(
    head: HeadMap, colours: NDArray[np.float32], known: NDArray[np.bool_], facing: NDArray[np.float32]
) -> BothHalves:
    """A head whose second half has what it lacks from the first; the first is as it was."""
    weight = _weight(known, facing)
    half = UNROLLED_COLUMNS // 2
    mirrored = colours[:, ::-1]
    second = np.arange(UNROLLED_COLUMNS) >= half
    light = _light(colours, mirrored, weight * weight[:, ::-1] * second)
    lit = mirrored * light
    alike = np.exp(-((np.log(light[..., 0]) / OTHER_LIGHT_LOG_RATIO) ** 2)) * ~head.around_ears
    other_weight = weight[:, ::-1] * alike
    there = _well_seen(other_weight) & known[:, ::-1] & ~head.around_ears
    lowest = int(head.levels["chin"])
    own = np.ones(known.shape, np.float32)
    own[lowest:, half:] = _own_share(head, colours, lit, (weight, other_weight), lowest)
    own = np.where(_wide(there & (own < 0.5)), own, 1)
    share = np.where(known, np.where(there, own, own > 0.5), 1 - (there & (own < 0.5)))
    merged = np.where(share[..., None] >= 1, colours, lit + share[..., None] * (colours - lit))
    other = share < 0.5
    return BothHalves(
        np.clip(merged, 0, 255).astype(np.float32),
        np.where(other, there, known),
        np.where(other, facing[:, ::-1], facing).astype(np.float32),
        own.astype(np.float32),
    )


def _well_seen(weight: NDArray[np.float32]) -> NDArray[np.bool_]:
    """The cells (A, `UNROLLED_COLUMNS`) that are seen well enough for the other half, folds of lids between them too."""
    square = np.ones((MIN_OTHER_CELLS, MIN_OTHER_CELLS), np.uint8)
    return np.asarray(cv2.morphologyEx((weight > MIN_OTHER_WEIGHT).astype(np.uint8), cv2.MORPH_CLOSE, square) > 0)


def _wide(mask: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """What of a mask (A, `UNROLLED_COLUMNS`) is as wide as `MIN_OTHER_CELLS`, and what is about that."""
    square = np.ones((MIN_OTHER_CELLS, MIN_OTHER_CELLS), np.uint8)
    kept = cv2.morphologyEx(mask.astype(np.uint8), cv2.MORPH_OPEN, square)
    reach = 2 * int(BLEND_CELLS) + 1
    return np.asarray(cv2.dilate(kept, np.ones((reach, reach), np.uint8)) > 0)


def _weight(known: NDArray[np.bool_], facing: NDArray[np.float32]) -> NDArray[np.float32]:
    """How well cells are seen, (A, `UNROLLED_COLUMNS`) from 0 to 1."""
    within = cv2.distanceTransform(known.astype(np.uint8), cv2.DIST_L2, 3)
    least, all_ = SEEN_COSINES
    return np.asarray(np.clip((facing - least) / (all_ - least), 0, 1) * np.clip(within / SURE_CELLS, 0, 1), np.float32)


def _light(
    colours: NDArray[np.float32], mirrored: NDArray[np.float32], both: NDArray[np.float32]
) -> NDArray[np.float32]:
    """By how much (A, 1, 1) places are lighter than their mirror images, row by row, in the median of what is seen of `both`."""
    seen = both > MIN_LIGHT_WEIGHT
    if not seen.any():
        return np.ones((len(colours), 1, 1), np.float32)
    ratio = np.log((colours.mean(-1) + LEVELS_ADDED_TO_BLACK) / (mirrored.mean(-1) + LEVELS_ADDED_TO_BLACK))
    count = seen.sum(1).astype(np.float32)
    told = np.array([np.median(row[own]) if own.any() else 0 for row, own in zip(ratio, seen, strict=True)], np.float32)
    usual = float(np.median(ratio[seen]) * count.sum() / (count.sum() + SURE_LIGHT_CELLS))
    total = np.stack([(told - usual) * count, count], 1)
    smooth = cv2.GaussianBlur(total, (1, 0), 1, sigmaY=LIGHT_ROWS, borderType=cv2.BORDER_REPLICATE)
    light = usual + smooth[:, 0] / (smooth[:, 1] + SURE_LIGHT_CELLS_OF_A_ROW)
    most = np.log(MAX_LIGHT_RATIO)
    return np.asarray(np.exp(np.clip(light, -most, most))[:, None, None], np.float32)


def _own_share(
    head: HeadMap,
    colours: NDArray[np.float32],
    lit: NDArray[np.float32],
    weights: tuple[NDArray[np.float32], NDArray[np.float32]],
    lowest: int,
) -> NDArray[np.float32]:
    """How far the second half's cells (A - lowest, `UNROLLED_COLUMNS` / 2) are their own, from row `lowest` on; `weights`: theirs and those of
    their mirror images, `lit` as they are."""
    half = UNROLLED_COLUMNS // 2
    own, other = (one[lowest:, half:] for one in weights)
    other = OWN_SHARE * other
    lab = [
        cv2.cvtColor(np.clip(np.ascontiguousarray(one[lowest:, half:]), 0, 255) / np.float32(255), cv2.COLOR_RGB2LAB)
        for one in (colours, lit)
    ]
    differ = np.linalg.norm(lab[0] - lab[1], axis=-1) * ((own > 0) & (other > 0))
    eyes = (np.abs(head.height - head.levels["eyes"]) < EYE_ROWS) & (head.angle > EYE_RADIANS[0])
    eyes = (eyes & (head.angle < EYE_RADIANS[1]))[lowest:, half:]
    crossing = CROSSING_COST_OF_LAB * differ + EYE_CROSSING_COST * eyes
    cost = sides_cost(np.maximum(other - own, 0), np.maximum(own - other, 0), crossing)
    line = cheapest_path(cost, LINE_STEP_CELLS, LINE_STEP_COST)
    beyond = np.arange(half)[None] + 0.5 - line[:, None]
    return np.asarray(np.clip(0.5 - beyond / (2 * BLEND_CELLS), 0, 1), np.float32)
