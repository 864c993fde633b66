"""The frames of the animation, one by one: everything that a frame needs is prepared once."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from engine.imaging.composite import over, warp_layer
from engine.portrait.control_points import place_control_points
from engine.portrait.dense_field import build_warp_mesh
from engine.portrait.driver import DriverTrack
from engine.portrait.head_proxy import build_head_proxy
from engine.portrait.motion import carry_motion
from engine.portrait.options import PortraitOptions
from engine.portrait.target import Layers, TargetFace


def render(
    track: DriverTrack, neutral: int, target: TargetFace, layers: Layers, options: PortraitOptions
) -> Iterator[NDArray[np.uint8]]:
    """The target acting out the driver: one (H, W, 3) uint8 frame for each frame of the driver."""
    control = place_control_points(target.mesh, layers.person[..., 3] / np.float32(255))
    mesh = build_warp_mesh(control.points, target.mesh, target.rgb.shape[:2])
    proxy = build_head_proxy(control.points, target.mesh) if options.head_3d else None
    for motion in carry_motion(track, neutral, target.mesh, control, proxy, options):
        origin = mesh.inverse_map(mesh.offsets(motion.offsets), mesh.operator @ motion.depth)
        yield over(warp_layer(layers.person, origin), layers.plate)
