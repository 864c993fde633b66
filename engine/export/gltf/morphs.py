"""Morph targets of a glTF mesh. Specification: Khronos, glTF 2.0, 3.7.2.2 (morph targets), 3.6.2.3 (sparse accessors)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import pygltflib as gl

from engine.export.gltf.buffer import Buffer
from engine.geometry.mesh.welding import seamless_normals, weld
from engine.geometry.rigging.morph_target import MorphTarget
from engine.geometry.rigging.skinned_mesh import SkinnedMesh

NORMAL_TOLERANCE = 1e-4
"""A change of a unit normal that nobody sees."""


def add_morphs(buffer: Buffer, mesh: SkinnedMesh, morphs: Sequence[MorphTarget], shaded: bool) -> list[gl.Attributes]:
    """The targets of a primitive of this mesh, in their order. Where it is `shaded` they change its normals, too.

    Raises ValueError where two have one name, or one moves what is not there, a vertex twice, or to no finite place.
    """
    if len({morph.name for morph in morphs}) < len(morphs):
        raise ValueError("two morph targets have the same name")
    count = len(mesh.vertices)
    points = weld(mesh) if shaded and morphs else None  # as at rest: targets part no seams
    rest = seamless_normals(mesh) if shaded and morphs else None
    targets = []
    for morph in morphs:
        moved, offsets = np.asarray(morph.moved), np.asarray(morph.offsets, np.float32)
        if offsets.shape != (len(moved), 3) or not np.isfinite(offsets).all():
            raise ValueError(
                f"the morph target {morph.name} has other displacements than vertices, or none that are finite"
            )
        if len(moved) and not (moved[0] >= 0 and moved[-1] < count and (np.diff(moved) > 0).all()):
            raise ValueError(f"the morph target {morph.name} moves a vertex twice, or one that is not there")
        attributes = gl.Attributes(POSITION=buffer.add_displacements(moved, offsets, count, bounds=True))
        if rest is not None:
            shape = replace(mesh, vertices=(mesh.vertices + morph.dense(count)).astype(np.float32))
            change = seamless_normals(shape, points) - rest
            turned = np.flatnonzero(np.abs(change).max(1) > NORMAL_TOLERANCE)
            attributes.NORMAL = buffer.add_displacements(turned, change[turned], count)
        targets.append(attributes)
    return targets
