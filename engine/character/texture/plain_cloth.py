"""What is behind something round: cloth in the colours that its sides have at each height, as fine as it is in front."""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import binary_dilation, median_filter

from engine.character.shell.colours.between_hems import between_hems

TRUNK_SIDE_RADIANS = np.radians(34.0), np.radians(72.0)
"""Radians from the middle between which the sides are seen: beyond, a pixel is drawn out over more than three times its width."""
SIDE_ROW_METRES = 0.0025
"""Metres of a row in which sides are told."""
LIGHT_METRES = 0.2
"""Metres of rows to each side over which the light is one."""
ODD_METRES = 0.4
"""Metres over which it is told what is usual for both sides."""
ARM_SHADOW_METRES = 0.04
"""Metres above and below rows that arms hide wholly in which the cloth is in their shadow."""
MAX_SHADE_RATIO, MAX_HUE_LEVELS = 2.0, 18.0
"""How much lighter one cloth is in the light than in the shade of arms, at most, and sRGB levels by which its hue differs there."""
FINE_METRES, MAX_FINE_LEVELS = 0.012, 16.0
"""Metres about a cell off whose mean its fine detail is, and sRGB levels up to which that is the cloth's, and no line of a print."""


def cloth_behind(
    seen: NDArray[np.float32],
    known: NDArray[np.bool_],
    angle: NDArray[np.floating],
    step: float,
    told: tuple[float, float] = TRUNK_SIDE_RADIANS,
) -> NDArray[np.float32]:
    """Cloth behind rows of something round, (A, N, 3).

    Parameters
    ----------
    seen, known : (A, N, 3), levels, what is before, and (A, N) which of it may be a source.
    angle : (N,) radians from the middle, from about -pi / 2 to pi / 2.
    step : metres from row to row.
    told : radians from the middle between which either side is told.

    Where nothing is known of any side, it is what is before.
    """
    rows = max(2, round(len(seen) * step / SIDE_ROW_METRES))
    sides, sure = _sides(seen, known, angle, rows, told)
    if not sure.any():
        return np.asarray(seen, np.float32)
    sure = sure & ~_in_the_shadow_of_arms(np.asarray(sure.any(1)))[:, None]
    whole = _without_the_odd(*_both(sides, sure))
    plain = between_hems(whole, sure, SIDE_ROW_METRES)
    tall = plain[((np.arange(len(seen)) + 0.5) * rows / len(seen)).astype(np.intp)]  # what steps there steps here
    share = (0.5 + 0.5 * np.clip(np.sin(angle) / np.sin(np.mean(TRUNK_SIDE_RADIANS)), -1, 1)).astype(np.float32)[
        None, :, None
    ]
    cloth = np.asarray((1 - share) * tall[:, :1] + share * tall[:, 1:], np.float32)
    return cloth + _fine(seen - cloth, known, step)


def _sides(
    seen: NDArray[np.floating],
    known: NDArray[np.bool_],
    angle: NDArray[np.floating],
    rows: int,
    told: tuple[float, float],
) -> tuple[NDArray[np.float32], NDArray[np.bool_]]:
    """The colours (R, 2, 3) of the left and the right side at so many rows, in the median of what is known of each, and which are known (R, 2)."""
    first = np.linspace(0, len(seen), rows + 1)
    found, sure = np.zeros((rows, 2, 3), np.float32), np.zeros((rows, 2), np.bool_)
    least, most = told
    for k, sign in enumerate((-1, 1)):
        aside = (sign * angle > least) & (sign * angle < most)
        part, there = seen[:, aside], known[:, aside]
        for row in range(rows):
            some = slice(int(first[row]), max(int(first[row + 1]), int(first[row]) + 1))
            own = there[some]
            if own.mean() > 0.25:
                found[row, k], sure[row, k] = np.median(part[some][own], 0), True
    return found, sure


def _in_the_shadow_of_arms(told: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Which rows (R,) are close to some between others that are not `told` (R,): arms cross before them."""
    rows = np.flatnonzero(told)
    within = np.zeros_like(told)
    within[rows[0] : rows[-1] + 1] = True
    near = binary_dilation(within & ~told, iterations=round(ARM_SHADOW_METRES / SIDE_ROW_METRES))
    near[rows[[0, -1]]] = False
    return np.asarray(near)


def _both(sides: NDArray[np.float32], sure: NDArray[np.bool_]) -> tuple[NDArray[np.float32], NDArray[np.float32]]:
    """Sides (R, 2, 3) of which all are known: what is missing of one is as the other is there, in its own light; and by how much (R, 1, 3) the right one is
    lighter."""
    rows = np.arange(len(sides))
    both = sure.all(1)
    if both.any():
        apart = median_filter(
            sides[both, 1] - sides[both, 0], (2 * round(LIGHT_METRES / SIDE_ROW_METRES) + 1, 1), mode="nearest"
        )
        light = np.stack([np.interp(rows, rows[both], one) for one in apart.T], 1)
    else:
        light = np.zeros((len(sides), 3))
    whole = sides.astype(np.float64)
    for k, sign in ((0, -1), (1, 1)):
        instead = ~sure[:, k] & sure[:, 1 - k]
        whole[instead, k] = sides[instead, 1 - k] + sign * light[instead]
    return _in_all_rows(whole, np.flatnonzero(sure.any(1))), light[:, None].astype(np.float32)


def _in_all_rows(sides: NDArray[np.floating], told: NDArray[np.intp]) -> NDArray[np.float32]:
    """Sides (R, 2, 3) of which some rows are `told` (N,): between two that are of one cloth it goes over from the light of one into that of the other,
    and between two that are not, each goes on half the way."""
    rows = np.arange(len(sides))
    after = np.minimum(np.searchsorted(told, rows), len(told) - 1)
    last, first = told[after], told[np.maximum(after - 1, 0)]
    way = np.clip((rows - first) / np.maximum(last - first, 1), 0, 1)
    one, other = sides[first].mean(1), sides[last].mean(1)
    lighter = (other.mean(-1) + 1) / (one.mean(-1) + 1)
    hue = np.linalg.norm(other / lighter[:, None] - one, axis=-1)
    alike = (np.abs(np.log(lighter)) < np.log(MAX_SHADE_RATIO)) & (hue < MAX_HUE_LEVELS)
    share = np.where(alike, way, way > 0.5)[:, None, None]
    return np.asarray((1 - share) * sides[first] + share * sides[last], np.float32)


def _without_the_odd(sides: NDArray[np.float32], light: NDArray[np.float32]) -> NDArray[np.float32]:
    """Sides (R, 2, 3) without what one alone has, as a pocket or a bag: where they differ, both are what is more usual for both around."""
    half = light / 2 * np.array([-1, 1])[None, :, None]
    even = sides - half
    size = 2 * round(ODD_METRES / SIDE_ROW_METRES) + 1
    usual = median_filter(even.reshape(-1, 3), (size, 1), mode="nearest").reshape(even.shape)  # rows of both, in turn
    off = 1 + ((even - usual) ** 2).sum(-1, keepdims=True)
    share = off[:, ::-1] / off.sum(1, keepdims=True)
    return np.asarray((share * even).sum(1, keepdims=True) + half, np.float32)


def _fine(change: NDArray[np.float32], known: NDArray[np.bool_], step: float) -> NDArray[np.float32]:
    """What is fine about a `change` (A, N, 3) of cloth, where it is known and plain: no lines of prints, pockets and seams, nor what is beside them."""
    soft = FINE_METRES / step
    there = known.astype(np.float32)
    odd = np.abs(_off_its_mean(change, there, soft)).max(-1) > MAX_FINE_LEVELS
    reach = 2 * round(2 * soft) + 1
    plain = known & (cv2.dilate(odd.astype(np.uint8), np.ones((reach, reach), np.uint8)) == 0)
    weight = plain.astype(np.float32)
    within = np.clip(2 * cv2.GaussianBlur(weight, (0, 0), soft) - 1, 0, 1) * weight
    return np.asarray(_off_its_mean(change, weight, soft) * within[..., None], np.float32)


def _off_its_mean(values: NDArray[np.float32], weight: NDArray[np.float32], soft: float) -> NDArray[np.float32]:
    """How far values (A, N, 3) are off the mean about them of what has a weight (A, N)."""
    mass = np.maximum(cv2.GaussianBlur(weight, (0, 0), soft), 1e-3)[..., None]
    return np.asarray(values - cv2.GaussianBlur(values * weight[..., None], (0, 0), soft) / mass, np.float32)
