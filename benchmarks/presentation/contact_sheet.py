"""Contact sheets: rows of pictures side by side, each row under its title."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.media.image import write_image

Picture = NDArray[np.uint8]
"""(h, w, 3) uint8."""

GAP_PIXELS = 4
"""Pixels of paper between cells and between rows."""
TITLE_PIXELS = 22
"""Pixels of a title's line."""
BASELINE_PIXELS = 15
"""Pixels from the top of a title's line to the letters' feet."""
SHEET_GREY_LEVEL = 235
"""Grey level of the sheet."""
INK_GREY_LEVEL = 20
"""Grey level of the letters."""


class Row(NamedTuple):
    """Pictures side by side, and the title above them, in ASCII; "" for none."""

    pictures: Sequence[Picture]
    title: str = ""


def contact_sheet(
    rows: Sequence[Row], cell: tuple[int, int] | None = None, gap: int = GAP_PIXELS, max_width: int | None = None
) -> Picture:
    """The rows (H, W, 3) one under the other; what is narrower or lower than its place is on paper.

    Parameters
    ----------
    cell : height and width into which each picture is fitted whole, in the middle; None leaves them as they are.
    gap : pixels of paper between cells and between rows.
    max_width : pixels above which the whole sheet is made smaller.
    """
    strips = [_side_by_side([fitted(one, cell) if cell else one for one in row.pictures], gap) for row in rows]
    width = max(strip.shape[1] for strip in strips)
    lines: list[Picture] = []
    for row, strip in zip(rows, strips, strict=True):
        if lines:
            lines.append(_paper(gap, width))
        if row.title:
            lines.append(_title(row.title, width))
        lines.append(np.pad(strip, ((0, 0), (0, width - strip.shape[1]), (0, 0)), constant_values=SHEET_GREY_LEVEL))
    sheet = np.concatenate(lines)
    if max_width is None or width <= max_width:
        return sheet
    size = (max_width, round(sheet.shape[0] * max_width / width))
    return np.asarray(cv2.resize(sheet, size, interpolation=cv2.INTER_AREA), np.uint8)


def write_sheet(path: Path, sheet: Picture) -> None:
    """Write a sheet (H, W, 3) in the format of the name's ending; its folder is made if it is not there."""
    path.parent.mkdir(parents=True, exist_ok=True)
    write_image(path, sheet)


def fitted(picture: Picture, cell: tuple[int, int]) -> Picture:
    """A picture as large as fits into the middle of a cell of a height and width, on paper."""
    height, width = cell
    scale = min(height / picture.shape[0], width / picture.shape[1])
    size = (max(1, round(picture.shape[1] * scale)), max(1, round(picture.shape[0] * scale)))
    out = _paper(height, width)
    y, x = (height - size[1]) // 2, (width - size[0]) // 2
    out[y : y + size[1], x : x + size[0]] = cv2.resize(picture, size, interpolation=cv2.INTER_AREA)
    return out


def at_height(picture: Picture, height: int) -> Picture:
    """A picture made as high as that, in its proportions."""
    return fitted(picture, (height, max(1, round(picture.shape[1] * height / picture.shape[0]))))


def evenly(pictures: Sequence[Picture], count: int) -> list[Picture]:
    """So many of the pictures, the first and the last among them, at even steps; all where there are fewer."""
    chosen = np.linspace(0, len(pictures) - 1, min(count, len(pictures))).round().astype(int)
    return [pictures[k] for k in chosen]


def _side_by_side(pictures: Sequence[Picture], gap: int) -> Picture:
    height = max(picture.shape[0] for picture in pictures)
    parts: list[Picture] = []
    for picture in pictures:
        if parts:
            parts.append(_paper(height, gap))
        parts.append(
            np.pad(picture, ((0, height - picture.shape[0]), (0, 0), (0, 0)), constant_values=SHEET_GREY_LEVEL)
        )
    return np.concatenate(parts, 1)


def _title(title: str, width: int) -> Picture:
    line = _paper(TITLE_PIXELS, width)
    cv2.putText(
        line, title, (GAP_PIXELS, BASELINE_PIXELS), cv2.FONT_HERSHEY_SIMPLEX, 0.5, (INK_GREY_LEVEL,) * 3, 1, cv2.LINE_AA
    )
    return line


def _paper(height: int, width: int) -> Picture:
    return np.full((height, width, 3), SHEET_GREY_LEVEL, np.uint8)
