"""A character's mesh with fewer triangles, for files that are to be small and for levels of detail."""

from __future__ import annotations

from dataclasses import replace

from engine.character.rig.measures import pose
from engine.character.rig.rigging import Character
from engine.geometry.rigging.skinned_mesh import SkinnedMesh
from engine.geometry.simplification.decimation import decimate, joint_importance

HEAD_TRIANGLE_WEIGHT = 6.0
"""How much more a triangle of the head counts where triangles are saved."""


def fewer_triangles(character: Character, triangles: int) -> SkinnedMesh:
    """Its mesh with so many triangles at most: silhouette and face are kept longest. What that changes is measured as it is
    pictured, since in T-pose creases are drawn out."""
    mesh = character.mesh
    if len(mesh.triangles) <= triangles:
        return mesh
    pictured = replace(mesh, vertices=pose(character, character.pictured))
    fewer, kept = decimate(pictured, triangles, joint_importance(mesh, {"Head": HEAD_TRIANGLE_WEIGHT}))
    return replace(fewer, vertices=mesh.vertices[kept])
