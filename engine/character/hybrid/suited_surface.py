"""Which surface suits a pose: both together, but where an arm is pictured raised.

Two surfaces keep apart what a relief melts into a sail, legs that pass above all, and leave no scraps as arms move. An arm that is pictured above its
shoulder is far from the template's rest: brought down, its shoulder is puffed, where the relief's is not.
"""

from __future__ import annotations

from typing import Literal

import numpy as np

from engine.character.figure.silhouette import Silhouette
from engine.character.fit.rest_skeleton import pictured_joints
from engine.character.fit.template_fit import FittedBody, load_human, pose_template
from engine.character.parts.label_map import Labels
from engine.character.parts.labels import LEG_LABELS
from engine.character.shell.template_mesh import template_mesh
from engine.render.rasterisation.rasteriser import rasterise

MIN_LEG_OVERLAP_SHARE, MIN_FOOT_DEPTH_SHARE = 0.05, 0.2
"""Share of a leg that is before or behind the other, and how far one foot is behind the other as a share of the person's height, from which on
a relief of the legs would be one sail."""


MAX_ARM_ELEVATION_SINE = 0.1
"""Sine of an upper arm's angle above level up to which it is not raised."""


def suited_surface(silhouette: Silhouette, fitted: FittedBody, labels: Labels) -> Literal["hybrid", "relief"]:
    """What a person in their pose is best made of."""
    return "relief" if arm_raised(fitted) and not legs_pass(silhouette, fitted, labels) else "hybrid"


def arm_raised(fitted: FittedBody) -> bool:
    """Whether an upper arm is pictured above level."""
    joints = pictured_joints(fitted, load_human().space)
    heads, transforms = joints.rest.heads, joints.transforms()
    at = np.einsum("jab,jb->ja", transforms[:, :3, :3], heads) + transforms[:, :3, 3]
    upper = [
        at[joints.rest.index(f"{side}ForeArm")] - at[joints.rest.index(f"{side}Arm")] for side in ("Left", "Right")
    ]
    return bool(max(arm[1] / np.linalg.norm(arm) for arm in upper) > MAX_ARM_ELEVATION_SINE)


def legs_pass(silhouette: Silhouette, fitted: FittedBody, labels: Labels) -> bool:
    """Whether one leg of the fitted template is before the other, and no cloth hangs around both."""
    if labels.cloth is not None and labels.cloth.hangs:
        return False
    mesh = template_mesh()
    camera = silhouette.camera(fitted.picture_camera())
    template = pose_template(fitted, camera, load_human()).vertices[mesh.ids]
    covered, depths = [], []
    for leg in LEG_LABELS:
        own = mesh.parts[:, leg] > 0.5
        triangles = mesh.triangles[own[mesh.triangles].all(1)]
        covered.append(rasterise(template * [1, 1, -1], triangles, silhouette.mask.shape).triangle >= 0)
        depths.append(template[own & (mesh.foot > 0.5), 2].mean())
    least = max(min(int(one.sum()) for one in covered), 1)
    apart = abs(depths[0] - depths[1]) / np.ptp(template[:, 1])
    return bool((covered[0] & covered[1]).sum() > MIN_LEG_OVERLAP_SHARE * least or apart > MIN_FOOT_DEPTH_SHARE)
