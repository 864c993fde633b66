"""The frames of the animation, one by one: everything that a frame needs is prepared once."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from engine.imaging.composite import over, warp_layer
from engine.perception.landmarks import MESH_SIZE
from engine.portrait.control_points import place_control_points
from engine.portrait.dense_field import build_warp_mesh
from engine.portrait.driver import DriverTrack
from engine.portrait.eyes import draw_eye, prepare_eyes
from engine.portrait.fine_details import RatioImages, build_detail_map, shade
from engine.portrait.head_proxy import build_head_proxy
from engine.portrait.hidden_regions import match_palette, transfer_mouth
from engine.portrait.motion import carry_motion
from engine.portrait.options import PortraitOptions
from engine.portrait.target import Layers, TargetFace


@dataclass(frozen=True)
class Parts:
    """Which parts of the method are on; switched off for comparisons alone (see `benchmarks`)."""

    smoothing: str = "confidence"
    layers: bool = True
    hidden: bool = True
    details: bool = True
    refined: bool = True
    eyes: bool = True


def render(
    track: DriverTrack,
    neutral: int,
    target: TargetFace,
    layers: Layers,
    options: PortraitOptions,
    parts: Parts = Parts(),
) -> Iterator[NDArray[np.uint8]]:
    """The target acting out the driver: one (H, W, 3) uint8 frame for each frame of the driver."""
    control = place_control_points(target.mesh, layers.person[..., 3] / np.float32(255))
    mesh = build_warp_mesh(control.points, target.mesh, target.rgb.shape[:2], parts.smoothing, control.usable)
    proxy = build_head_proxy(control.points, target.mesh) if options.head_3d else None
    person = layers.person if parts.layers else np.dstack([target.rgb, np.full(target.rgb.shape[:2], 255, np.uint8)])
    eyes = prepare_eyes(target.rgb, target.mesh) if parts.eyes else (None, None)
    palette = match_palette(target.rgb, target.mesh, track.crop(neutral), track.in_crop(neutral))
    details = build_detail_map(target.rgb, target.mesh, track.in_crop(neutral))
    ratios = iter(RatioImages(track, neutral, parts.refined, parts.refined)) if parts.details else None
    for motion in carry_motion(track, neutral, target.mesh, control, proxy, options):
        shaded = person
        if ratios is not None:
            shaded = person.copy()
            shade(shaded, details, next(ratios))
        origin = mesh.inverse_map(mesh.offsets(motion.offsets), mesh.operator @ motion.depth)
        frame = over(warp_layer(shaded, origin), layers.plate)
        face = (control.points[:MESH_SIZE] + motion.offsets[:MESH_SIZE]).astype(np.float32)
        for side, eye in enumerate(eyes):
            if eye is not None:
                draw_eye(frame, eye, face, side, motion.look[side])
        if parts.hidden:
            transfer_mouth(frame, face, track.crop(motion.frame), track.in_crop(motion.frame), palette)
        yield frame
