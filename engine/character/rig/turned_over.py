"""No triangle shows its back in the picture's view: where a surface is folded over, it is drawn smooth."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from engine.character.rig.measures import pose, projected_areas
from engine.character.rig.rigging import Character, at_rest
from engine.geometry.camera import Camera
from engine.geometry.mesh.adjacency import neighbours
from engine.geometry.mesh.welding import weld
from engine.motion.kinematics import pose_transforms
from engine.render.rasterisation.rasteriser import rasterise

MAX_TURNED_SMOOTHING_ROUNDS = 6
"""How often points are drawn to their neighbours at most; a round that shows more backs than the one before is not taken."""


def without_backs_in_view(character: Character, camera: Camera) -> Character:
    """The character with those points drawn to the mean of their neighbours whose triangles show their back to `camera`, as
    pictured. At the sharp corners of a border, and between fingers, a pixel or two is folded over."""
    mesh = character.mesh
    point = weld(mesh)
    first = np.unique(point, return_index=True)[1]
    beside = neighbours(point[mesh.triangles], len(first))
    pictured = pose_transforms(mesh.skeleton, character.pictured.rotations, character.pictured.root)[0]
    best, fewest = character, backs_in_view(character, camera)
    for _ in range(MAX_TURNED_SMOOTHING_ROUNDS):
        if not len(fewest):
            break
        posed = pose(best, best.pictured)
        moved = np.unique(point[mesh.triangles[fewest]])
        where = posed[first].astype(np.float64)
        drawn = (beside[moved] @ where) / beside[moved].sum(1)[:, None]
        some = np.isin(point, moved)
        goal = drawn[np.searchsorted(moved, point[some])]
        vertices, weights = best.mesh.vertices.copy(), best.mesh.weights.copy()
        vertices[some], weights[some], _ = at_rest(goal, mesh.bones[some].astype(np.intp), weights[some], pictured)
        tried = replace(best, mesh=replace(best.mesh, vertices=vertices, weights=weights))
        left = backs_in_view(tried, camera)
        if len(left) > len(fewest):
            break
        best, fewest = tried, left
    return best


def backs_in_view(character: Character, camera: Camera) -> NDArray[np.intp]:
    """The triangles in view that show their back, by index, once for each pixel."""
    triangles = character.mesh.triangles
    projected = camera.project(pose(character, character.pictured))
    seen = rasterise(projected, triangles, camera.size, perspective=True).triangle
    seen = seen[seen >= 0]
    return np.asarray(seen[projected_areas(projected, triangles)[seen] < 0], np.intp)
