"""Where things are on the unrolled head: a face has its eyes, its chin and its ears at the same places on all templates."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.character.fit.template_fit import load_human
from engine.character.shell.colours.unrolled import UNROLLED_COLUMNS, unrolled_parts
from engine.character.shell.template_mesh import template_mesh

BROW_LANDMARKS, EYES_LANDMARKS, NOSE_TIP_LANDMARK, CHIN_LANDMARK = slice(17, 27), slice(36, 48), 30, 8
"""Of the 68 points of a face."""
MIN_HAIRLINE_SHARE = 0.25
"""How far above the brows hair begins at the earliest, as a share of the way to the crown."""
NAPE_HEIGHT_SHARE = 0.35
"""How far above the chin hair ends behind, as a share of the way to the nose."""
SURE_EAR_CELLS, EAR_MARGIN_CELLS = 13, 7
"""Cells of a square all of which are the template's ear's for its middle to be surely an ear's, and some of which for it to be so perhaps: the
template's has skin around it, over which hair falls."""


@dataclass(frozen=True)
class HeadMap:
    """The head's cells (A, `UNROLLED_COLUMNS`), row 0 at the neck.

    height : (A, 1) float32, rows up from the part's beginning.
    angle : (1, `UNROLLED_COLUMNS`) float32, radians from the face's middle, from 0 to pi on both sides.
    ears, around_ears : (A, `UNROLLED_COLUMNS`) bool, what is surely an ear's, and what is perhaps.
    levels : heights by name: `nape`, `chin`, `nose`, `ears` (their middle), `eyes`, `brow`, `hairline` (no hair is below it before
        the face), `forehead`, `crown`.
    """

    height: NDArray[np.float32]
    angle: NDArray[np.float32]
    ears: NDArray[np.bool_]
    around_ears: NDArray[np.bool_]
    levels: dict[str, float]

    def between(self, lower: str, upper: str) -> NDArray[np.bool_]:
        """The rows (A, 1) from one level to another."""
        return np.asarray((self.height > self.levels[lower]) & (self.height < self.levels[upper]))

    def above(self, level: str) -> NDArray[np.bool_]:
        """The rows (A, 1) above a level."""
        return np.asarray(self.height > self.levels[level])


@cache
def head_map() -> HeadMap:
    """The head's, once for the process."""
    mesh, human = template_mesh(), load_human()
    part = unrolled_parts()[0]
    face, row = mesh.renamed(human.face), part.along
    rows = len(part.raster.triangle)
    brow, eyes = (float(row[face[which]].mean()) for which in (BROW_LANDMARKS, EYES_LANDMARKS))
    nose, chin = (float(row[face[which]]) for which in (NOSE_TIP_LANDMARK, CHIN_LANDMARK))
    levels = {
        "nape": chin + NAPE_HEIGHT_SHARE * (nose - chin),
        "chin": chin,
        "nose": nose,
        "ears": (eyes + nose) / 2,
        "eyes": eyes,
        "brow": brow,
        "hairline": brow + MIN_HAIRLINE_SHARE * (rows - brow),
        "forehead": (brow + rows) / 2,
        "crown": float(rows),
    }
    angle = (np.arange(UNROLLED_COLUMNS) + 0.5) / UNROLLED_COLUMNS * 2 * np.pi - np.pi
    around = np.asarray(mesh.ear[mesh.triangles[part.raster.triangle]].all(-1), np.uint8)
    square = np.ones((EAR_MARGIN_CELLS, EAR_MARGIN_CELLS), np.uint8)
    return HeadMap(
        (np.arange(rows, dtype=np.float32) + 0.5)[:, None],
        np.abs(angle).astype(np.float32)[None],
        np.asarray(cv2.erode(around, np.ones((SURE_EAR_CELLS,) * 2, np.uint8)) > 0),
        np.asarray(cv2.dilate(around, square) > 0),
        levels,
    )
