"""The frames of the animation, one by one: everything that a frame needs is prepared once."""

from __future__ import annotations

import os
from collections import deque
from collections.abc import Iterable, Iterator
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from engine.face_animation.acting_options import ActingOptions
from engine.face_animation.driver import DriverTrack
from engine.face_animation.eyes import closing, draw_eye, prepare_eyes
from engine.face_animation.fine_details import shade
from engine.face_animation.head_proxy import build_head_proxy
from engine.face_animation.hidden_regions import match_palette, transfer_mouth, uncovered
from engine.face_animation.layers import Layers
from engine.face_animation.lid_skin import draw_lid, lid_skins
from engine.face_animation.misfit import Misfit
from engine.face_animation.motion import ControlMotion, carry_motion
from engine.face_animation.rig import Rig
from engine.face_animation.target_face import TargetFace
from engine.face_animation.teeth import draw_teeth, shown_teeth
from engine.imaging.composite import doubled, over, warp_layer
from engine.imaging.fold_edges import smooth_folds
from engine.perception.landmarks import MESH_SIZE

AHEAD = 2
"""Frames in the making for each thread: keeps all cores busy, holds little memory."""

FOLD = 8.0
"""Pixels of the enlarged picture by which neighbours are apart where lips or lids fold over the skin beside them."""


@dataclass(frozen=True)
class Parts:
    """Which parts of the method are on; switched off for comparisons alone (see `benchmarks`)."""

    layers: bool = True
    hidden: bool = True
    details: bool = True
    eyes: bool = True


ALL_PARTS = Parts()


class Window(NamedTuple):
    """A part of the frame, in pixels; `right` and `bottom` are the first beyond it."""

    left: int
    top: int
    right: int
    bottom: int

    @property
    def shape(self) -> tuple[int, int]:
        return self.bottom - self.top, self.right - self.left

    @property
    def pixels(self) -> tuple[slice, slice]:
        return slice(self.top, self.bottom), slice(self.left, self.right)


class Renderer:
    """A target ready to act out a driver: what all frames share."""

    def __init__(
        self,
        track: DriverTrack,
        neutral: int,
        target: TargetFace,
        layers: Layers,
        rig: Rig,
        options: ActingOptions,
        misfit: Misfit | None = None,
        parts: Parts = ALL_PARTS,
        keep_alpha: bool = False,
    ):
        self._track, self._neutral, self._target, self._rig, self._misfit = track, neutral, target, rig, misfit
        self._options, self._parts = options, parts
        opaque = np.full(target.rgb.shape[:2], 255, np.uint8)
        self._person = doubled(layers.person if parts.layers else np.dstack([target.rgb, opaque]))
        self._plate = layers.plate
        self._keep_alpha = layers.transparent and keep_alpha
        self._eyes = prepare_eyes(target.rgb, target.mesh) if parts.eyes else (None, None)
        self._lids = lid_skins(target.rgb, target.mesh) if parts.eyes else []
        self._teeth = shown_teeth(target.rgb, target.mesh) if parts.hidden else None
        self._palette = match_palette(target.rgb, target.mesh, track.crop(neutral), track.in_crop(neutral))
        self._landing = rig.details.origin(track.in_crop(neutral))
        moves = set(options.follow) - {"head"}
        self._creases = min(options.strength, 1.0) if parts.details and moves else 0.0

    def motions(self) -> Iterator[ControlMotion]:
        """Where the control points go, frame by frame (section 4)."""
        return self.carry(self._track, self._neutral)

    def carry(self, track: DriverTrack, neutral: int) -> Iterator[ControlMotion]:
        """Where a track of the driver, or of some of its frames, carries the control points."""
        proxy = build_head_proxy(self._rig.control.points, self._target.mesh) if self._options.head_3d else None
        return carry_motion(track, neutral, self._target.mesh, self._rig.control, proxy, self._options, self._misfit)

    def face(self, motion: ControlMotion) -> NDArray[np.float32]:
        """(478, 2) where a motion puts the face's points, pixels."""
        return np.asarray(self._rig.control.points[:MESH_SIZE] + motion.offsets[:MESH_SIZE], np.float32)

    def draw(
        self, motion: ControlMotion, ratio: NDArray[np.float32], window: Window | None = None
    ) -> NDArray[np.uint8]:
        """One frame, or a `window` of it that holds the face: the warp, the plate behind, the creases, the eyes, the mouth's inside."""
        window = window or Window(0, 0, *self._plate.shape[1::-1])
        corner = np.array([window.left, window.top], np.float32)
        moved = self._rig.mesh.offsets(np.column_stack([motion.offsets, motion.depth]))
        moved[:, :2] -= corner
        origin = self._rig.mesh.inverse_map(moved[:, :2], moved[:, 2], 2, window.shape)
        layer = warp_layer(self._person, origin)
        frame = over(layer, np.ascontiguousarray(self._plate[window.pixels]))
        smooth_folds(frame, origin, FOLD, self._rig.mesh.vertices + moved[:, :2], self._rig.mesh.triangles)
        face = self.face(motion) - corner
        if self._creases > 0:
            shade(frame, self._rig.details, self._landing, ratio, origin, 2, face, self._creases)
        for side, eye in enumerate(self._eyes):
            if eye is not None:
                draw_lid(frame, self._lids[side], face, side, closing(eye, face, side))
                draw_eye(frame, eye, face, side, motion.look[side])
        inside = uncovered(face, self._palette)
        if self._teeth is not None:
            draw_teeth(frame, self._teeth, face, 1 - inside)
        if self._parts.hidden and inside > 0:
            transfer_mouth(
                frame, face, self._track.crop(motion.frame), self._track.in_crop(motion.frame), self._palette
            )
        return np.dstack([frame, layer[..., 3]]) if self._keep_alpha else frame


def render(
    track: DriverTrack,
    neutral: int,
    ratios: Iterable[NDArray[np.float32]],
    target: TargetFace,
    layers: Layers,
    rig: Rig,
    options: ActingOptions,
    misfit: Misfit | None = None,
    keep_alpha: bool = False,
) -> Iterator[NDArray[np.uint8]]:
    """The target acting out the driver: one (H, W, 3) uint8 frame for each frame of the driver.

    `ratios` are the driver's ratio images, one (*CROP,) float32 for each frame; `misfit` corrects what a second look
    found amiss. A cut-out target gives (H, W, 4) where its alpha is to be kept. Frames are drawn side by side on all cores and
    given in order; memory does not grow with the length.
    """
    renderer = Renderer(track, neutral, target, layers, rig, options, misfit, keep_alpha=keep_alpha)
    yield from draw_in_order(renderer, zip(renderer.motions(), ratios, strict=True))


def draw_in_order(
    renderer: Renderer, poses: Iterable[tuple[ControlMotion, NDArray[np.float32]]]
) -> Iterator[NDArray[np.uint8]]:
    """A frame for each pose, drawn side by side on all cores: what `Renderer.draw` makes of motion and ratio image."""
    threads = os.cpu_count() or 1
    waiting: deque[Future[NDArray[np.uint8]]] = deque()
    with ThreadPoolExecutor(threads, thread_name_prefix="render") as pool:
        for motion, ratio in poses:
            waiting.append(pool.submit(renderer.draw, motion, ratio))
            if len(waiting) > AHEAD * threads:
                yield waiting.popleft().result()
        while waiting:
            yield waiting.popleft().result()
