"""ARKit's face units as this person's face does them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from engine.geometry.rigging.joint_names import SIDE_NAMES
from engine.persona.motion.deformation_transfer import DeformationTransfer
from engine.persona.motion.mesh_units import EYE_OUTLINE_VERTICES, lids_met, load_mesh_units
from engine.persona.motion.performance import FRAME_SIZE
from engine.persona.persona import Persona
from engine.persona.puppet import FACE_VERTICES
from engine.persona.texture.texture_frame import texture_frame


def _both(unit: str, weight: float) -> dict[str, float]:
    return {f"{unit}{side}": weight for side in SIDE_NAMES}


OPEN_JAW, LIPS_CLOSED = "jawOpen", "mouthClose"
"""Lips that close over an open jaw: the second says nothing alone."""
MIN_UNIT_MOTION_EYE_DISTANCES = 0.03
"""Eye distances, two millimetres: a unit that moves nothing farther shows nothing."""
EXPRESSION_UNITS: Mapping[str, Mapping[str, float]] = {
    "smile": {**_both("mouthSmile", 0.8), **_both("cheekSquint", 0.5)},
    "laugh": {**_both("mouthSmile", 0.9), "jawOpen": 0.4, **_both("mouthUpperUp", 0.3)},
    "surprise": {"browInnerUp": 0.9, **_both("browOuterUp", 0.9), "jawOpen": 0.35, **_both("eyeWide", 0.6)},
    "anger": {**_both("browDown", 0.9), **_both("eyeSquint", 0.4), **_both("mouthPress", 0.4)},
    "sadness": {"browInnerUp": 0.7, **_both("mouthFrown", 0.8), "mouthShrugLower": 0.3},
    "open_mouth": {"jawOpen": 0.6},
    "pursed_lips": {"mouthPucker": 0.9},
}
"""What each is made of."""


@dataclass(frozen=True)
class FaceUnits:
    """`names` of U units; `moved` (U, 478, 3) float64, by how much each moves the persona's neutral face, in eye distances."""

    names: tuple[str, ...]
    moved: NDArray[np.float64]

    def doing(self, weights: Mapping[str, float]) -> NDArray[np.float64]:
        """(478, 3) by how much a mixture moves it."""
        return np.asarray(sum(weight * self.moved[self.names.index(name)] for name, weight in weights.items()))


def face_units(persona: Persona) -> FaceUnits:
    """The template's units carried to the persona as a driver's movements are: lids meet, lips close. Those that a face mesh does not
    show are left out: the tongue's, and where eyes look to."""
    known = load_mesh_units()
    transfer = DeformationTransfer(texture_frame(known.rest, FRAME_SIZE), texture_frame(persona.neutral, FRAME_SIZE))
    jaw, closed = known.names.index(OPEN_JAW), known.names.index(LIPS_CLOSED)
    movements = known.moved.copy()
    movements[closed] += known.moved[jaw]
    moved = transfer.of_frames(movements)
    moved[closed] -= moved[jaw]
    for side, contour in EYE_OUTLINE_VERTICES.items():
        blink = known.names.index(f"eyeBlink{side}")
        moved[blink] = lids_met(persona.neutral, moved[blink], contour)
    shown = np.linalg.norm(moved[:, :FACE_VERTICES], axis=-1).max(axis=1) > MIN_UNIT_MOTION_EYE_DISTANCES
    return FaceUnits(tuple(name for name, one in zip(known.names, shown, strict=True) if one), moved[shown])
