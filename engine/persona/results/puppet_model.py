"""The puppet as a model for other programs: the face with its texture, and ARKit's face units as morph targets."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from engine.body.face.face_points import PICTURE_TO_TEMPLATE
from engine.export.glb import CharacterModel, write_glb
from engine.geometry.morph_target import morph_target
from engine.geometry.skeleton import Skeleton
from engine.geometry.skinned_mesh import SkinnedMesh
from engine.persona.persona import Persona
from engine.persona.puppet import Puppet
from engine.persona.results.face_units import FaceUnits

EYE_DISTANCE = 0.063
"""Metres between the middles of the eyes: people's mean, since no photograph tells how large somebody is."""
NECK = (0.0, -0.9, 1.3)
"""About where a head turns, in eye distances from between the eyes, in the axes of pictures."""
LEAST = 1e-4
"""Metres that a unit moves a vertex by, at least."""


def write_puppet(path: Path, persona: Persona, units: FaceUnits, texture: NDArray[np.uint8], synthetic: bool) -> None:
    """Write the GLB: the neutral face with the average shape's relief, y up, facing +z, one joint that turns it, `Head`; and `units`.

    texture : (H, W, 3) of the persona's frame.
    """
    puppet = Puppet(persona)
    metres = PICTURE_TO_TEMPLATE * EYE_DISTANCE
    vertices = (puppet.vertices(persona.neutral) @ metres).astype(np.float32)
    surface = puppet.surface
    head = (np.array([NECK]) @ metres).astype(np.float32)
    mesh = SkinnedMesh(
        Skeleton(("Head",), np.array([-1], np.int32), head),
        vertices,
        surface.triangles,
        surface.uv,
        np.zeros((len(vertices), 4), np.uint8),
        np.tile(np.array([1, 0, 0, 0], np.float32), (len(vertices), 1)),
        texture,
    )
    morphs = [
        morph_target(name, puppet.finer(moved) @ metres, LEAST)
        for name, moved in zip(units.names, units.moved, strict=True)
    ]
    write_glb(path, CharacterModel(mesh, unlit=False, morphs=morphs), name="puppet", synthetic=synthetic)
