"""The folds that an expression presses into the skin, as relief over the map of the head.

Each group of furrows belongs to a muscle's action: it deepens with the face units that stand for it. A furrow
is a narrow groove between two soft bulges, since skin that is pressed together has to go somewhere.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from engine.performances.modelling.chart import CHART_SHAPE, curve_coordinates

Curve = list[tuple[float, float]]


@dataclass(frozen=True)
class Furrow:
    """A curve (u, v) on the map, its depth and the half width of its groove, millimetres."""

    curve: Curve
    depth: float
    width: float


FOREHEAD_FURROWS = (
    Furrow(
        [(-0.046, 0.8225), (-0.030, 0.8262), (-0.012, 0.8243), (0.008, 0.8236), (0.028, 0.8266), (0.045, 0.8215)],
        0.34,
        0.75,
    ),
    Furrow(
        [(-0.049, 0.8305), (-0.029, 0.8345), (-0.008, 0.8322), (0.014, 0.8330), (0.033, 0.8352), (0.049, 0.8298)],
        0.44,
        0.85,
    ),
    Furrow([(-0.043, 0.8392), (-0.022, 0.8425), (0.002, 0.8408), (0.024, 0.8428), (0.044, 0.8386)], 0.36, 0.85),
    Furrow([(-0.030, 0.8480), (-0.008, 0.8492), (0.012, 0.8484), (0.031, 0.8490)], 0.22, 0.80),
)
"""The frontalis raises the brows and lays the forehead in lines."""

CROWS_FEET = (
    Furrow([(0.0490, 0.7945), (0.0545, 0.7972), (0.0610, 0.8012)], 0.24, 0.55),
    Furrow([(0.0500, 0.7915), (0.0565, 0.7922), (0.0645, 0.7938)], 0.30, 0.55),
    Furrow([(0.0495, 0.7885), (0.0560, 0.7868), (0.0635, 0.7858)], 0.28, 0.55),
    Furrow([(0.0475, 0.7858), (0.0535, 0.7822), (0.0595, 0.7785)], 0.20, 0.55),
)
"""The outer ring of the orbicularis gathers the skin at the temple."""

UNDER_EYE = (
    Furrow([(0.0205, 0.7835), (0.0275, 0.7803), (0.0355, 0.7805), (0.0445, 0.7845)], 0.26, 0.60),
    Furrow([(0.0185, 0.7810), (0.0265, 0.7763), (0.0365, 0.7757), (0.0470, 0.7795)], 0.30, 0.80),
)

NASOLABIAL_FURROWS = (
    Furrow([(0.0178, 0.7570), (0.0222, 0.7495), (0.0272, 0.7405), (0.0312, 0.7305), (0.0325, 0.7215)], 0.75, 1.10),
)
"""The fold between cheek and lip, from the wing of the nose around the corner of the mouth."""

DIMPLE_FURROWS = (
    Furrow([(0.0345, 0.7285), (0.0372, 0.7215), (0.0365, 0.7135)], 0.26, 0.95),
    Furrow([(0.0265, 0.7235), (0.0278, 0.7200), (0.0262, 0.7165)], 0.30, 0.60),
)

GLABELLA_FURROWS = (
    Furrow([(0.0055, 0.8010), (0.0062, 0.8075), (0.0048, 0.8140)], 0.32, 0.70),
    Furrow([(-0.0062, 0.8015), (-0.0068, 0.8070), (-0.0056, 0.8125)], 0.28, 0.70),
)

CHIN_FURROWS = (Furrow([(-0.014, 0.7015), (-0.006, 0.7035), (0.004, 0.7036), (0.0135, 0.7012)], 0.30, 0.9),)


@dataclass(frozen=True)
class Wrinkles:
    """Relief of each group at full strength, metres: `relief` (G, H, W) float32; `weights` gives, for each
    group, the face units that press it in."""

    names: tuple[str, ...]
    relief: NDArray[np.float32]


PRESSED_BY: Mapping[str, Mapping[str, float]] = {
    "forehead_left": {"browInnerUp": 0.45, "browOuterUpLeft": 0.6},
    "forehead_right": {"browInnerUp": 0.45, "browOuterUpRight": 0.6},
    "crows_feet_left": {"cheekSquintLeft": 0.75, "mouthSmileLeft": 0.25, "eyeSquintLeft": 0.3},
    "crows_feet_right": {"cheekSquintRight": 0.75, "mouthSmileRight": 0.25, "eyeSquintRight": 0.3},
    "under_eye_left": {"cheekSquintLeft": 0.7, "eyeSquintLeft": 0.5, "eyeBlinkLeft": 0.12},
    "under_eye_right": {"cheekSquintRight": 0.7, "eyeSquintRight": 0.5, "eyeBlinkRight": 0.12},
    "nasolabial_left": {"mouthSmileLeft": 0.85, "mouthUpperUpLeft": 0.3, "noseSneerLeft": 0.4},
    "nasolabial_right": {"mouthSmileRight": 0.85, "mouthUpperUpRight": 0.3, "noseSneerRight": 0.4},
    "dimple_left": {"mouthSmileLeft": 0.6, "mouthDimpleLeft": 0.8},
    "dimple_right": {"mouthSmileRight": 0.6, "mouthDimpleRight": 0.8},
    "glabella": {"browDownLeft": 0.5, "browDownRight": 0.5},
    "chin": {"mouthShrugLower": 0.8},
}
"""How strongly each face unit presses in each group."""

REST_STRENGTHS = {
    "nasolabial_left": 0.16,
    "nasolabial_right": 0.18,
    "under_eye_left": 0.22,
    "under_eye_right": 0.2,
    "forehead_left": 0.07,
    "forehead_right": 0.07,
}
"""How strongly groups are pressed on a face at rest: what thirty years have left behind."""


def carve() -> Wrinkles:
    """Draw the relief of all groups."""
    groups: dict[str, NDArray[np.float32]] = {}
    for name, furrows in (
        ("crows_feet", CROWS_FEET),
        ("under_eye", UNDER_EYE),
        ("nasolabial", NASOLABIAL_FURROWS),
        ("dimple", DIMPLE_FURROWS),
    ):
        groups[f"{name}_left"] = _relief(furrows)
        groups[f"{name}_right"] = groups[f"{name}_left"][:, ::-1]
    forehead = _relief(FOREHEAD_FURROWS)
    left = 1 / (1 + np.exp(-np.linspace(-9, 9, CHART_SHAPE[1], dtype=np.float32)[None] * 2.2))
    groups["forehead_left"], groups["forehead_right"] = forehead * left, forehead * (1 - left)
    groups["glabella"], groups["chin"] = _relief(GLABELLA_FURROWS), _relief(CHIN_FURROWS)
    return Wrinkles(tuple(groups), np.stack([np.ascontiguousarray(relief) for relief in groups.values()]))


def wrinkle_relief(wrinkles: Wrinkles, units: Mapping[str, float]) -> NDArray[np.float32]:
    """The relief (H, W) float32 metres that a face with these unit weights wears."""
    total = np.zeros(CHART_SHAPE, np.float32)
    for name, relief in zip(wrinkles.names, wrinkles.relief, strict=True):
        strength = sum(share * max(units.get(unit, 0.0), 0.0) for unit, share in PRESSED_BY[name].items())
        strength = REST_STRENGTHS.get(name, 0.0) + strength
        if strength > 0.01:
            total += np.float32(strength) * relief
    return total


def _relief(furrows: tuple[Furrow, ...]) -> NDArray[np.float32]:
    total = np.zeros(CHART_SHAPE, np.float32)
    for furrow in furrows:
        width, depth = furrow.width / 1000, furrow.depth / 1000
        distance, place, (rows, columns) = curve_coordinates(furrow.curve, 6 * width)
        # shallow at both ends, and never quite even in between
        ends = np.clip(np.sin(np.pi * place), 0, 1) ** 0.7 * (0.85 + 0.15 * np.sin(17 * place + 40 * width * 1000))
        groove = -np.exp(-0.5 * (distance / width) ** 2)
        bulge = 0.45 * np.exp(-0.5 * ((np.abs(distance) - 2.6 * width) / (1.5 * width)) ** 2)
        total[rows, columns] += (depth * ends * (groove + bulge)).astype(np.float32)
    return total
