"""The one door: a target's face and a tracked driver go in, drawn frames come out.

What this needs of the target is made by `stages.prepare_target`, of the driver by `stages.analyse_driver`. Everything that
a frame needs is prepared once. From the back: the background plate; the person as a layer with face, hair and neck,
warped; creases; lids and gaze; the inside of the mouth.
"""

from __future__ import annotations

import os
from collections import deque
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from engine.face_animation.acting_options import ActingOptions
from engine.face_animation.creases.corner_seams import CornerSeams
from engine.face_animation.creases.fine_details import shade
from engine.face_animation.creases.own_folds import OwnFolds
from engine.face_animation.eyes.eyes_and_lids import EyesAndLids
from engine.face_animation.face_rig import FaceRig
from engine.face_animation.motion_transfer.contour import rim_distance
from engine.face_animation.motion_transfer.control_motion import ControlMotion, carry_motion
from engine.face_animation.motion_transfer.head_proxy import build_head_proxy
from engine.face_animation.motion_transfer.landmark_residuals import LandmarkResiduals
from engine.face_animation.mouth.mouth_interior import MouthInterior
from engine.face_animation.mouth.seen_teeth import seen_teeth
from engine.face_animation.mouth.target_mouth import target_mouth
from engine.face_animation.target_face import TargetFace
from engine.face_animation.warping.face_before_head import FaceBeforeHead
from engine.face_animation.warping.layers import Layers, beyond_border
from engine.face_animation.warping.lip_edges import gives_way_around_lips
from engine.face_animation.warping.unfold import MIN_AREA_SHARE, MIN_LIP_AREA_SHARE, unfold
from engine.imaging.composite import composite_over, upsample_twice, warp_layer
from engine.imaging.warping.fold_edges import smooth_folds
from engine.imaging.window import Window
from engine.perception.face.landmarks import MESH_SIZE, eye_distance
from engine.perception.face_track.track import FaceTrack

FRAMES_AHEAD = 2
"""Frames in the making for each thread: keeps all cores busy, holds little memory."""

FREE_RIM_EYE_DISTANCES = 0.3
"""Eye distances inside the contour up to which the face gives way where the picture would fold."""
MIN_SHEET_GAP_PIXELS = 0.25
"""Pixels by which the sheet behind the face differs from what is before it, to be drawn."""
MIN_FOLD_DISTANCE_PIXELS = 8.0
"""Pixels of the enlarged picture by which neighbours are apart where lips or lids fold over the skin beside them."""


@dataclass(frozen=True)
class Parts:
    """Which parts of the method are on. `details` are the driver's creases, `own_folds` says that the picture's go as its face does not
    make them. Others are switched off for comparisons alone (see `benchmarks`)."""

    layers: bool = True
    hidden: bool = True
    details: bool = True
    own_folds: bool = True
    eyes: bool = True


ALL_PARTS = Parts()


@dataclass(frozen=True)
class RiggedTarget:
    """The picture with its face, cut into layers, and made ready to move."""

    face: TargetFace
    layers: Layers
    rig: FaceRig


@dataclass(frozen=True)
class RegisteredDriver:
    """A driver's track on the skin, and its frame that shows what the target shows."""

    track: FaceTrack
    neutral: int
    residuals: LandmarkResiduals | None = None
    """By how much the target's landmarks miss, which is corrected: see `tracking_refinement`."""


class FaceAnimation:
    """A target's face ready to act out a driver.

    Parameters
    ----------
    target, driver : who acts, and what is acted out.
    options : how the target follows the driver.
    parts : what of the face is animated.
    mouth : what is seen between the lips; by default the one that the target is given (`target_mouth`).
    keep_alpha : whether the frames of a cut-out target stay transparent.
    """

    def __init__(
        self,
        target: RiggedTarget,
        driver: RegisteredDriver,
        options: ActingOptions,
        parts: Parts = ALL_PARTS,
        mouth: MouthInterior | None = None,
        keep_alpha: bool = False,
    ):
        face, layers, track, neutral = target.face, target.layers, driver.track, driver.neutral
        self._target, self._rig, self._track, self._neutral = face, target.rig, track, neutral
        self._options, self._residuals = options, driver.residuals
        opaque = np.full(face.rgb.shape[:2], 255, np.uint8)
        whole, self._margin = beyond_border(
            layers.person if parts.layers else np.dstack([face.rgb, opaque]), layers.inner
        )
        self._person = upsample_twice(whole)
        self._plate, self._inner = layers.plate, layers.inner
        self._before = FaceBeforeHead(face.mesh, face.rgb.shape[:2])
        self._around_face = self._before.around(target.rig.mesh)
        self._keep_alpha = layers.transparent and keep_alpha
        self._eyes = EyesAndLids(face) if parts.eyes else None
        self._mouth = (mouth or target_mouth(face, seen_teeth(track))) if parts.hidden else None
        self._held = np.zeros(len(target.rig.mesh.vertices), bool)
        inside = np.flatnonzero(target.rig.control.usable[:MESH_SIZE])
        depth = -rim_distance(face.mesh, face.mesh[inside, :2]) / float(eye_distance(face.mesh[:, :2]))
        gives = gives_way_around_lips(face.mesh)[inside]
        self._held[: len(inside)] = (depth > FREE_RIM_EYE_DISTANCES) & ~gives
        around_lips = np.isin(target.rig.mesh.triangles, np.flatnonzero(gives)).any(axis=1)
        self._kept = np.where(around_lips, MIN_LIP_AREA_SHARE, MIN_AREA_SHARE)
        self._landing = target.rig.details.origin(track.in_crop(neutral))
        moves = set(options.follow) - {"head"}
        self._creases = min(options.strength, 1.0) if parts.details and moves else 0.0
        self._eased: list[OwnFolds | CornerSeams] = []
        if parts.own_folds and "mouth" in options.follow:
            folds = OwnFolds(face.rgb, face.mesh)
            self._eased = [folds, CornerSeams(face.rgb, face.mesh, folds)]

    def frames(self, ratios: Iterable[NDArray[np.float32]]) -> Iterator[NDArray[np.uint8]]:
        """The target acting out the whole driver: one (H, W, 3) uint8 frame for each of its frames, (H, W, 4) where alpha
        is kept.

        `ratios` are the driver's ratio images, one (*CROP,) float32 for each frame. Memory does not grow with the length.
        """
        return draw_in_order(self.draw, zip(self.motions(), ratios, strict=True))

    def motions(self) -> Iterator[ControlMotion]:
        """Where the control points go, frame by frame (section 4)."""
        return self.carry(self._track, self._neutral)

    def carry(self, track: FaceTrack, neutral: int) -> Iterator[ControlMotion]:
        """Where a track of the driver, or of some of its frames, carries the control points."""
        proxy = build_head_proxy(self._rig.control.points, self._target.mesh) if self._options.head_3d else None
        return carry_motion(track, neutral, self._target.mesh, self._rig.control, proxy, self._options, self._residuals)

    def face(self, motion: ControlMotion) -> NDArray[np.float32]:
        """(478, 2) where a motion puts the face's points, pixels."""
        return np.asarray(self._rig.control.points[:MESH_SIZE] + motion.offsets[:MESH_SIZE], np.float32)

    def moved(self, motion: ControlMotion) -> NDArray[np.float32]:
        """(V, 3) by how much a motion moves the vertices of the picture's mesh, pixels, and their depth."""
        mesh = self._rig.mesh
        moved = mesh.offsets(np.column_stack([motion.offsets, motion.depth]))
        unfold(moved, mesh.vertices, mesh.triangles, self._held, self._kept)
        return moved

    def draw(
        self, motion: ControlMotion, ratio: NDArray[np.float32], window: Window | None = None
    ) -> NDArray[np.uint8]:
        """One frame, or a `window` of it that holds the face; `ratio` (*CROP,) float32 is the driver's ratio image there."""
        window = window or Window(0, 0, *self._plate.shape[1::-1])
        corner = np.array([window.left, window.top], np.float32)
        moved = self.moved(motion)
        moved[:, :2] -= corner
        origin = self._rig.mesh.inverse_map(moved[:, :2], moved[:, 2], 2, window.shape)
        layer = warp_layer(self._person, origin + np.float32(2 * self._margin))
        self._put_before_head(layer, origin, moved[:, :2], self._rig.mesh.offsets(motion.behind))
        frame = composite_over(layer, np.ascontiguousarray(self._plate[window.pixels]))
        smooth_folds(
            frame, origin, MIN_FOLD_DISTANCE_PIXELS, self._rig.mesh.vertices + moved[:, :2], self._rig.mesh.triangles
        )
        face = self.face(motion) - corner
        for own in self._eased:
            own.ease(frame, origin, 2, face)
        if self._creases > 0:
            shade(frame, self._rig.details, self._landing, ratio, origin, 2, face, self._creases)
        if self._eyes is not None:
            self._eyes.draw(frame, face, motion.look)
        if self._mouth is not None:
            self._mouth.draw(frame, face, motion.frame)
        if self._inner is not None:
            self._put_frame_before(frame, window, self._inner)
        return np.dstack([frame, layer[..., 3]]) if self._keep_alpha else frame

    def _put_before_head(
        self,
        layer: NDArray[np.uint8],
        origin: NDArray[np.float32],
        moved: NDArray[np.float32],
        apart: NDArray[np.float32],
    ) -> None:
        """Put the face before what it hides of its head, in a `layer` (h, w, 4) with its inverse map `origin`.
        `offsets` (V, 2) are those of the picture's mesh, and `apart` (V, 2) how far from them the sheet behind is."""
        mesh = self._rig.mesh
        shown = (np.abs(apart).max(axis=1) > MIN_SHEET_GAP_PIXELS)[self._around_face].any(axis=1)
        sheet = replace(mesh, triangles=self._around_face[shown])
        places = (mesh.vertices + moved)[sheet.triangles].reshape(-1, 2)
        places = np.concatenate([places, places + apart[sheet.triangles].reshape(-1, 2)])
        if not len(places):
            return
        low, high = (np.clip(end, 0, origin.shape[1::-1]) for end in (places.min(axis=0), places.max(axis=0)))
        part = Window(*np.floor(low).astype(int).tolist(), *np.ceil(high).astype(int).tolist())
        if min(part.shape) < 2:
            return
        corner = np.array([part.left, part.top], np.float32)
        behind = sheet.inverse_map(moved + apart - corner, None, 2, part.shape)
        self._before.draw(layer[part.pixels], self._person, self._margin, origin[part.pixels], behind)

    def _put_frame_before(self, frame: NDArray[np.uint8], window: Window, inner: Window) -> None:
        """Whatever moved out of the inner picture is behind what frames it, in a `frame` (h, w, 3) that is a window of the result."""
        still = self._target.rgb[window.pixels]
        left, top = max(inner.left - window.left, 0), max(inner.top - window.top, 0)
        right, bottom = max(inner.right - window.left, 0), max(inner.bottom - window.top, 0)
        for side in (np.s_[:top], np.s_[bottom:], np.s_[:, :left], np.s_[:, right:]):
            frame[side] = still[side]


def draw_in_order(
    draw: Callable[..., NDArray[np.uint8]], poses: Iterable[tuple[object, ...]]
) -> Iterator[NDArray[np.uint8]]:
    """A frame for each pose, drawn side by side on all cores: what `draw` makes of the pose's parts, such as
    `FaceAnimation.draw` of motion and ratio image."""
    threads = os.cpu_count() or 1
    waiting: deque[Future[NDArray[np.uint8]]] = deque()
    with ThreadPoolExecutor(threads, thread_name_prefix="render") as pool:
        for pose in poses:
            waiting.append(pool.submit(draw, *pose))
            if len(waiting) > FRAMES_AHEAD * threads:
                yield waiting.popleft().result()
        while waiting:
            yield waiting.popleft().result()
