"""A portrait that follows a camera: a frame in, the portrait doing the same out.

`watch` and `draw` may run at the same time on two threads, for different frames: the next frame is looked at while this one
is drawn.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path
from types import TracebackType
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from engine.face_animation.animation import FaceAnimation, Parts, RegisteredDriver, RiggedTarget
from engine.face_animation.motion_transfer.control_motion import ControlMotion, DriverFrames, MotionTransfer
from engine.face_animation.motion_transfer.head_proxy import build_head_proxy
from engine.face_animation.mouth.target_mouth import target_mouth
from engine.face_animation.stages import prepare_target
from engine.media.film_strip import FilmStrip
from engine.perception.face_track.face_crop import CROP_SHAPE, FaceCrop
from engine.perception.face_track.track import FaceTrack
from engine.portrait.live.camera_face import CameraFace
from engine.portrait.live.kept_in_frame import kept_in_frame, reach_in_frame
from engine.portrait.live.options import LiveOptions
from engine.portrait.live.rest import Obstacle, RestCalibration
from engine.portrait.target import find_target_face
from engine.run import Run

LIVE_PARTS = Parts(details=False)
State = Literal["no_face", "calibrating", "live"]


def prepare_live(image: Path, options: LiveOptions, run: Run) -> RiggedTarget:
    """The target of a live portrait, cut into layers and rigged, as of a portrait job.

    Raises `InputError` as `find_target_face` does.
    """
    face = find_target_face(image, options.portrait().framing(), run.limits, run.warn)
    prepared = prepare_target(face, run)
    return RiggedTarget(face, prepared.layers(), prepared.rig())


@dataclass(frozen=True)
class _Play:
    """What follows one `rest` (478, 3): where it carries the control points, and what draws them."""

    rest: NDArray[np.float32]
    transfer: MotionTransfer
    animation: FaceAnimation


@dataclass(frozen=True)
class Watched:
    """What a frame of the camera showed.

    state : whether there is a face, and a rest to hold it against; `no_face` once it is live means that it holds still.
    fraction : of the calibration, in [0, 1].
    obstacle : why it does not get on.
    motion : where the control points go, and `play`, what draws them; None before the portrait is live.
    """

    state: State
    fraction: float = 0.0
    obstacle: Obstacle | None = None
    motion: ControlMotion | None = None
    play: _Play | None = None


class LivePortrait:
    """A target that follows a camera. Use as a context manager."""

    def __init__(self, target: RiggedTarget, options: LiveOptions):
        self._target, self._options = target, options.portrait().acting()
        points, mesh = target.rig.control.points, target.face.mesh
        self._proxy = build_head_proxy(points, mesh) if options.head_3d else None
        self._mouth = target_mouth(target.face)
        self._reach = reach_in_frame(target.face)
        self._plain = np.ones(CROP_SHAPE, np.float32)
        self._frame = 0
        self._camera = CameraFace()
        self._calibration: RestCalibration | None = RestCalibration()
        self._playing: _Play | None = None

    def __enter__(self) -> LivePortrait:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._camera.__exit__(kind, error, trace)

    def recalibrate(self) -> None:
        """Look for the rest anew; until it is found the portrait is still."""
        self._camera.__exit__(None, None, None)
        self._camera, self._calibration, self._playing = CameraFace(), RestCalibration(), None

    def watch(self, rgb: NDArray[np.uint8], time: float) -> Watched:
        """Take in the camera's next frame (H, W, 3), shown at a `time`, seconds."""
        look = self._camera(rgb, time)
        if look is None:
            return Watched("no_face")
        if self._calibration is not None:
            if not self._camera.visible:
                return Watched("no_face")
            found = self._calibration(look, time)
            if found.rest is None:
                return Watched("calibrating", found.fraction, found.obstacle)
            self._begin(found.rest)
        assert self._playing is not None
        play = self._playing
        self._frame += 1
        kept = replace(look, mesh=kept_in_frame(look.mesh, play.rest, self._reach))
        (offsets,), (depth,), (gaze,), (behind,) = play.transfer(_frames_of(kept))
        motion = ControlMotion(self._frame, offsets, depth, gaze, behind)
        return Watched("live" if self._camera.visible else "no_face", 1.0, None, motion, play)

    def draw(self, watched: Watched) -> NDArray[np.uint8]:
        """The portrait (H, W, 3) at what was `watched`; as its picture shows it before it is live."""
        if watched.motion is None or watched.play is None:
            return self._target.face.rgb
        return watched.play.animation.draw(watched.motion, self._plain)

    def _begin(self, rest: FaceCrop) -> None:
        """Follow from now on, held against this rest."""
        target, options = self._target, self._options
        animation = FaceAnimation(target, RegisteredDriver(_still(rest), 0), options, LIVE_PARTS, self._mouth)
        transfer = MotionTransfer(_frames_of(rest), target.face.mesh, target.rig.control, self._proxy, options)
        self._playing, self._calibration = _Play(rest.mesh, transfer, animation), None


def _frames_of(look: FaceCrop) -> DriverFrames:
    """One frame, without points around the head."""
    return DriverFrames(
        look.mesh[None], np.zeros((1, 0, 2), np.float32), np.zeros((1, 0), np.float32), look.in_crop()[None]
    )


def _still(look: FaceCrop) -> FaceTrack:
    """A track of one frame."""
    frames = _frames_of(look)
    strip = FilmStrip(Path(), np.zeros(1, np.int64), look.crop[None])
    return FaceTrack(
        size=(0, 0),
        fps=1.0,
        times=np.arange(2.0),
        has_sound=False,
        meshes=frames.meshes,
        found=np.ones(1, bool),
        periphery=frames.periphery,
        trust=frames.trust,
        crops=strip,
        crop_places=look.place[None],
        faces=np.zeros((0, 4), np.float32),
    )
