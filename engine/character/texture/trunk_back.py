"""The back of the trunk on a relief: its rows laid out as if it were round, and what goes round them laid back onto the picture."""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.character.texture.kept_front import kept_front, levelled_to
from engine.character.texture.plain_cloth import TRUNK_SIDE_RADIANS, cloth_behind
from engine.imaging.masks.mask_distance import dilate_mask

USUAL_HEIGHT_METRES = 1.7
"""Metres that somebody whole is high, about."""
OUTLINE_SMOOTHING_PIXELS = 4.0
"""Pixels of the grid along the trunk over which its outline is smoothed."""
NEIGHBOUR_MARGIN_PIXELS = 4.0
"""Pixels of the grid around other parts in which the trunk's colours are mixed with theirs, or in their shadow."""
SHOULDER_WIDTH_SHARE, CHEST_HEIGHT_METRES = 0.85, 0.3
"""Share of the greatest width in the uppermost metres of a trunk from which on it is no neck, and its back has no neckline: above, it is as
it is below."""
YOKE_SOURCE_METRES = 0.15
"""Metres below its neckline that a back's uppermost part is made of, there and back again."""
COLUMNS_PER_PIXEL = 1.6
"""Columns of a row for each pixel of the widest: as many as half a circle has for its diameter."""


@dataclass(frozen=True)
class Axis:
    """The frame of a trunk: `frame` (2, 3) from pixels x, y, 1 to how many rows they are along it, from its beginning, and how far aside, to
    the right."""

    frame: NDArray[np.float64]

    @classmethod
    def of(cls, trunk: NDArray[np.bool_], head: NDArray[np.bool_]) -> Axis:
        """That of a trunk (h, w), from the middle of the `head` (h, w) to its own, or downwards where there is none."""
        centre = np.array([axis.mean() for axis in np.nonzero(trunk)[::-1]])
        down = np.array([0.0, 1.0])
        if head.any():
            above = np.array([axis.mean() for axis in np.nonzero(head)[::-1]])
            if (length := float(np.linalg.norm(centre - above))) > 1:
                down = (centre - above) / length
        y, x = np.nonzero(trunk)
        return cls(np.array([[*down, -(down @ np.stack([x, y])).min()], [down[1], -down[0], 0.0]]))

    def __call__(self, x: NDArray, y: NDArray) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Rows along and pixels aside (n,) of pixels."""
        along, aside = self.frame[:, :2] @ np.stack([x, y]) + self.frame[:, 2:]
        return along, aside

    def pixels(self, along: NDArray, aside: NDArray) -> tuple[NDArray[np.float32], NDArray[np.float32]]:
        """x and y of what is so far along and aside."""
        x, y = np.einsum("ij,j...->i...", self.frame[:, :2].T, np.stack([along - self.frame[0, 2], aside]))
        return x.astype(np.float32), y.astype(np.float32)

    def outline(self, mask: NDArray[np.bool_], rows: int, soft: float) -> NDArray[np.float32]:
        """Left and right ends (2, rows) of what is in a mask (h, w), smoothed over rows; where a row has none those of the nearest."""
        y, x = np.nonzero(mask)
        along, aside = self(x, y)
        row = np.clip(np.floor(along), 0, rows - 1).astype(np.intp)
        ends = np.stack([np.full(rows, np.inf), np.full(rows, -np.inf)])
        np.minimum.at(ends[0], row, aside)
        np.maximum.at(ends[1], row, aside)
        there = np.flatnonzero(np.isfinite(ends[0]))
        whole = np.stack([np.interp(np.arange(rows), there, one[there]) for one in ends]).astype(np.float32)
        blurred = cv2.GaussianBlur(whole, (0, 1), soft, sigmaY=1, borderType=cv2.BORDER_REPLICATE)
        return np.asarray(blurred, np.float32)


def with_trunk_back(
    rgb: NDArray[np.uint8],
    trunk: NDArray[np.bool_],
    shown: NDArray[np.bool_],
    others: NDArray[np.bool_],
    head: NDArray[np.bool_],
    scale: float,
    *,
    told: tuple[float, float] = TRUNK_SIDE_RADIANS,
    necked: bool = True,
) -> NDArray[np.uint8]:
    """A picture (H, W, 3) with what goes round it in place of the `trunk` (H, W).

    Parameters
    ----------
    shown : (H, W) which of its pixels the picture shows.
    others : (H, W) what lies before it or hangs beside it: what is close to that is in its shadow.
    head : (H, W) where that is.
    scale : pixels for each of the grid's.
    told : radians from the middle between which its sides tell what is behind.
    necked : whether the trunk goes up to its neck, and has a neckline in front.
    """
    clean = shown & ~dilate_mask(others, round(NEIGHBOUR_MARGIN_PIXELS * scale))
    if not clean.any():
        return rgb
    axis = Axis.of(trunk, head)
    y, x = np.nonzero(trunk)
    along, aside = axis(x, y)
    rows = int(along.max()) + 1
    left, right = axis.outline(clean, rows, OUTLINE_SMOOTHING_PIXELS * scale)
    columns = max(16, round(COLUMNS_PER_PIXEL * float((right - left).max())))
    angle = (((np.arange(columns) + 0.5) / columns - 0.5) * np.pi).astype(np.float32)
    middle, half = (left + right) / 2, np.maximum(right - left, 1) / 2
    where = axis.pixels(
        np.broadcast_to(np.arange(rows)[:, None], (rows, columns)), middle[:, None] + half[:, None] * np.sin(angle)
    )
    seen = np.asarray(cv2.remap(rgb, *where, cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE), np.float32)
    known = np.asarray(cv2.remap(clean.astype(np.uint8), *where, cv2.INTER_NEAREST) > 0)
    step = USUAL_HEIGHT_METRES / rgb.shape[0]
    chest = half[: max(1, round(CHEST_HEIGHT_METRES / step))]
    yoke = int(np.argmax(chest >= SHOULDER_WIDTH_SHARE * chest.max())) if necked else 0
    source = np.arange(rows)
    below = max(1, round(YOKE_SOURCE_METRES / step))
    away = (yoke - source[:yoke]) % (2 * below)
    source[:yoke] = np.minimum(yoke + np.minimum(away, 2 * below - away), rows - 1)
    seen, known = seen[source], known[source]
    behind = cloth_behind(seen, known, angle, step, told)
    mirrored = ~known & known[:, ::-1]  # of a pattern, what an arm hides is as it is on the other side
    front = np.where(mirrored[..., None], seen[:, ::-1], seen)
    share = kept_front(front, known | mirrored, behind, angle, step)
    behind = levelled_to(behind, front, share, step)
    behind += share[..., None] * (front - behind)
    left, right = axis.outline(trunk, rows, OUTLINE_SMOOTHING_PIXELS * scale)
    left, right = (np.interp(along, np.arange(rows), one) for one in (left, right))
    place = np.clip(2 * (aside - left) / np.maximum(right - left, 1) - 1, -1, 1)
    column = (np.arcsin(place) / np.pi + 0.5) * columns - 0.5
    out = rgb.copy()
    found = _at(behind, column.astype(np.float32), along.astype(np.float32))
    out[y, x] = np.clip(found + 0.5, 0, 255).astype(np.uint8)
    return out


def _at(values: NDArray[np.float32], column: NDArray[np.float32], row: NDArray[np.float32]) -> NDArray[np.float32]:
    """Values (A, N, C) at places (n,) in their rows."""
    few = 16_384  # remap takes no more at once
    parts = [
        cv2.remap(values, column[k : k + few, None], row[k : k + few, None], cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE)
        for k in range(0, len(row), few)
    ]  # fmt: skip
    return np.asarray(np.concatenate(parts)[:, 0], np.float32)
