"""Landmarks of one view projected back onto the person's cloud: the paper's way, section 3.3."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from engine.avatar.landmarks.in_frames import FrameLandmarks
from engine.avatar.landmarks.landmark_views import FRONT_VIEW_LANDMARKS, chosen_views, most_frontal
from engine.avatar.landmarks.spatial import FACE_LANDMARKS, SpatialLandmarks
from engine.geometry.camera import Camera

SIGHT_RADIUS_METRES = 0.005
"""Metres about a line of sight within which points of the cloud tell how far it goes."""
SURFACE_DEPTH_METRES = 0.015
"""Metres behind the nearest point about a line of sight within which others are of the same surface."""
MIN_AGREEING_POINTS = 2
"""Points that must tell how far a line of sight goes."""
MAX_LANDMARK_DISTANCE_METRES = 0.06
"""Metres from where many views have a landmark within which one view's is believed: lines of sight past a hand end on the trunk."""
CLOUD_PLACED_LANDMARKS = (*FRONT_VIEW_LANDMARKS, "Index", "Pinky")
"""Landmarks of the body, without a side, that one view and the cloud place better than many views do that see them aslant."""


def back_projected(seen: Sequence[tuple[Camera, FrameLandmarks]], points: NDArray[np.floating]) -> SpatialLandmarks:
    """Landmarks of body and face where the view that shows each best meets the cloud's `points` (N, 3). Where no view
    suits, or the line of sight meets nothing, those of the body are left out, and those of the face are NaN. Hands and
    eyes are not sought."""
    frames = [found for _, found in seen]
    wanted: dict[int, list[str]] = {}
    for name, view in chosen_views(frames).items():
        wanted.setdefault(view, []).append(name)
    body: dict[str, NDArray[np.float64]] = {}
    for view, names in wanted.items():
        camera, found = seen[view]
        places = onto_cloud(camera, np.stack([found.body[name][0] for name in names]), points)
        body |= {name: at for name, at in zip(names, places, strict=True) if np.isfinite(at).all()}
    face = np.full((FACE_LANDMARKS, 3), np.nan)
    frontal = most_frontal(frames)
    if frontal is not None:
        camera, found = seen[frontal]
        assert found.face is not None
        face = onto_cloud(camera, found.face, points)
    return SpatialLandmarks(body, face)


def completed(triangulated: SpatialLandmarks, projected: SpatialLandmarks) -> SpatialLandmarks:
    """Landmarks of a whole body that many views have `triangulated`, with the face and the knuckles as they are `projected` back, and
    with those that views do not agree on."""
    body = dict(triangulated.body)
    for name, at in projected.body.items():
        known = body.get(name)
        surer = name.removeprefix("Left").removeprefix("Right") in CLOUD_PLACED_LANDMARKS
        if known is None or (surer and np.linalg.norm(at - known) < MAX_LANDMARK_DISTANCE_METRES):
            body[name] = at
    off = np.linalg.norm(projected.face - triangulated.face, axis=1)
    taken = np.isfinite(projected.face).all(1) & ~(off > MAX_LANDMARK_DISTANCE_METRES)
    return replace(triangulated, body=body, face=np.where(taken[:, None], projected.face, triangulated.face))


def onto_cloud(camera: Camera, pixels: NDArray[np.floating], points: NDArray[np.floating]) -> NDArray[np.float64]:
    """Where lines of sight through `pixels` (M, 2) first meet a cloud's `points` (N, 3): (M, 3), NaN where they miss it."""
    projected = np.asarray(camera.project(points, np.float64))
    before = np.flatnonzero(projected[:, 2] > 0)
    out = np.full((len(pixels), 3), np.nan)
    if not len(before):
        return out
    reach = SIGHT_RADIUS_METRES * camera.focal / float(np.median(projected[before, 2]))
    near = cKDTree(projected[before, :2]).query_ball_point(np.asarray(pixels, np.float64), reach)
    for k, some in enumerate(near):
        depths = np.sort(projected[before[some], 2])
        surface = depths[depths < depths[0] + SURFACE_DEPTH_METRES] if len(depths) else depths
        if len(surface) >= MIN_AGREEING_POINTS:
            out[k] = camera.unproject(np.asarray(pixels[k : k + 1], np.float64), np.median(surface)[None])[0]
    return out
