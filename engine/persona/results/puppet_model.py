"""The puppet as a model for other programs: the face with its texture, and ARKit's face units as morph targets."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from engine.body.face.face_points import PICTURE_TO_TEMPLATE
from engine.body.template import FACE_UNITS
from engine.export.gltf.glb import CharacterModel, write_glb
from engine.export.gltf.materials import Material
from engine.geometry.rigging.morph_target import morph_target
from engine.geometry.rigging.skeleton import Skeleton
from engine.geometry.rigging.skinned_mesh import SkinnedMesh
from engine.persona.persona import Persona
from engine.persona.puppet import Puppet
from engine.persona.results.face_units import FaceUnits
from engine.persona.results.inner_parts import InnerPart, inner_parts
from engine.persona.results.inside_atlas import inside_atlas

EYE_DISTANCE = 0.063
"""Metres between the middles of the eyes: people's mean, since no photograph tells how large somebody is."""
NECK_PIVOT_EYE_DISTANCES = (0.0, -0.9, 1.3)
"""About where a head turns, in eye distances from between the eyes, in the axes of pictures."""
MOIST_ROUGHNESS = 0.5
"""Of eyes, teeth and tongue, which are moist."""
MIN_UNIT_OFFSET_METRES = 1e-4
"""Metres that a unit moves a vertex by, at least."""


def write_puppet(path: Path, persona: Persona, units: FaceUnits, texture: NDArray[np.uint8], synthetic: bool) -> None:
    """Write the GLB. It holds the neutral face with the average shape's relief, y up, facing +z, one joint that turns
    it, `Head`, and all of ARKit's face units. Behind openings for eyes and mouth is what is there
    (`engine.persona.results.inner_parts`), with a material of its own.

    texture : (H, W, 3) of the persona's frame.
    """
    puppet = Puppet(persona, openings=True)
    metres = PICTURE_TO_TEMPLATE * EYE_DISTANCE
    inside = inner_parts(puppet, units)
    atlas, places = inside_atlas(inside)
    parts = [_skin(puppet, units, texture), *inside]
    starts = np.cumsum([0, *(len(part.vertices) for part in parts)])
    head = (np.array([NECK_PIVOT_EYE_DISTANCES]) @ metres).astype(np.float32)
    mesh = SkinnedMesh(
        Skeleton(("Head",), np.array([-1], np.int32), head),
        (np.concatenate([part.vertices for part in parts]) @ metres).astype(np.float32),
        np.concatenate([part.triangles + start for part, start in zip(parts, starts, strict=False)]).astype(np.int32),
        np.concatenate([parts[0].uv, *places]),
        np.zeros((starts[-1], 4), np.uint8),
        np.tile(np.array([1, 0, 0, 0], np.float32), (starts[-1], 1)),
        texture,
    )
    morphs = []
    for unit in FACE_UNITS:
        moved = np.concatenate([part.moved.get(unit, np.zeros_like(part.vertices)) for part in parts])
        morphs.append(morph_target(unit, moved @ metres, MIN_UNIT_OFFSET_METRES))
    materials = [Material("skin"), Material("inside", atlas, alpha="MASK", roughness=MOIST_ROUGHNESS)]
    material_of = np.repeat([0, 1], [len(parts[0].triangles), sum(len(part.triangles) for part in inside)])
    model = CharacterModel(mesh, unlit=False, morphs=morphs, materials=materials, material_of=material_of)
    write_glb(path, model, name="puppet", synthetic=synthetic)


def _skin(puppet: Puppet, units: FaceUnits, texture: NDArray[np.uint8]) -> InnerPart:
    surface = puppet.surface
    moved = {name: puppet.finer(one) for name, one in zip(units.names, units.moved, strict=True)}
    return InnerPart("skin", puppet.vertices(puppet.persona.neutral), surface.triangles, surface.uv, texture, moved)
