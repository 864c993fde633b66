"""What a driving video says: tracked face, tracked surroundings, and its face's appearance, frame by frame.

The analysis is made in one pass over the frames and kept by content, so that a driver seen before costs
no decoding and no tracking. Memory stays flat: appearance goes to a file as it comes.
"""

from __future__ import annotations

from array import array
from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from engine.errors import InputError
from engine.face_animation.appearance import Appearance, appearance
from engine.face_animation.covered_face import CoveredFace
from engine.face_animation.film_strip import FilmStrip, FilmStripWriter
from engine.face_animation.held_face import HeldFace
from engine.face_animation.periphery import PeripheryTracker
from engine.media.limits import Limits
from engine.media.timing import SHORTEST_SPAN
from engine.media.video import probe_video, read_video
from engine.perception.landmarks import MESH_SIZE
from engine.perception.one_face import OneFace
from engine.perception.temporal_filter import steady

LONGEST_SIDE = 1280
"""Pixels; larger drivers are read at this size, which holds all that their analysis keeps."""


@dataclass(frozen=True)
class DriverTrack:
    """A driver's analysis.

    size : (width, height) at which it was read. fps : frames a second, a usual rate where they change. times : (N + 1,)
    seconds of the part that is used at which each frame comes on show, and the last one ends. has_sound.
    meshes : (N, 478, 3) float32 face meshes, steadied, pixels; held where no face was found.
    found : (N,) bool. periphery : (N, K, 2) float32 points tracked around head and shoulders, pixels.
    trust : (N, K) float32 [0, 1], where the forward-backward check passed, fading over to where it did not.
    crops : the face's appearance, frame by frame; `crop_places` (N, 2, 3) carries pixels of the frame to
    pixels of the crop. faces : (F, 4) those to choose of, as x, y, width, height in pixels, the largest first.
    closed : the last frame leads to the first.
    """

    size: tuple[int, int]
    fps: float
    times: NDArray[np.float64]
    has_sound: bool
    meshes: NDArray[np.float32]
    found: NDArray[np.bool_]
    periphery: NDArray[np.float32]
    trust: NDArray[np.float32]
    crops: FilmStrip
    crop_places: NDArray[np.float64]
    faces: NDArray[np.float32]
    closed: bool = False

    def __len__(self) -> int:
        return len(self.meshes)

    @property
    def even(self) -> bool:
        """Whether all frames are on show equally long."""
        return bool(np.ptp(np.diff(self.times)) < 1e-6)

    def crop(self, frame: int) -> NDArray[np.uint8]:
        """The face's appearance in one frame: uint8 (*CROP, 3)."""
        return self.crops.picture(frame)

    def in_crop(self, frame: int) -> NDArray[np.float32]:
        """The frame's mesh in its crop's pixels, (478, 2)."""
        place = self.crop_places[frame]
        return np.asarray(self.meshes[frame, :, :2] @ place[:, :2].T + place[:, 2], np.float32)

    def appearance(self, frame: int) -> Appearance:
        """How the face looks in one frame."""
        return Appearance(self.meshes[frame], self.crop_places[frame], self.crop(frame))


def track_driver(
    path: Path,
    fps: float | None,
    trim: tuple[float, float] | None,
    limits: Limits,
    face_index: int = 0,
    tick: Callable[[float], None] = lambda fraction: None,
    warn: Callable[[str, str], None] = lambda code, message: None,
) -> DriverTrack:
    """Analyse a driving video, by the largest face that its first frame with any shows, or the `face_index`-th.

    Raises
    ------
    InputError : `no_face_in_driver` where no frame shows a face, `driver_face_out_of_range` where there are fewer, and
    what reading the video may raise.
    """
    info = probe_video(path, limits)
    expected = max(1, round(info.seconds * fps) if fps else info.frames)
    meshes = array("f")  # grows in place; thousands of small arrays would lie all over the memory
    places: list[NDArray[np.float64]] = []
    found: list[bool] = []
    starts: list[float] = []
    size = (info.width, info.height)
    periphery, held = PeripheryTracker(), HeldFace()
    with (
        OneFace(face_index) as follow,
        CoveredFace() as covered,
        FilmStripWriter() as crops,
        ThreadPoolExecutor(1) as beside,
    ):
        around: Future[None] = beside.submit(lambda: None)  # the points around follow a frame behind, on another core
        for index, frame in enumerate(
            read_video(path, fps=fps, trim=trim, limits=limits, warn=warn, longest_side=LONGEST_SIDE)
        ):
            tick(min(index / expected, 1.0))
            starts.append(frame.time)
            size = (frame.rgb.shape[1], frame.rgb.shape[0])
            mesh = _followed(follow, frame.rgb, face_index)
            seen = None if mesh is None else appearance(frame.rgb, mesh)
            if seen is not None and covered(frame.rgb, seen):
                mesh = seen = None
            found.append(mesh is not None)
            for look in held(seen):
                meshes.frombytes(look.mesh.astype(np.float32).tobytes())
                places.append(look.place)
                crops.write(look.crop)
            around.result()
            around = beside.submit(periphery.follow, frame.rgb, mesh)
        around.result()
        if not any(found):
            raise InputError(
                "no_face_in_driver",
                "No face was found in the driving video: use one that shows a face from the front.",
                ("driver",),
            )
        strip, faces = crops.strip(), follow.boxes
    stack = np.frombuffer(meshes, np.float32).reshape(-1, MESH_SIZE, 3)
    points, trust = periphery.result()
    _warn(warn, faces, found)
    end = min(trim[1], info.seconds) if trim else info.seconds
    return DriverTrack(
        size=size,
        fps=fps or info.fps,
        times=_times(starts, end, fps or (None if info.variable_rate else info.fps)),
        has_sound=info.has_sound,
        meshes=steady(stack, out=stack),
        found=np.array(found),
        periphery=steady(points),
        trust=trust,
        crops=strip,
        crop_places=np.array(places),
        faces=faces,
    )


def _times(starts: list[float], end: float, fps: float | None) -> NDArray[np.float64]:
    """The frames' `times`, from 0 on, by when each comes on show and the last one ends, seconds of the video; or evenly, at
    `fps`."""
    if fps is not None:
        return np.arange(len(starts) + 1) / fps
    return np.array([*starts, max(end, starts[-1] + SHORTEST_SPAN)]) - starts[0]


def _followed(follow: OneFace, rgb: NDArray[np.uint8], face_index: int) -> NDArray[np.float32] | None:
    try:
        return follow(rgb)
    except IndexError:
        raise InputError(
            "driver_face_out_of_range",
            f"The driver shows {len(follow.boxes)} face(s): driver_face_index counts from 0.",
            ("driver_face_index",),
        ) from None


def _warn(warn: Callable[[str, str], None], faces: NDArray[np.float32], found: list[bool]) -> None:
    if len(faces) > 1:
        warn(
            "several_faces_in_driver",
            f"The driver shows {len(faces)} faces: driver_face_index chooses one, 0 is the largest.",
        )
    if not all(found):
        lost = len(found) - sum(found)
        warn(
            "driver_face_lost",
            f"The driver's face was not seen in {lost} of {len(found)} frames: it holds still there.",
        )
