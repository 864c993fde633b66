"""The textures of a few expressions, which viewers of the model blend as its face units are moved.

Creases are not in the shape: they come with the collection's own textures.
"""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from engine.export.still import write_still
from engine.persona.persona import Persona
from engine.persona.results.face_units import EXPRESSION_UNITS, FaceUnits

TEXTURED_EXPRESSIONS = ("smile", "surprise", "anger", "sadness", "open_mouth")
"""Of `EXPRESSION_UNITS`, those whose textures differ clearly."""


def expression_textures(
    persona: Persona, units: FaceUnits, names: Sequence[str] = TEXTURED_EXPRESSIONS
) -> NDArray[np.uint8]:
    """(1 + E, H, W, 3) the neutral face's texture, and those of the expressions, as the collection shows them."""
    faces = [persona.neutral, *(persona.neutral + units.doing(EXPRESSION_UNITS[name]) for name in names)]
    return persona.synthesis(persona.weights(np.array(faces)))


def write_expression_textures(folder: Path, textures: NDArray[np.uint8], synthetic: bool) -> tuple[Path, Path]:
    """Write `puppet_textures.jpg`, the textures of `expression_textures` side by side, and `puppet_textures.json`, which says what they
    are: a texture is blended in by how far its units are moved, each as a share of what is told there."""
    picture, document = folder / "puppet_textures.jpg", folder / "puppet_textures.json"
    write_still(picture, np.ascontiguousarray(np.concatenate(list(textures), axis=1)), synthetic)
    told = [
        {"name": "neutral", "units": {}},
        *({"name": name, "units": dict(EXPRESSION_UNITS[name])} for name in TEXTURED_EXPRESSIONS),
    ]
    size = [textures.shape[2], textures.shape[1]]
    document.write_text(json.dumps({"model": "puppet.glb", "size": size, "textures": told}, indent=1) + "\n")
    return picture, document
