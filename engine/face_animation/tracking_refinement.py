"""A second look: what a tracker sees in the drawn face is held against what it sees in the driver's.

Control points go where they should, and still the drawn face may look otherwise: a nose that was carried to the side
keeps the shading of a nose seen from the front, and seems turned by less. So a few frames are drawn, tracked, and
compared with the driver's own, both in the same crop and by the same eye: its errors cancel. What is left corrects
all frames, each by those that it resembles.
"""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from contextlib import ExitStack
from dataclasses import dataclass, replace
from threading import local

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.face_animation.acting_options import ActingOptions
from engine.face_animation.animation import FaceAnimation, RegisteredDriver, RiggedTarget
from engine.face_animation.creases.fine_details import DetailRegion, RatioStrip
from engine.face_animation.face_rig import rig_target
from engine.face_animation.motion_transfer.landmark_residuals import (
    LandmarkResiduals,
    fit_residuals,
    flatten_residuals,
    no_residuals,
)
from engine.face_animation.mouth.target_mouth import target_mouth
from engine.face_animation.target_face import TargetFace
from engine.face_animation.warping.layers import single_layer
from engine.imaging.window import Window
from engine.perception.face.faces import FaceTracker
from engine.perception.face.landmarks import MESH_SIZE
from engine.perception.face_track.face_crop import CROP_SHAPE, crop_place
from engine.perception.face_track.track import FaceTrack

OBSERVED_FRAMES = 24
"""How many frames are looked at, besides the neutral one."""
CANDIDATE_FRAMES = 1024
"""Among how many at most, evenly spread over the driver, they are chosen."""


@dataclass(frozen=True)
class DriverObservations:
    """The driver's face where it is looked at.

    frames : (K,) of the driver, the neutral one first.
    seen : (K, 478, 2) float32, what a tracker sees there by itself, pixels of the crop, NaN where it sees no face.
    """

    frames: NDArray[np.int64]
    seen: NDArray[np.float32]


@dataclass(frozen=True)
class ObservedDriver:
    """A driver that the second look can draw and compare: its `track` on the skin, the index of its `neutral` frame, the
    `observations` of it, and its `ratios`, one for each frame."""

    track: FaceTrack
    neutral: int
    observations: DriverObservations
    ratios: RatioStrip


def observe_driver(track: FaceTrack, neutral: int) -> DriverObservations:
    """Look at the driver's most different faces, without what was seen before or after."""
    frames = _most_different(track, neutral)
    return DriverObservations(np.array(frames), _see(lambda k: track.crop(frames[k]), len(frames)))


def refine_tracking(
    driver: ObservedDriver,
    target: TargetFace,
    details: DetailRegion,
    options: ActingOptions,
    tick: Callable[[float], None] = lambda fraction: None,
    cores: Callable[[], int] = lambda: 1,
) -> LandmarkResiduals:
    """The residuals on the target where the driver was observed.

    Of the target its face alone matters: the picture acts as a whole, before the person is cut out of it.

    Parameters
    ----------
    details : where the driver's creases go to.
    options : how the target follows.
    cores : how many may look: more than are idle would only be in the way of what works beside.

    Returns
    -------
    No residuals if the tracker sees no face on the target itself.
    """
    track, neutral = driver.track, driver.neutral
    frames = driver.observations.frames.tolist()
    some = replace(track, meshes=track.meshes[frames], periphery=track.periphery[frames], trust=track.trust[frames])
    layers = single_layer(target)
    animation = FaceAnimation(
        RiggedTarget(target, layers, rig_target(target, layers, details)),
        RegisteredDriver(track, neutral),
        options,
        mouth=target_mouth(target),
    )
    motions = [replace(motion, frame=frames[motion.frame]) for motion in animation.carry(some, frames.index(neutral))]
    placed = [animation.face(motion) for motion in motions]
    places = [crop_place(face) for face in placed]

    def made(k: int) -> NDArray[np.uint8]:
        window = _seen_by(places[k], target.rgb.shape[:2])
        drawn = animation.draw(motions[k], driver.ratios.ratio(frames[k]), window)[..., :3]
        place = places[k].copy()
        place[:, 2] += place[:, :2] @ (window.left, window.top)
        crop = cv2.warpAffine(drawn, place, CROP_SHAPE[::-1], flags=cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE)
        return np.asarray(crop, np.uint8)

    meant = np.stack([face @ place[:, :2].T + place[:, 2] for face, place in zip(placed, places, strict=True)])
    faces = np.stack([track.in_crop(frame) for frame in frames])
    measured = (_see(made, len(frames), tick, cores()) - meant) - (driver.observations.seen - faces)
    measured -= measured[0]  # at rest there is none
    known = np.asarray(np.isfinite(measured).all(axis=(1, 2)))
    return fit_residuals(faces[known], measured[known]) if known[0] else no_residuals()


def _seen_by(place: NDArray[np.float64], shape: tuple[int, int]) -> Window:
    """The part of a picture of this shape that `place` (2, 3) carries into the crop."""
    corners = np.array([(x, y) for x in (0, CROP_SHAPE[1]) for y in (0, CROP_SHAPE[0])]) - place[:, 2]
    there = corners @ np.linalg.inv(place[:, :2]).T
    low = np.clip(np.floor(there.min(axis=0)) - 1, 0, np.array(shape[::-1]) - 1)
    high = np.clip(np.ceil(there.max(axis=0)) + 2, low + 1, shape[::-1])
    return Window(*low.astype(int).tolist(), *high.astype(int).tolist())


def _most_different(track: FaceTrack, neutral: int) -> list[int]:
    """The frames whose faces differ most from each other, beginning with the neutral one."""
    step = -(-len(track) // CANDIDATE_FRAMES)
    among = [neutral, *range(0, len(track), step)]
    faces = flatten_residuals(np.stack([track.in_crop(frame) for frame in among]))
    chosen, apart = [0], ((faces - faces[0]) ** 2).mean(axis=1)
    while len(chosen) <= OBSERVED_FRAMES and apart.max() > 0:
        chosen.append(int(apart.argmax()))
        apart = np.minimum(apart, ((faces - faces[chosen[-1]]) ** 2).mean(axis=1))
    return [among[k] for k in chosen]


def _see(
    picture: Callable[[int], NDArray[np.uint8]],
    count: int,
    tick: Callable[[float], None] = lambda fraction: None,
    threads: int = 1,
) -> NDArray[np.float32]:
    """(count, 478, 2) the face on each of the pictures, seen by itself; NaN where there is none."""
    own = local()
    faces = np.empty((count, MESH_SIZE, 2), np.float32)
    # Left in this order: no thread looks any more when the trackers are closed.
    with ExitStack() as trackers, ThreadPoolExecutor(threads, thread_name_prefix="look") as pool:

        def seen(k: int) -> NDArray[np.float32]:
            if not hasattr(own, "tracker"):
                own.tracker = trackers.enter_context(FaceTracker(alone=True))
            found = own.tracker(picture(k))
            return found[0][:, :2] if found else np.full((MESH_SIZE, 2), np.nan, np.float32)

        for k, face in enumerate(pool.map(seen, range(count))):
            faces[k] = face
            tick((k + 1) / count)
    return faces
