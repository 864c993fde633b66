"""What was drawn and what was made of it, side by side: one row a person."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from benchmarks.known_truth.comparison import Comparison
from benchmarks.presentation.contact_sheet import Row, at_height, contact_sheet, write_sheet
from engine.geometry.mesh.surface import vertex_normals
from engine.render.rasterisation.attributes import interpolate
from engine.render.rasterisation.rasteriser import rasterise

CELL_HEIGHT_PIXELS = 360
"""Pixels of a cell's height."""
CELL_HEIGHT_METRES = 2.1
"""Metres of a cell's height."""
VIEW_DEGREES = (90.0, 35.0)
"""Degrees by which the surfaces are turned."""
MISSED_RGB, EXCESS_RGB, SHARED_RGB = (230, 60, 50), (50, 90, 230), (210, 210, 210)
"""RGB of what the mask lacks, of what it has beyond the truth, and of what both have."""


def write_truth_sheet(path: Path, results: Sequence[Comparison]) -> None:
    """For each person: the picture, the mask (red: missed, blue: too much), and, turned, the truth, the character and the
    bare template."""
    write_sheet(path, contact_sheet([_row(result) for result in results]))


def _row(result: Comparison) -> Row:
    known, surfaces = result.known, result.surfaces
    found, true = result.mask > 0.5, known.alpha > 0.5
    mask = np.full((*true.shape, 3), 30, np.uint8)
    for region, colour in ((found & true, SHARED_RGB), (true & ~found, MISSED_RGB), (found & ~true, EXCESS_RGB)):
        mask[region] = colour
    cells = [at_height(picture, CELL_HEIGHT_PIXELS) for picture in (known.rgb, mask)]
    person = known.person
    truth = person.vertices * (1.8 / person.height)
    for degrees in VIEW_DEGREES:
        for vertices, triangles in (
            (truth, person.triangles),
            (result.aligned[0], surfaces.made[1]),
            (result.aligned[1], surfaces.template[1]),
        ):
            cells.append(_drawn(vertices, triangles, degrees))
    return Row(cells, f"{person.name}, {result.place}")


def _drawn(vertices: NDArray[np.float64], triangles: NDArray[np.integer], degrees: float) -> NDArray[np.uint8]:
    """A surface turned to its left, grey, lit from where one looks."""
    c, s = np.cos(np.deg2rad(degrees)), np.sin(np.deg2rad(degrees))
    turned = vertices @ np.array([[c, 0, s], [0, 1, 0], [-s, 0, c]]).T
    scale, width = CELL_HEIGHT_PIXELS / CELL_HEIGHT_METRES, CELL_HEIGHT_PIXELS * 5 // 8
    screen = np.stack(
        [turned[:, 0] * scale + width / 2, CELL_HEIGHT_PIXELS * 0.97 - turned[:, 1] * scale, -turned[:, 2] * scale], 1
    )
    raster = rasterise(screen, triangles, (CELL_HEIGHT_PIXELS, width))
    normals = interpolate(vertex_normals(turned, triangles), triangles, raster)
    light = np.abs(normals @ np.array([0.3, 0.4, 0.86], np.float32))[..., None] * 200 + 40
    return np.where((raster.triangle >= 0)[..., None], light * np.ones(3), 255).clip(0, 255).astype(np.uint8)
