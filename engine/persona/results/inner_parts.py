"""What lies behind the skin of the model: eyeballs and the rims of their lids, teeth, a tongue, and the mouth's bag."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import maximum_filter1d, uniform_filter1d

from engine.face_animation.mouth.modelled.jaw import CHIN_VERTICES
from engine.face_animation.mouth.modelled.modelled_mouth import jaw_behind_lips
from engine.face_animation.mouth.modelled.mouth_parts import (
    TONGUE_JAW_SHARE,
    bag_surface,
    modelled_teeth,
    mouth_bag,
    tongue,
    tongue_put_out,
)
from engine.face_animation.skin_colour import skin_colour
from engine.perception.face.landmarks import LIPS_INNER
from engine.persona.eyes.eye_texture import eye_textures
from engine.persona.eyes.eyeball import EYE_AND_IRIS_VERTICES, eyeball, lid_rim
from engine.persona.mouth.persona_mouth import puppet_mouth
from engine.persona.mouth.teeth_sheet import SHEET_MESH_COLUMNS, teeth_sheet
from engine.persona.puppet import Puppet
from engine.persona.results.behind_skin import BehindSkin
from engine.persona.results.face_units import OPEN_JAW, FaceUnits

BACKWARD_AXIS = np.array([0.0, 0.0, 1.0])
EVEN_COLUMNS = 4
"""Columns of a sheet of teeth to either side over which its arch is bent."""
JAW_MOVES = ("jawForward", "jawLeft", "jawRight")
"""Face units that move a jaw as it is."""
BAG_DEEPER = 1.5
LAYER_GAP_EYE_DISTANCES = np.array([0, 0, 2e-3])
"""Eye distances behind the skin at which what is tied to it begins: at one place with it, both would be shaded as one surface."""
LID_RIM_LIGHT = 0.5
"""Of the skin's light, that the rims of lids have, which lie in their shade."""


@dataclass(frozen=True)
class InnerPart:
    """A part of the model at rest, of a head from the front, in eye distances, y down and z away.

    vertices : (V, 3).
    triangles : (T, 3), counter-clockwise from outside.
    uv : (V, 2).
    texture : (h, w, 3 or 4) uint8.
    moved : (V, 3) by which face units move it.
    """

    name: str
    vertices: NDArray[np.float64]
    triangles: NDArray[np.int32]
    uv: NDArray[np.float32]
    texture: NDArray[np.uint8]
    moved: Mapping[str, NDArray[np.float64]] = field(default_factory=dict)


def inner_parts(puppet: Puppet, units: FaceUnits) -> list[InnerPart]:
    """All of them."""
    return [*_eyes(puppet, units), *_mouth(puppet, units)]


def _eyes(puppet: Puppet, units: FaceUnits) -> list[InnerPart]:
    persona = puppet.persona
    relief = puppet.vertices(persona.neutral)
    finer = np.array([puppet.finer(moved) for moved in units.moved])
    skins = np.concatenate([relief[None], relief + finer])
    near = np.linalg.norm(relief[:, :2], axis=1) < 1.2
    lids = skins[:, near].reshape(-1, 3)
    balls = {side: eyeball(persona.neutral, side, lids) for side in EYE_AND_IRIS_VERTICES}
    textures = eye_textures(persona, {side: ball.radius / ball.width for side, ball in balls.items()})
    shade = np.rint(LID_RIM_LIGHT * skin_colour(persona.average, persona.frame.places[:478])).astype(np.uint8)
    parts = []
    for side, ball in balls.items():
        looks = {f"eyeLook{way}{side}": ball.turned(way) for way in ("In", "Out", "Up", "Down")}
        name = f"{side.lower()}_eye"
        parts.append(InnerPart(name, ball.vertices, ball.triangles, ball.uv, textures[side], looks))
        contour = list(EYE_AND_IRIS_VERTICES[side][0])
        rim, triangles = lid_rim(relief[contour] + LAYER_GAP_EYE_DISTANCES)
        moves = {unit: np.tile(moved[contour], (2, 1)) for unit, moved in zip(units.names, units.moved, strict=True)}
        flat = np.broadcast_to(shade, (8, 8, 3)).copy()
        parts.append(InnerPart(f"{name}_rim", rim, triangles, np.full((len(rim), 2), 0.5, np.float32), flat, moves))
    return parts


def _mouth(puppet: Puppet, units: FaceUnits) -> list[InnerPart]:
    persona = puppet.persona
    mouth = puppet_mouth(persona)
    at, colours = mouth.at, mouth.colours
    open_jaw = jaw_behind_lips(at, persona.neutral + units.doing({OPEN_JAW: 1.0}))

    def with_jaw(vertices: NDArray[np.float64], share: float = 1.0) -> dict[str, NDArray[np.float64]]:
        moves = {OPEN_JAW: open_jaw._replace(angle=share * open_jaw.angle).moved(vertices) - vertices}
        for unit in JAW_MOVES:
            chin = units.doing({unit: 1.0})[list(CHIN_VERTICES)].mean(axis=0)
            moves[unit] = np.broadcast_to(chin, vertices.shape)
        return moves

    skin = BehindSkin(puppet, units)
    if mouth.photo is None:
        row = modelled_teeth(at, True)
        upper = InnerPart("upper_teeth", _set_back(row.vertices, skin, {}), row.triangles, row.uv, colours.upper)
    else:
        sheet = teeth_sheet(mouth.photo)
        bent = sheet.vertices + _evenly(skin.needed(sheet.vertices, {}))[:, None] * BACKWARD_AXIS
        upper = InnerPart("upper_teeth", *sheet._replace(vertices=bent))
    row, flesh = modelled_teeth(at, False), tongue(at)
    lower = _set_back(row.vertices, skin, with_jaw(row.vertices))
    lying = _set_back(flesh.vertices, skin, with_jaw(flesh.vertices, TONGUE_JAW_SHARE))
    out = {"tongueOut": tongue_put_out(), **with_jaw(lying, TONGUE_JAW_SHARE)}
    triangles, uv = bag_surface()
    lips = puppet.vertices(persona.neutral)[list(LIPS_INNER)] + LAYER_GAP_EYE_DISTANCES
    bag = mouth_bag(lips, BAG_DEEPER)
    follows = {
        unit: mouth_bag(lips + moved[list(LIPS_INNER)], BAG_DEEPER) - bag
        for unit, moved in zip(units.names, units.moved, strict=True)
    }
    bag[len(lips) :, 2] += skin.needed(bag, follows)[len(lips) :]  # its first ring is tied to the lips
    return [
        upper,
        InnerPart("lower_teeth", lower, row.triangles, row.uv, colours.lower, with_jaw(lower)),
        InnerPart("tongue", lying, flesh.triangles, flesh.uv, colours.tongue, out),
        InnerPart("mouth", bag, triangles, uv, colours.bag, follows),
    ]


def _set_back(
    vertices: NDArray[np.float64], skin: BehindSkin, moved: Mapping[str, NDArray[np.float64]]
) -> NDArray[np.float64]:
    """As a solid: as far as the vertex that needs it most."""
    return np.asarray(vertices + skin.needed(vertices, moved).max() * BACKWARD_AXIS, np.float64)


def _evenly(needed: NDArray[np.float64]) -> NDArray[np.float64]:
    """(V,) at least as much as the vertices of a sheet of teeth need, and the same along each of its columns. It grows
    smoothly with their distance from the middle, as an arch is bent."""
    columns = needed.reshape(-1, SHEET_MESH_COLUMNS + 1).max(axis=0)
    half = np.maximum(columns, columns[::-1])[SHEET_MESH_COLUMNS // 2 :]
    outward = np.maximum.accumulate(half)
    whole = maximum_filter1d(np.concatenate([outward[:0:-1], outward]), 2 * EVEN_COLUMNS + 1, mode="nearest")
    smooth = uniform_filter1d(whole, 2 * EVEN_COLUMNS + 1, mode="nearest")
    return np.tile(smooth, len(needed) // (SHEET_MESH_COLUMNS + 1))
