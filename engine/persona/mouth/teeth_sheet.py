"""A photograph's upper teeth as a surface: the arch on which they lie, and their colours and shares on it."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from engine.face_animation.mouth.pictured.photo_teeth import PhotoTeeth
from engine.face_animation.mouth.pictured.teeth_strip import ARCH_CURVATURE_PER_EYE_DISTANCE

SHEET_HALF_WIDTH_EYE_DISTANCES, UPPER_MARGIN_EYE_DISTANCES, LOWER_MARGIN_EYE_DISTANCES = 0.45, 0.3, 0.04
"""Eye distances from the middle of the edge of the teeth."""
SHEET_MESH_COLUMNS, SHEET_MESH_ROWS = 32, 4
SHEET_PIXELS_PER_EYE_DISTANCE = 320
"""Of an eye distance."""


class TeethSheet(NamedTuple):
    """vertices : (V, 3) of a head from the front, in eye distances, y down and z away.
    triangles : (T, 3), counter-clockwise from before.
    uv : (V, 2).
    texture : (h, w, 4) uint8, with alpha.
    """

    vertices: NDArray[np.float64]
    triangles: NDArray[np.int32]
    uv: NDArray[np.float32]
    texture: NDArray[np.uint8]


def teeth_sheet(teeth: PhotoTeeth) -> TeethSheet:
    """That of a photograph's teeth, where the skull has them."""
    at = teeth.at
    across, down = (
        np.linspace(-SHEET_HALF_WIDTH_EYE_DISTANCES, SHEET_HALF_WIDTH_EYE_DISTANCES, SHEET_MESH_COLUMNS + 1),
        np.linspace(-UPPER_MARGIN_EYE_DISTANCES, LOWER_MARGIN_EYE_DISTANCES, SHEET_MESH_ROWS + 1),
    )
    x, y = (one.ravel() for one in np.meshgrid(across, down))
    vertices = np.column_stack([at.middle + x, at.edge + y, at.depth + ARCH_CURVATURE_PER_EYE_DISTANCE * x**2])
    uv = np.column_stack(
        [
            (x + SHEET_HALF_WIDTH_EYE_DISTANCES) / (2 * SHEET_HALF_WIDTH_EYE_DISTANCES),
            (y + UPPER_MARGIN_EYE_DISTANCES) / (UPPER_MARGIN_EYE_DISTANCES + LOWER_MARGIN_EYE_DISTANCES),
        ]
    ).astype(np.float32)
    index = np.arange((SHEET_MESH_ROWS + 1) * (SHEET_MESH_COLUMNS + 1)).reshape(
        SHEET_MESH_ROWS + 1, SHEET_MESH_COLUMNS + 1
    )
    a, b, c, d = index[:-1, :-1].ravel(), index[:-1, 1:].ravel(), index[1:, 1:].ravel(), index[1:, :-1].ravel()
    triangles = np.concatenate([np.stack([a, c, b], axis=1), np.stack([a, d, c], axis=1)]).astype(np.int32)
    width, height = (
        round(2 * SHEET_HALF_WIDTH_EYE_DISTANCES * SHEET_PIXELS_PER_EYE_DISTANCE),
        round((UPPER_MARGIN_EYE_DISTANCES + LOWER_MARGIN_EYE_DISTANCES) * SHEET_PIXELS_PER_EYE_DISTANCE),
    )
    columns = ((np.arange(width) + 0.5) / width * 2 - 1) * SHEET_HALF_WIDTH_EYE_DISTANCES
    rows = (np.arange(height) + 0.5) / height * (
        UPPER_MARGIN_EYE_DISTANCES + LOWER_MARGIN_EYE_DISTANCES
    ) - UPPER_MARGIN_EYE_DISTANCES
    layer = teeth.upper_teeth(np.stack(np.meshgrid(columns, rows), axis=-1))
    colours = teeth.lit(layer[..., :3])
    texture = np.dstack([colours, 255 * layer[..., 3]])
    return TeethSheet(vertices, triangles, uv, np.clip(np.rint(texture), 0, 255).astype(np.uint8))
