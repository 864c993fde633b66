"""What a driving video says: tracked face, tracked surroundings, and its face's appearance, frame by frame.

The analysis is made in one pass over the frames and kept by content, so that a driver seen before costs
no decoding and no tracking. Memory stays flat: appearance goes to a file as it comes.
"""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.errors import InputError
from engine.media.limits import Limits
from engine.media.video import probe_video, read_video
from engine.perception.faces import FaceTracker
from engine.perception.landmarks import MESH_SIZE
from engine.perception.temporal_filter import steady
from engine.portrait.alignment import fit_similarity
from engine.portrait.film_strip import FilmStrip, FilmStripWriter
from engine.portrait.periphery import PeripheryTracker

LONGEST_SIDE = 1280
"""Pixels; larger drivers are read at this size, which holds all that their analysis keeps."""
CROP = (320, 288)
"""Height and width of the kept appearance of the face, pixels: about 20 kB a frame."""
CROP_EYES = ((96.0, 116.0), (192.0, 116.0))
"""Where the eyes' centres lie in it."""
EASE_BACK = 8
"""Frames over which a face that had vanished eases from its held place back to where it was found again."""


@dataclass(frozen=True)
class DriverTrack:
    """A driver's analysis.

    size : (width, height) at which it was read. fps. has_sound.
    meshes : (N, 478, 3) float32 face meshes, steadied, pixels; held where no face was found.
    found : (N,) bool. periphery : (N, K, 2) float32 points tracked around head and shoulders, pixels.
    tracked : (N, K) bool: the forward-backward check passed.
    crops : the face's appearance, frame by frame; `crop_places` (N, 2, 3) carries pixels of the frame to
    pixels of the crop.
    """

    size: tuple[int, int]
    fps: float
    has_sound: bool
    meshes: NDArray[np.float32]
    found: NDArray[np.bool_]
    periphery: NDArray[np.float32]
    tracked: NDArray[np.bool_]
    crops: FilmStrip
    crop_places: NDArray[np.float64]

    def __len__(self) -> int:
        return len(self.meshes)

    def crop(self, frame: int) -> NDArray[np.uint8]:
        """The face's appearance in one frame: uint8 (*CROP, 3)."""
        return self.crops.picture(frame)

    def in_crop(self, frame: int) -> NDArray[np.float32]:
        """The frame's mesh in its crop's pixels, (478, 2)."""
        place = self.crop_places[frame]
        return np.asarray(self.meshes[frame, :, :2] @ place[:, :2].T + place[:, 2], np.float32)


def track_driver(
    path: Path,
    fps: float | None,
    trim: tuple[float, float] | None,
    limits: Limits,
    tick: Callable[[float], None] = lambda fraction: None,
    warn: Callable[[str, str], None] = lambda code, message: None,
) -> DriverTrack:
    """Analyse a driving video.

    Raises
    ------
    InputError : `no_face_in_driver` where no frame shows a face, and what reading the video may raise.
    """
    info = probe_video(path, limits)
    expected = max(1, round(info.seconds * (fps or info.fps)))
    meshes: list[NDArray[np.float32]] = []
    found: list[bool] = []
    places: list[NDArray[np.float64]] = []
    size = (info.width, info.height)
    periphery = PeripheryTracker()
    with FaceTracker() as tracker, FilmStripWriter() as crops, ThreadPoolExecutor(1) as beside:
        around: Future[None] = beside.submit(lambda: None)  # the points around follow a frame behind, on another core
        for index, frame in enumerate(
            read_video(path, fps=fps, trim=trim, limits=limits, warn=warn, longest_side=LONGEST_SIDE)
        ):
            tick(min(index / expected, 1.0))
            size = (frame.rgb.shape[1], frame.rgb.shape[0])
            faces = tracker(frame.rgb)
            found.append(bool(faces))
            mesh = faces[0] if faces else (meshes[-1] if meshes else np.full((MESH_SIZE, 3), np.nan, np.float32))
            meshes.append(mesh)
            places.append(crop_place(mesh) if np.isfinite(mesh).all() else np.eye(2, 3))
            crop = cv2.warpAffine(
                frame.rgb, places[-1], CROP[::-1], flags=cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE
            )
            crops.write(np.asarray(crop, np.uint8))
            around.result()
            around = beside.submit(periphery.follow, frame.rgb, mesh if found[-1] else None)
        around.result()
        if not any(found):
            raise InputError(
                "no_face_in_driver",
                "No face was found in the driving video: use one that shows a face from the front.",
                ("driver",),
            )
        strip = crops.strip()
    held = np.array(meshes, np.float32)
    meshes.clear()
    _hold(held, np.array(found))
    points, tracked = periphery.result()
    if not all(found):
        lost = len(found) - sum(found)
        warn(
            "driver_face_lost",
            f"The driver's face was not seen in {lost} of {len(found)} frames: it holds still there.",
        )
    return DriverTrack(
        size=size,
        fps=fps or info.fps,
        has_sound=info.has_sound,
        meshes=steady(held, out=held),
        found=np.array(found),
        periphery=steady(points),
        tracked=tracked,
        crops=strip,
        crop_places=np.array(places),
    )


def crop_place(mesh: NDArray[np.floating]) -> NDArray[np.float64]:
    """(2, 3): carries pixels of a picture with a face at `mesh` (478, 2 or 3) to pixels of the crop, upright by the eyes."""
    eyes = np.array([mesh[[33, 133], :2].mean(axis=0), mesh[[263, 362], :2].mean(axis=0)])
    return fit_similarity(eyes, np.array(CROP_EYES)).matrix()


def _hold(meshes: NDArray[np.float32], found: NDArray[np.bool_]) -> None:
    """Where the face was lost the last mesh holds; where it comes back the motion eases over to it. In place."""
    first = int(np.argmax(found))
    meshes[:first] = meshes[first]
    back = None
    for i in range(first + 1, len(meshes)):
        if found[i] and not found[i - 1]:
            back, held = i, meshes[i - 1].copy()
        if back is not None and i < back + EASE_BACK:
            t = (i - back + 1) / (EASE_BACK + 1)
            meshes[i] = held + (t * t * (3 - 2 * t)) * (meshes[i] - held)
