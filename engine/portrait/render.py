"""The frames of the animation, one by one: everything that a frame needs is prepared once."""

from __future__ import annotations

import os
from collections import deque
from collections.abc import Iterator
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from engine.imaging.composite import doubled, over, warp_layer
from engine.perception.landmarks import MESH_SIZE
from engine.portrait.control_points import place_control_points
from engine.portrait.dense_field import build_warp_mesh
from engine.portrait.driver import CropReader, DriverTrack
from engine.portrait.eyes import draw_eye, prepare_eyes
from engine.portrait.fine_details import RatioImages, build_detail_map, shade
from engine.portrait.head_proxy import build_head_proxy
from engine.portrait.hidden_regions import match_palette, transfer_mouth
from engine.portrait.motion import ControlMotion, carry_motion
from engine.portrait.options import PortraitOptions
from engine.portrait.target import Layers, TargetFace

AHEAD = 2
"""Frames in the making for each thread: keeps all cores busy, holds little memory."""


@dataclass(frozen=True)
class Parts:
    """Which parts of the method are on; switched off for comparisons alone (see `benchmarks`)."""

    smoothing: str = "confidence"
    layers: bool = True
    hidden: bool = True
    details: bool = True
    refined: bool = True
    eyes: bool = True


ALL_PARTS = Parts()


class Renderer:
    """A target ready to act out a driver: what all frames share."""

    def __init__(
        self,
        track: DriverTrack,
        neutral: int,
        target: TargetFace,
        layers: Layers,
        options: PortraitOptions,
        parts: Parts = ALL_PARTS,
    ):
        self.crops = CropReader(track)
        self._track, self._neutral, self._target, self._options, self._parts = track, neutral, target, options, parts
        opaque = np.full(target.rgb.shape[:2], 255, np.uint8)
        self._person = doubled(layers.person if parts.layers else np.dstack([target.rgb, opaque]))
        self._plate = layers.plate
        self._keep_alpha = layers.transparent and options.format != "mp4"
        self._control = place_control_points(target.mesh, layers.person[..., 3] / np.float32(255))
        self._mesh = build_warp_mesh(
            self._control.points, target.mesh, target.rgb.shape[:2], parts.smoothing, self._control.usable
        )
        self._eyes = prepare_eyes(target.rgb, target.mesh) if parts.eyes else (None, None)
        self._palette = match_palette(target.rgb, target.mesh, self.crops(neutral), track.in_crop(neutral))
        self._details = build_detail_map(target.rgb, target.mesh, track.in_crop(neutral))

    def motions(self) -> Iterator[ControlMotion]:
        """Where the control points go, frame by frame (section 4)."""
        proxy = build_head_proxy(self._control.points, self._target.mesh) if self._options.head_3d else None
        return carry_motion(self._track, self._neutral, self._target.mesh, self._control, proxy, self._options)

    def ratios(self) -> Iterator[NDArray[np.float32] | None]:
        """The refined ratio images, frame by frame (section 6); None where they are switched off."""
        strength = min(self._options.strength, 1.0) if set(self._options.follow) - {"head"} else 0.0
        if not self._parts.details or strength == 0:
            yield from [None] * len(self._track)
            return
        for ratio in RatioImages(self._track, self._neutral, self.crops, self._parts.refined, self._parts.refined):
            yield 1 + np.float32(strength) * (ratio - 1)

    def draw(
        self, motion: ControlMotion, ratio: NDArray[np.float32] | None, crop: NDArray[np.uint8]
    ) -> NDArray[np.uint8]:
        """One frame: the warp, the plate behind, the creases, the eyes, the mouth's inside."""
        moved = self._mesh.offsets(np.column_stack([motion.offsets, motion.depth]))
        origin = self._mesh.inverse_map(moved[:, :2], moved[:, 2], scale=2)
        layer = warp_layer(self._person, origin)
        frame = over(layer, self._plate)
        if ratio is not None:
            shade(frame, self._details, ratio, origin, scale=2)
        face = (self._control.points[:MESH_SIZE] + motion.offsets[:MESH_SIZE]).astype(np.float32)
        for side, eye in enumerate(self._eyes):
            if eye is not None:
                draw_eye(frame, eye, face, side, motion.look[side])
        if self._parts.hidden:
            transfer_mouth(frame, face, crop, self._track.in_crop(motion.frame), self._palette)
        return np.dstack([frame, layer[..., 3]]) if self._keep_alpha else frame


def render(
    track: DriverTrack,
    neutral: int,
    target: TargetFace,
    layers: Layers,
    options: PortraitOptions,
    parts: Parts = ALL_PARTS,
) -> Iterator[NDArray[np.uint8]]:
    """The target acting out the driver: one (H, W, 3) uint8 frame for each frame of the driver.

    A cut-out target gives (H, W, 4) where the format can hold its alpha. Frames are drawn side by side on all cores and given in order; memory does not grow with the length.
    """
    renderer = Renderer(track, neutral, target, layers, options, parts)
    threads = os.cpu_count() or 1
    waiting: deque[Future[NDArray[np.uint8]]] = deque()
    with ThreadPoolExecutor(threads, thread_name_prefix="render") as pool:
        for motion, ratio in zip(renderer.motions(), renderer.ratios(), strict=True):
            waiting.append(pool.submit(renderer.draw, motion, ratio, renderer.crops(motion.frame)))
            if len(waiting) > AHEAD * threads:
                yield waiting.popleft().result()
        while waiting:
            yield waiting.popleft().result()
