"""A second film of the same person in the frame of the first: the close-up of the head in that of the body.

Both show the same room. It tells where they are to one another, once both are adjusted as one. Alone, a lens's focal
length is a per cent or two off in either film. By as much the room is nearer or farther in each, and the head too large
or small. Then the person, who may have moved between the films, has the last word.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from engine.avatar.capture.person_lock import PersonLock, focus_of
from engine.avatar.capture.scene_cameras import ClipScene, with_reconstruction
from engine.geometry.multiview.structure_from_motion.joining import adjust_together, join_by_pixels
from engine.geometry.multiview.structure_from_motion.mapping import Reconstruction
from engine.geometry.registration.consensus import similarity_by_consensus
from engine.geometry.registration.rigid import Similarity, fit_rigid, fit_robustly
from engine.imaging.feature_matching import match_features, verified_matches
from engine.imaging.features import Features

MATCHED_FRAMES = 3
"""Frames of the first film that each of the second is matched with."""
COARSE_FEATURE_COUNT = 300
"""Features by which partners are chosen."""
MIN_SHARED_POINTS = 20
"""Points in common by which two films are joined."""
MIN_SHARED_PERSON_POINTS = 12
"""Points of the person in common by which the person has the last word about where two films are to one another."""
ROOM_TOLERANCE_CAMERA_DISTANCES, PERSON_TOLERANCE_CAMERA_DISTANCES = 0.03, 0.01
"""Distances of the first film's cameras by which points in common may be apart: of the room, which is far, and of the person."""
ADJUSTMENT_ROUNDS = 3
"""Times that both films are adjusted as one: each time more of what they share agrees."""


@dataclass(frozen=True)
class JoinedScenes:
    """Both films, `first` and `second`, in the first one's frame; `shared` (M, 2): the tracks that agree to be one point each."""

    first: ClipScene
    second: ClipScene
    shared: NDArray[np.intp]


def join_scenes(first: ClipScene, second: ClipScene) -> JoinedScenes | None:
    """Two films of one room in one frame; None where they have too little in common."""
    tracks = _shared_tracks(first, second)
    one, other = first.reconstruction, second.reconstruction
    a, b = one.bundle.points[tracks[:, 0]], other.bundle.points[tracks[:, 1]]
    known = np.isfinite(a[:, 0]) & np.isfinite(b[:, 0])
    if known.sum() < MIN_SHARED_POINTS:
        return None
    found = similarity_by_consensus(b[known], a[known], ROOM_TOLERANCE_CAMERA_DISTANCES * focus_of(one).distance)
    if found is None or found.agreed.sum() < MIN_SHARED_POINTS:
        return None
    tracks, change = tracks[known], found.transform
    shared = tracks
    for _ in range(ADJUSTMENT_ROUNDS):
        joined = join_by_pixels(one, other, tracks, change, first.length)
        shared = tracks[joined.agreed]
        if len(shared) < MIN_SHARED_POINTS:
            return None
        one, other = adjust_together(one, other, shared, joined.change)
        change = Similarity(np.eye(3), np.zeros(3))
    return JoinedScenes(with_reconstruction(first, one), with_reconstruction(second, other), shared)


def in_frame_of(joined: JoinedScenes, first: ClipScene) -> ClipScene:
    """The second film of a pair as it stands to the first one in another frame, in which that stood before both were adjusted."""
    before, after = first.reconstruction, joined.first.reconstruction
    both = before.solved & after.solved
    sigma = PERSON_TOLERANCE_CAMERA_DISTANCES * focus_of(before).distance
    change = fit_robustly(after.bundle.points[both], before.bundle.points[both], sigma).transform
    second = joined.second.reconstruction
    return with_reconstruction(joined.second, replace(second, bundle=second.bundle.moved(change)))


def moved_person(first: PersonLock, second: PersonLock, tracks: NDArray[np.integer]) -> Similarity:
    """The rigid motion that the person made between both films, from where the second has them to where the first has.
    Both are in one frame and locked to the person. None at all where they share too little of them.

    Parameters
    ----------
    tracks : (M, 2) of the first and of the second film, that are one point each.
    """
    distance = focus_of(first.scene.reconstruction).distance
    own = tracks[first.person[tracks[:, 0]] & second.person[tracks[:, 1]]]
    a = first.scene.reconstruction.bundle.points[own[:, 0]]
    b = second.scene.reconstruction.bundle.points[own[:, 1]]
    near = (
        np.linalg.norm(a - b, axis=1) < 5 * PERSON_TOLERANCE_CAMERA_DISTANCES * distance
    )  # false where a point is not known
    if near.sum() < MIN_SHARED_PERSON_POINTS:
        return Similarity(np.eye(3), np.zeros(3))
    return fit_robustly(b[near], a[near], PERSON_TOLERANCE_CAMERA_DISTANCES * distance, fit_rigid).transform


def _shared_tracks(first: ClipScene, second: ClipScene) -> NDArray[np.intp]:
    """(M, 2) tracks of both films that frames of both show to be one, each pair once."""
    found: list[NDArray[np.intp]] = [np.zeros((0, 2), np.intp)]
    names = [_tracks_of_features(scene) for scene in (first, second)]
    small = [[_largest(one) for one in scene.features] for scene in (first, second)]
    for j in np.flatnonzero(second.reconstruction.registered):
        counts = np.array([len(match_features(one, small[1][j])) for one in small[0]])
        for i in np.argsort(-counts * first.reconstruction.registered, kind="stable")[:MATCHED_FRAMES]:
            matches = verified_matches(first.features[i], second.features[j], first.length)
            pair = np.stack([names[0][i][matches[:, 0]], names[1][j][matches[:, 1]]], axis=1)
            found.append(pair[(pair >= 0).all(axis=1)])
    return np.asarray(np.unique(np.concatenate(found), axis=0))


def _tracks_of_features(scene: ClipScene) -> list[NDArray[np.intp]]:
    """Of each frame (F,): the track that each feature belongs to, -1 where to none."""
    found: Reconstruction = scene.reconstruction
    names = [np.full(len(one), -1, np.intp) for one in scene.features]
    for image in range(len(names)):
        mine = found.tracks.image == image
        names[image][found.tracks.feature[mine]] = found.tracks.track[mine]
    return names


def _largest(features: Features) -> Features:
    return features[np.argsort(-features.sizes, kind="stable")[:COARSE_FEATURE_COUNT]]
