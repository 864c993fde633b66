"""The connected pieces of a mask, and where a mask lies: its outline, its box, its height."""

from __future__ import annotations

from typing import Literal

import cv2
import numpy as np
from numpy.typing import NDArray

Connectivity = Literal[4, 8]
"""Which pixels hang together: those that share a side, or a side or a corner. A surface hangs together by no corners."""
Box = tuple[slice, slice]
"""Rows and columns of a part of a picture."""


def pieces_by_area(
    mask: NDArray[np.bool_], min_area: float = 1, connectivity: Connectivity = 4
) -> list[NDArray[np.bool_]]:
    """The pieces (H, W) of a mask (H, W) that have so many pixels at least, the largest first."""
    count, labels, stats, _ = cv2.connectedComponentsWithStats(mask.astype(np.uint8), connectivity=connectivity)
    areas = stats[1:count, cv2.CC_STAT_AREA]
    return [np.asarray(labels == 1 + k) for k in np.argsort(-areas, kind="stable") if areas[k] >= min_area]


def largest_piece(mask: NDArray[np.bool_], connectivity: Connectivity = 4) -> NDArray[np.bool_]:
    """The largest piece (H, W) of a mask (H, W); of an empty one nothing."""
    count, labels, stats, _ = cv2.connectedComponentsWithStats(mask.astype(np.uint8), connectivity=connectivity)
    return np.asarray(labels == 1 + int(np.argmax(stats[1:, cv2.CC_STAT_AREA]))) if count > 1 else mask


def pieces_touching(
    mask: NDArray[np.bool_], seed: NDArray[np.bool_], connectivity: Connectivity = 4
) -> NDArray[np.bool_]:
    """The pieces (H, W) of a mask (H, W) that have a pixel of `seed` (H, W): its reconstruction from there.

    Source: L. Vincent, Morphological grayscale reconstruction in image analysis, IEEE Trans. Image Processing 1993.
    """
    _, labels = cv2.connectedComponents(mask.astype(np.uint8), connectivity=connectivity)
    return np.asarray(mask & np.isin(labels, np.unique(labels[mask & seed])))


def without_small_pieces(mask: NDArray[np.bool_], min_area: float, connectivity: Connectivity = 4) -> NDArray[np.bool_]:
    """A mask (H, W) without its pieces of fewer pixels than `min_area`: its area opening."""
    _, labels, stats, _ = cv2.connectedComponentsWithStats(mask.astype(np.uint8), connectivity=connectivity)
    return np.asarray(mask & (stats[:, cv2.CC_STAT_AREA] >= min_area)[labels])


def outline(mask: NDArray[np.bool_]) -> NDArray[np.float64]:
    """The border pixels (m, 2), x and y, of the piece of a mask (H, W) whose outline holds the largest area, in order around it.

    Pixels that meet at a corner hang together, holes have no say. Raises ValueError if the mask is empty.
    """
    found, _ = cv2.findContours(mask.astype(np.uint8), cv2.RETR_EXTERNAL, cv2.CHAIN_APPROX_NONE)
    if not found:
        raise ValueError("an empty mask has no outline")
    return np.asarray(max(found, key=cv2.contourArea)[:, 0], np.float64)


def bounding_box(mask: NDArray[np.bool_], margin: int = 0) -> Box:
    """The rows and columns of a mask (H, W), and so many more on each side as there are.

    Raises ValueError if the mask is empty.
    """
    rows, columns = (np.flatnonzero(mask.any(axis)) for axis in (1, 0))
    if not len(rows):
        raise ValueError("an empty mask has no bounding box")
    return (
        slice(max(0, int(rows[0]) - margin), min(mask.shape[0], int(rows[-1]) + 1 + margin)),
        slice(max(0, int(columns[0]) - margin), min(mask.shape[1], int(columns[-1]) + 1 + margin)),
    )


def mask_height(mask: NDArray[np.bool_]) -> int:
    """Pixels from the first to the last row of a mask (H, W), both counted; 0 of an empty one."""
    rows = np.flatnonzero(mask.any(1))
    return int(rows[-1] - rows[0]) + 1 if len(rows) else 0


def rows_apart(mask: NDArray[np.bool_]) -> int:
    """Pixels between the centres of the first and the last row of a mask (H, W): a length as joints have it; 0 of an empty one."""
    return max(mask_height(mask) - 1, 0)
