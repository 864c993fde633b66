"""The chosen frames of a clip side by side: what was seen of somebody, at a glance, long before there is an avatar."""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from engine.avatar.capture.chosen_frames import ChosenFrames
from engine.export.still import write_still

CELL_SIDE_PIXELS = 192
"""Pixels of the longer side of each frame on a sheet."""
FRAME_SHEET_COLUMNS = 10


def write_frame_sheets(folder: Path, clips: Mapping[str, ChosenFrames], synthetic: bool) -> list[Path]:
    """Write the frames of each clip, by its name, as one picture (`body_frames.jpg`), and `frames.json`, which says
    where each is. Sheets have `columns` frames in a row, each of `cell` (width, height) pixels. They lie row by row in
    the order of `frames`, their numbers in the clip, and `seconds`. `size` (width, height) is the clip's own.
    `synthetic` as `VideoWriter` takes it. Returns the paths."""
    document: dict[str, Any] = {}
    paths = []
    for name, chosen in clips.items():
        pictures = [chosen.picture(k, CELL_SIDE_PIXELS) for k in range(len(chosen))]
        paths.append(folder / f"{name}_frames.jpg")
        write_still(paths[-1], frame_sheet(pictures), synthetic)
        document[name] = {
            "sheet": paths[-1].name,
            "columns": min(FRAME_SHEET_COLUMNS, len(pictures)),
            "cell": [pictures[0].shape[1], pictures[0].shape[0]],
            "size": [chosen.size[1], chosen.size[0]],
            "frames": chosen.indices.tolist(),
            "seconds": np.round(chosen.seconds, 4).tolist(),
        }
    paths.append(folder / "frames.json")
    paths[-1].write_text(json.dumps(document) + "\n")
    return paths


def frame_sheet(pictures: list[NDArray[np.uint8]]) -> NDArray[np.uint8]:
    """Pictures of one size (H, W, 3) in rows of `FRAME_SHEET_COLUMNS`; what is left of the last row is black."""
    height, width = pictures[0].shape[:2]
    columns = min(FRAME_SHEET_COLUMNS, len(pictures))
    rows = -(-len(pictures) // columns)
    sheet = np.zeros((rows * height, columns * width, 3), np.uint8)
    for k, picture in enumerate(pictures):
        top, left = k // columns * height, k % columns * width
        sheet[top : top + height, left : left + width] = picture
    return sheet
