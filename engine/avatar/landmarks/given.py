"""Landmarks that somebody has pointed at, where perception does not find them well."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from engine.avatar.landmarks.robust_triangulation import triangulate_robustly
from engine.avatar.options import PlacedLandmark
from engine.errors import InputError
from engine.geometry.camera import Camera
from engine.perception.pose.body import BODY_LANDMARKS

POINTED_AT_SIGMA_SHARE = 12 / 720
"""By what share of a frame's shorter side a landmark is off that somebody has pointed at in a small picture of it."""


@dataclass(frozen=True)
class GivenLandmark:
    """The landmark `name` at `pixels` (N, 2) of the views `views` (N,), by their numbers."""

    name: str
    views: NDArray[np.int64]
    pixels: NDArray[np.float64]


def given_landmarks(
    landmarks: Mapping[str, Sequence[PlacedLandmark]], frames: NDArray[np.int64], placed: NDArray[np.int64]
) -> tuple[GivenLandmark, ...]:
    """Landmarks by the views that show them.

    Parameters
    ----------
    landmarks : as the options have them: frames of the clip, and pixels of its own size.
    frames : (N,) which of the clip's frames were chosen.
    placed : (V,) which of those have a camera: the views, in their order.

    Raises `InputError`: `landmark_unknown`; `frame_not_used` where a landmark was placed in a frame that is not used.
    """
    given = []
    for name, places in sorted(landmarks.items()):
        if name not in BODY_LANDMARKS:
            names = ", ".join(BODY_LANDMARKS)
            raise InputError("landmark_unknown", f"There is no landmark {name!r}. There are: {names}.", ("landmarks",))
        views = [_view(place.frame, frames[placed]) for place in places]
        pixels = np.array([place.place for place in places], np.float64)
        given.append(GivenLandmark(name, np.array(views, np.int64), pixels))
    return tuple(given)


def placed_by_hand(given: GivenLandmark, cameras: Sequence[Camera]) -> NDArray[np.float64]:
    """Where a landmark (3,) is, metres, that somebody has pointed at in some of the views of `cameras`.

    Raises `InputError`: `landmarks_needed` where the views do not agree, or all look along one line.
    """
    seeing = [cameras[view] for view in given.views]
    sigma = np.array([POINTED_AT_SIGMA_SHARE * min(camera.size) for camera in seeing])
    found = triangulate_robustly(seeing, given.pixels, np.ones(len(seeing)), sigma)
    if found is None:
        raise InputError(
            "landmarks_needed",
            f"The frames do not agree where {given.name} is: point at it in frames from different sides (`landmarks`).",
            ("landmarks",),
            {"doubtful": [given.name]},
        )
    return found.place


def _view(frame: int, used: NDArray[np.int64]) -> int:
    found = np.flatnonzero(used == frame)
    if not len(found):
        raise InputError(
            "frame_not_used",
            f"Nothing is made of frame {frame} of the body's clip: place landmarks in frames that the report lists.",
            ("landmarks",),
            {"frames": used.tolist()},
        )
    return int(found[0])
