"""A target made ready to move: what all its animations share, whoever drives them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from engine.face_animation.creases.fine_details import DetailRegion, detail_region
from engine.face_animation.motion_transfer.control_points import ControlPoints, place_control_points
from engine.face_animation.target_face import TargetFace
from engine.face_animation.warping.dense_field import build_warp_mesh
from engine.face_animation.warping.layers import Layers
from engine.face_animation.warping.warp_mesh import WarpMesh


@dataclass(frozen=True)
class FaceRig:
    """`control` points at rest, the `mesh` that follows them, and the region that `details` go to."""

    control: ControlPoints
    mesh: WarpMesh
    details: DetailRegion


def rig_target(
    target: TargetFace, layers: Layers, details: DetailRegion | None = None, smoothing: str = "confidence"
) -> FaceRig:
    """Section 4 as far as it does not depend on the driver; `smoothing` as `build_warp_mesh` takes it, `details` the region
    if it is known already."""
    person = layers.person[..., 3] / np.float32(255)
    control = place_control_points(target.mesh, person, layers.inner, target.rgb)
    mesh = build_warp_mesh(control.points, target.mesh, target.rgb.shape[:2], smoothing, control.usable)
    return FaceRig(control, mesh, details or detail_region(target.rgb, target.mesh))
