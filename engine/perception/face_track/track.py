"""One face of a video: tracked mesh, tracked surroundings, and how the face looks, frame by frame.

All of it is made in one pass over the frames. Memory stays flat: how the face looks goes to a file as it comes.
"""

from __future__ import annotations

from array import array
from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from engine.media.decoding.timing import MIN_SPAN_SECONDS
from engine.media.excerpt import Excerpt
from engine.media.film_strip import FilmStrip, FilmStripWriter
from engine.media.video import probe_video, read_video
from engine.perception.face.landmarks import MESH_SIZE
from engine.perception.face.one_face import OneFace
from engine.perception.face_track.covered_face import CoveredFace
from engine.perception.face_track.face_crop import FaceCrop, crop_face
from engine.perception.face_track.held_face import HeldFace
from engine.perception.face_track.periphery import PeripheryTracker
from engine.perception.face_track.steady_face import steady_face, steady_points

MAX_TRACKED_SIDE_PIXELS = 1280
"""Pixels; larger videos are read at this size, which holds all that is kept of them."""


class NoFaceSeen(Exception):
    """No frame of the video shows a face."""


class NoSuchFace(Exception):
    """The video shows `faces` faces, and fewer than were counted on."""

    def __init__(self, faces: int):
        super().__init__(f"{faces} faces")
        self.faces = faces


@dataclass(frozen=True)
class FaceTrack:
    """A face followed through a video, in N frames.

    size : (width, height) at which it was read.
    fps : frames a second, a usual rate where they change.
    times : (N + 1,) seconds of the part that is used at which each frame comes on show, and the last one ends.
    has_sound : whether the video has any.
    meshes : (N, 478, 3) float32 pixels, face meshes, steadied; held where no face was found.
    found : (N,) bool, whether a face was.
    periphery : (N, K, 2) float32 pixels, points tracked around head and shoulders.
    trust : (N, K) float32 in [0, 1], where the forward-backward check passed, fading over to where it did not.
    crops : the face's appearance, frame by frame.
    crop_places : (N, 2, 3) carries pixels of the frame to pixels of the crop.
    faces : (F, 4) pixels, those to choose of as x, y, width, height, the largest first.
    closed : whether the last frame leads to the first.
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

    def face_crop(self, frame: int) -> FaceCrop:
        """How the face looks in one frame."""
        return FaceCrop(self.meshes[frame], self.crop_places[frame], self.crop(frame))


def track_face(
    excerpt: Excerpt,
    face_index: int = 0,
    tick: Callable[[float], None] = lambda fraction: None,
    warn: Callable[[str, str], None] = lambda code, message: None,
) -> FaceTrack:
    """Follow a face through a video: the largest one that its first frame with any shows, or the `face_index`-th.

    `warn` is as of `read_video`.

    Raises
    ------
    NoFaceSeen, NoSuchFace, and what reading the video may raise.
    """
    path, fps, trim, limits = excerpt.path, excerpt.fps, excerpt.trim, excerpt.limits
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
            read_video(path, fps=fps, trim=trim, limits=limits, warn=warn, longest_side=MAX_TRACKED_SIDE_PIXELS)
        ):
            tick(min(index / expected, 1.0))
            starts.append(frame.time)
            size = (frame.rgb.shape[1], frame.rgb.shape[0])
            mesh = _followed(follow, frame.rgb)
            seen = None if mesh is None else crop_face(frame.rgb, mesh)
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
            raise NoFaceSeen
        strip, faces = crops.strip(), follow.boxes
    stack = np.frombuffer(meshes, np.float32).reshape(-1, MESH_SIZE, 3)
    points, trust = periphery.result()
    points = steady_points(points, stack)
    end = min(trim[1], info.seconds) if trim else info.seconds
    return FaceTrack(
        size=size,
        fps=fps or info.fps,
        times=_times(starts, end, fps or (None if info.variable_rate else info.fps)),
        has_sound=info.has_sound,
        meshes=steady_face(stack, out=stack),
        found=np.array(found),
        periphery=points,
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
    return np.array([*starts, max(end, starts[-1] + MIN_SPAN_SECONDS)]) - starts[0]


def _followed(follow: OneFace, rgb: NDArray[np.uint8]) -> NDArray[np.float32] | None:
    try:
        return follow(rgb)
    except IndexError:
        raise NoSuchFace(len(follow.boxes)) from None
