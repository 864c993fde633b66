"""A drawn figure on plain paper: what cannot be reached from the picture's border without crossing a line.

Networks trained on photographs see little in a child's drawing, whose inside has the paper's colour. Its
outline is enough: find the strokes, close small gaps, and flood the paper from the border.
"""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.imaging.masks.mask_pieces import largest_piece
from engine.imaging.resample import resized, size_within

STROKES_SIZE_PIXELS = 400
"""Longest side, in pixels, at which strokes are looked for."""
MIN_STROKE_GREY_LEVELS = 18.0
"""Grey levels by which a stroke is darker, or of another colour, than the paper around it."""
MIN_PAPER_GREY_LEVEL = 100.0
"""Grey levels; darker ground is no paper, on which lines are darker still."""
MAX_BORDER_SHARE = 0.15
"""Largest share of the border that the figure may touch."""
MAX_FILLED_SHARE = 0.7
"""Share of a drawn figure in which it differs from the paper, at most: children's drawings have 0.4, coats on white walls 0.9."""
MIN_CERTAIN_SHARE = 0.4
"""Share of what the networks believe in (0.3 and more) that they are sure of (0.9 and more), above which the
picture is theirs. On photographs, paintings and cartoons it was 0.7 and more, on a child's drawing 0.05."""


def figure_on_plain_ground(
    rgb: NDArray[np.uint8], belief: NDArray[np.float32], known: NDArray[np.bool_] | None = None
) -> NDArray[np.float32] | None:
    """The figure's mask (H, W) in [0, 1], or None if this is no drawing on plain paper that networks miss.

    `belief` (H, W) is what the networks saw. If they are sure, they are believed. `known` (H, W) is what belongs to the
    figure although they may see nothing, as the face of one that they take for none.
    """
    if (belief > 0.9).sum() > MIN_CERTAIN_SHARE * (belief > 0.3).sum():
        return None
    size = size_within(rgb.shape, STROKES_SIZE_PIXELS)
    figure = _on_paper(resized(np.ascontiguousarray(rgb), size).astype(np.float32))
    if figure is None:
        return None
    rough = resized(belief, size)
    meant = rough > 0.3 if known is None else (rough > 0.3) | resized(known.astype(np.uint8), size, False).astype(bool)
    if not meant[figure].any():
        return None
    return np.clip(resized(figure.astype(np.float32), (rgb.shape[1], rgb.shape[0])), 0, 1)


def figure_on_paper(rgb: NDArray[np.uint8]) -> NDArray[np.bool_] | None:
    """The largest thing (H, W) that lines enclose on plain paper, whoever or whatever it is. None without paper or
    lines, or where it is no drawing of lines, which has the paper's colour inside."""
    small = resized(np.ascontiguousarray(rgb), size_within(rgb.shape, STROKES_SIZE_PIXELS)).astype(np.float32)
    figure = _on_paper(small)
    if figure is None or _strokes(small)[figure].mean() > MAX_FILLED_SHARE:
        return None
    return resized(figure.astype(np.float32), (rgb.shape[1], rgb.shape[0])) > 0.5


def _on_paper(small: NDArray[np.float32]) -> NDArray[np.bool_] | None:
    """What lines enclose on paper, at the size at which strokes are looked for."""
    strokes = _strokes(small)
    if _border(strokes).mean() > MAX_BORDER_SHARE or np.median(_border(small)) < MIN_PAPER_GREY_LEVEL:
        return None
    return _enclosed(strokes)


def _border(image: NDArray) -> NDArray:
    """What lies just within the border of an image (H, W, ...)."""
    return np.concatenate([image[2, 2:-2], image[-3, 2:-2], image[2:-2, 2], image[2:-2, -3]])


def _strokes(image: NDArray[np.float32]) -> NDArray[np.bool_]:
    """Where the colour differs from the paper's, the paper being the brightest of a wide neighbourhood."""
    side = 2 * (max(image.shape[:2]) // 8) + 1
    grey = np.asarray(image.min(-1), np.float32)
    paper = np.asarray(cv2.medianBlur(grey.astype(np.uint8), min(side, 101)), np.float32)
    lit = np.asarray(cv2.GaussianBlur(np.maximum(paper, grey), (0, 0), side / 4), np.float32)
    return np.asarray(lit - grey > MIN_STROKE_GREY_LEVELS)


def _enclosed(strokes: NDArray[np.bool_]) -> NDArray[np.bool_] | None:
    """The largest thing that the strokes enclose; None if it is too small to be a figure."""
    disk = cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (7, 7))
    closed = cv2.morphologyEx(np.pad(strokes.astype(np.uint8), 8), cv2.MORPH_CLOSE, disk)
    flooded = closed.copy()
    cv2.floodFill(flooded, None, (0, 0), (2,))
    inside = (flooded != 2)[8:-8, 8:-8]
    figure = largest_piece(inside, connectivity=8)
    return figure if figure.mean() > 0.03 else None
