"""A picture of the project's own that shows somebody whole: the template, drawn before a wall."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from engine.character.fit.template_fit import load_human
from engine.geometry.camera import Camera
from engine.geometry.mesh.surface import vertex_normals
from engine.geometry.rigging.skinning import bone_transforms, skin
from engine.render.rasterisation.attributes import interpolate
from engine.render.rasterisation.rasteriser import rasterise

SKIN_COLOUR, SHIRT_COLOUR, TROUSERS_COLOUR, SHOES_COLOUR = (224, 172, 140), (70, 110, 170), (60, 58, 66), (120, 60, 40)
WALL_COLOUR, FLOOR_COLOUR = (128, 138, 148), (92, 84, 78)
LOWERED_ARMS_RADIANS = 1.05
"""Radians by which the arms are lowered."""


def sample_picture(height: int = 600) -> NDArray[np.uint8]:
    """(height, 3/4 height, 3) uint8: an average person from the front, arms a little away from the body."""
    human = load_human()
    nobody = np.zeros(1, np.float32)
    rest, heads = human.space.vertices(nobody), human.space.joints(nobody)
    turns = np.broadcast_to(np.eye(3), (len(human.rig.names), 3, 3)).copy()
    for side, sign in (("Left", -1), ("Right", 1)):
        turns[human.rig.index(f"{side}Arm")] = Rotation.from_euler("z", sign * LOWERED_ARMS_RADIANS).as_matrix()
    body = skin(rest, human.rig.bones, human.rig.weights, bone_transforms(human.rig.parents, heads, turns))
    size = (height, 3 * height // 4)
    camera = Camera((0.0, 0.95, 4.4), 1.6 * height, ((size[1] - 1) / 2, (height - 1) / 2), size)
    raster = rasterise(camera.project(body), human.triangles, size, perspective=True)
    light = np.array([0.3, 0.45, 0.84])
    shade = interpolate(
        np.clip(vertex_normals(body, human.triangles) @ light, 0.2, 1)[:, None], human.triangles, raster
    )
    ground = np.arange(height)[:, None, None] > 0.9 * height
    colours = np.array([_colour(name) for name in human.rig.names], np.float32)[human.rig.bones[:, 0]]
    worn = interpolate(colours, human.triangles, raster)
    behind = np.where(ground, np.array(FLOOR_COLOUR), np.array(WALL_COLOUR)) * np.ones((1, size[1], 1))
    seen = (raster.triangle >= 0)[..., None]
    return np.where(seen, shade * worn, behind).astype(np.uint8)


def _colour(joint: str) -> tuple[int, int, int]:
    """What somebody wears where a joint moves them."""
    part = joint.removeprefix("Left").removeprefix("Right")
    if part.startswith(("Foot", "Toe")):
        return SHOES_COLOUR
    if part.startswith(("Hips", "UpLeg", "Leg")):
        return TROUSERS_COLOUR
    return SKIN_COLOUR if part.startswith(("Hand", "Neck", "Head")) else SHIRT_COLOUR
