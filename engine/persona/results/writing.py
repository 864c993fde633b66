"""What a job leaves of a persona beside its film."""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from engine.export.still import write_still
from engine.persona.collection.coverage import MIN_PHOTOS_OF_EXPRESSION
from engine.persona.persona import Persona
from engine.persona.results.expression_textures import expression_textures, write_expression_textures
from engine.persona.results.face_units import EXPRESSION_UNITS, face_units
from engine.persona.results.pictures import Studio, angles, average_light, gallery, sheet
from engine.persona.results.puppet_model import write_puppet
from engine.persona.results.shown_expressions import photos_near, shown_expressions

RESULT_PICTURE_SIZE = (360, 440)
SMALL_SIZE = (144, 176)
EXPRESSIONS_FROM_ANGLES = 2
"""Beside the face at rest."""
GALLERY_COLUMNS = 4


def write_results(
    out: Path, persona: Persona, average: NDArray[np.uint8], background: tuple[int, int, int], synthetic: bool
) -> dict[str, int]:
    """Write `puppet.glb`, `puppet_textures.jpg` and `.json`, `gallery.jpg` and `.json` with a picture of each expression,
    `angles.jpg`, and `average_light.jpg`.

    average : (H, W, 3) the texture of the face at rest. Returns how many photographs come near each expression.
    """
    units = face_units(persona)
    write_puppet(out / "puppet.glb", persona, units, average, synthetic)
    write_expression_textures(out, expression_textures(persona, units), synthetic)
    near = {name: len(photos) for name, photos in photos_near(persona, units).items()}
    shown = shown_expressions(persona, units)
    studio = Studio(persona, RESULT_PICTURE_SIZE, background)
    pictures = gallery(studio, shown)
    names = [one.name for one in shown]
    for name, picture in zip(names, pictures[1:], strict=True):
        write_still(out / f"gallery_{name}.jpg", picture, synthetic)
    write_still(out / "gallery.jpg", sheet(pictures, GALLERY_COLUMNS), synthetic)
    _tell_gallery(out / "gallery.json", names, near)
    strongest = sorted(shown, key=lambda one: -len(one.photos))[:EXPRESSIONS_FROM_ANGLES]
    write_still(out / "angles.jpg", angles(studio, strongest), synthetic)
    small = Studio(persona, SMALL_SIZE, background)
    write_still(out / "average_light.jpg", average_light(small, units), synthetic)
    return near


def _tell_gallery(path: Path, names: Sequence[str], near: dict[str, int]) -> None:
    """What the pictures of `gallery.jpg` show, row by row, and what is not there since too few photographs come near it."""
    told = {
        "tile": list(RESULT_PICTURE_SIZE),
        "columns": GALLERY_COLUMNS,
        "shown": [
            {"name": "neutral"},
            *({"name": name, "photos": near[name], "units": dict(EXPRESSION_UNITS[name])} for name in names),
        ],
        "left_out": [
            {
                "name": name,
                "photos": near[name],
                "why": "few" if near[name] < MIN_PHOTOS_OF_EXPRESSION else "like_another",
            }
            for name in EXPRESSION_UNITS
            if name not in names
        ],
        "photos_needed": MIN_PHOTOS_OF_EXPRESSION,
    }
    path.write_text(json.dumps(told, indent=1) + "\n")
