"""A second film of the same person in the frame of the first: the close-up of the head in that of the body.

Both show the same room, which tells where they are to one another; then the person, who may have moved between the films,
has the last word: their size above all, which the room tells badly where the lens's focal length is a little wrong in either
film. Places tell it about, and pixels exactly.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from engine.avatar.capture.person_lock import PersonLock, focus_of
from engine.avatar.capture.scene_cameras import ClipScene
from engine.geometry.multiview.structure_from_motion.joining import join_by_pixels
from engine.geometry.multiview.structure_from_motion.mapping import Reconstruction
from engine.geometry.registration.consensus import similarity_by_consensus
from engine.geometry.registration.rigid import Similarity
from engine.imaging.feature_matching import match_features, verified_matches
from engine.imaging.features import Features

MATCHED_FRAMES = 3
"""Frames of the first film that each of the second is matched with."""
COARSE_FEATURES = 300
"""Features by which partners are chosen."""
MIN_SHARED = 20
"""Points in common by which two films are joined."""
MIN_PERSON_SHARED = 12
"""Points of the person in common by which they have the last word."""
ROOM_TOLERANCE, PERSON_TOLERANCE = 0.03, 0.05
"""Distances of the first film's cameras by which places in common may be apart before pixels decide: of the room, and of the
person, who may have moved."""


@dataclass(frozen=True)
class Joint:
    """The `change` from the second film's frame to the first one's; `shared`: points in common that agree; `by_person`:
    whether the person had the last word."""

    change: Similarity
    shared: int
    by_person: bool


def join_clips(first: PersonLock, second: PersonLock, rooms: tuple[ClipScene, ClipScene]) -> Joint | None:
    """The second film in the frame of the first; None where they have too little in common.

    Parameters
    ----------
    first, second : both films, locked to the person. rooms : the same, as the room has them.
    """
    tracks = _shared_tracks(*rooms)
    distance = focus_of(rooms[0].reconstruction).distance
    a, b = rooms[0].reconstruction.bundle.points[tracks[:, 0]], rooms[1].reconstruction.bundle.points[tracks[:, 1]]
    known = np.isfinite(a[:, 0]) & np.isfinite(b[:, 0])
    if known.sum() < MIN_SHARED:
        return None
    found = similarity_by_consensus(b[known], a[known], ROOM_TOLERANCE * distance)
    if found is None or found.agreed.sum() < MIN_SHARED:
        return None
    joined = join_by_pixels(
        rooms[0].reconstruction, rooms[1].reconstruction, tracks[known], found.transform, rooms[0].length
    )
    if joined.agreed.sum() < MIN_SHARED:
        return None
    own = tracks[first.person[tracks[:, 0]] & second.person[tracks[:, 1]]]
    a = first.scene.reconstruction.bundle.points[own[:, 0]]
    b = joined.change(second.scene.reconstruction.bundle.points[own[:, 1]])
    own = own[np.linalg.norm(a - b, axis=1) < PERSON_TOLERANCE * distance]  # false where a point is not known
    last = None
    if len(own) >= MIN_PERSON_SHARED:
        persons = first.scene.reconstruction, second.scene.reconstruction
        last = join_by_pixels(*persons, own, joined.change, rooms[0].length)
    if last is None or last.agreed.sum() < MIN_PERSON_SHARED:
        return Joint(joined.change, int(joined.agreed.sum()), by_person=False)
    return Joint(last.change, int(last.agreed.sum()), by_person=True)


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
    return features[np.argsort(-features.sizes, kind="stable")[:COARSE_FEATURES]]
