"""From the frames of a person's films to cameras, in the axes of the person (the paper's section 3.2)."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import partial

import numpy as np
from numpy.typing import NDArray

from engine.avatar.capture.joined_clips import JoinedScenes, in_frame_of, join_scenes, moved_person
from engine.avatar.capture.people_shown import look_for_people, refuse_wrong_clips
from engine.avatar.capture.person_frame import person_frame
from engine.avatar.capture.person_lock import PersonLock, lock_to_person, person_tracks
from engine.avatar.capture.person_masks import believed_masks, settled_masks
from engine.avatar.capture.scene_cameras import ClipScene, solve_scene
from engine.avatar.capture.seen_sides import unseen_side
from engine.avatar.capture.standing import refuse_walking
from engine.errors import InputError
from engine.geometry.camera import Camera
from engine.geometry.multiview.structure_from_motion.mapping import Lens
from engine.geometry.registration.rigid import Similarity
from engine.imaging.resample import enlarged_mask

HEAD_UNPLACED = frozenset({"camera_stands_still", "cameras_not_found"})
"""What makes a clip of the head one that is not used: the body alone is an avatar, too."""

Tick = Callable[[float], None]
Warn = Callable[[str, str], None]


@dataclass(frozen=True)
class ClipCameras:
    """The cameras of one film's C frames, in the person's frame: y up, facing +z, the person `TAKEN_HEIGHT_METRES` tall; None where
    none was found.

    cameras : locked to the person, who stands still in them; where `locked` (C,) is False, the room's.
    room : as the room has them.
    masks : (h, w) bool, where the person is in each frame, 480 pixels long.
    points : (P, 3) float64, the sparse points of the person.
    """

    cameras: tuple[Camera | None, ...]
    room: tuple[Camera | None, ...]
    locked: NDArray[np.bool_]
    masks: tuple[NDArray[np.bool_], ...]
    points: NDArray[np.float64]


@dataclass(frozen=True)
class CaptureCameras:
    """Of the `body` film and, where they could be joined, of the `head` film and of the `further` ones, in one frame and of one size."""

    body: ClipCameras
    head: ClipCameras | None
    further: tuple[ClipCameras | None, ...] = ()


@dataclass(frozen=True)
class _Film:
    """A film's frames, what networks believe and, of a person seen whole, where they are; and its cameras as the room has them."""

    frames: Sequence[NDArray[np.uint8]]
    beliefs: Sequence[NDArray[np.float32]]
    masks: Sequence[NDArray[np.bool_]]
    scene: ClipScene


@dataclass(frozen=True)
class _Clip:
    scene: ClipScene
    lock: PersonLock
    masks: tuple[NDArray[np.bool_], ...]


def solve_cameras(
    body: Sequence[NDArray[np.uint8]],
    head: Sequence[NDArray[np.uint8]] | None,
    warn: Warn,
    tick: Tick = lambda fraction: None,
    lenses: tuple[Lens | None, Lens | None] = (None, None),
    further: Sequence[Sequence[NDArray[np.uint8]]] = (),
) -> CaptureCameras:
    """Cameras of the frames of both films, and of further ones.

    Parameters
    ----------
    body, head, further : frames (H, W, 3) uint8 sRGB, in the films' order; each film's of one size.
    warn : is told a code and a sentence: `side_unseen`, `head_not_joined`, `further_not_joined`, `floor_unseen`, `sway_unseen`.
    lenses : of both films' frames, where they are known.

    Raises `InputError`: `camera_stands_still`, `cameras_not_found` of the body's film, `clips_swapped`, `no_person`,
    `two_people`, `person_walks`.
    """
    shown = look_for_people(body)
    refuse_wrong_clips(shown, None if head is None else look_for_people(head))
    done = 1 / (1 + len(further))
    share = done if head is None else 0.6 * done
    film = _solved(body, True, lenses[0], lambda fraction: tick(share * fraction))
    refuse_walking(film.scene, film.masks)
    near = None
    if head is not None:
        near = _head_film(head, lenses[1], warn, lambda fraction: tick(share + (done - share) * fraction))
    joined = None if near is None else join_scenes(film.scene, near.scene)
    if near is not None and joined is None:
        warn("head_not_joined", "The head clip shows too little of what the body clip shows, and is not used.")
    whole = _locked(film if joined is None else replace(film, scene=joined.first))
    frame = person_frame(whole.scene, whole.lock, whole.masks, shown.bodies(len(body)))
    if not frame.on_floor:
        warn("floor_unseen", "The floor around the feet has no pattern: the feet's height is a guess.")
    found = _placed(whole, frame.change)
    if side := unseen_side(np.array([camera.eye for camera in found.cameras if camera is not None])):
        warn("side_unseen", f"The clip does not show the person's {side}: it is filled in by guessing.")
    if not found.locked.all():
        count = int((~found.locked).sum())
        warn("sway_unseen", f"In {count} frames too little is seen of the person to tell how they swayed.")
    close = None
    if near is not None and joined is not None:
        close = _beside(whole, replace(near, scene=joined.second), joined, frame.change)
    others = []
    for number, frames in enumerate(further):
        begun = done * (1 + number)
        others.append(_further_film(whole, frames, frame.change, warn, partial(_told_of, tick, begun, done)))
    return CaptureCameras(found, close, tuple(others))


def _told_of(tick: Tick, begun: float, share: float, fraction: float) -> None:
    tick(begun + share * fraction)


def _further_film(
    whole: _Clip, frames: Sequence[NDArray[np.uint8]], change: Similarity, warn: Warn, tick: Tick
) -> ClipCameras | None:
    """The cameras of a further film of the same person; None where they cannot be found. `change`: to the person's frame."""
    try:
        film = _solved(frames, False, None, tick)
    except InputError as refused:
        if refused.code not in HEAD_UNPLACED:
            raise
        warn("further_not_joined", f"A further clip is not used. {refused.detail}")
        return None
    joined = join_scenes(whole.scene, film.scene)
    if joined is None:
        warn("further_not_joined", "A further clip shows too little of what the body clip shows, and is not used.")
        return None
    return _beside(whole, replace(film, scene=in_frame_of(joined, whole.scene)), joined, change)


def _beside(whole: _Clip, film: _Film, joined: JoinedScenes, change: Similarity) -> ClipCameras:
    """A film in the frame of the body's, as the person stands in that one, brought by `change` to the person's frame."""
    clip = _locked(film)
    moved = moved_person(whole.lock, clip.lock, joined.shared)
    return _placed(clip, Similarity(change.linear @ moved.linear, change(moved.shift)))


def _head_film(frames: Sequence[NDArray[np.uint8]], lens: Lens | None, warn: Warn, tick: Tick) -> _Film | None:
    """The film of the head; None where its cameras cannot be found."""
    try:
        return _solved(frames, False, lens, tick)
    except InputError as refused:
        if refused.code not in HEAD_UNPLACED:
            raise
        warn("head_not_joined", f"The head clip is not used. {refused.detail}")
        return None


def _solved(frames: Sequence[NDArray[np.uint8]], whole: bool, lens: Lens | None, tick: Tick) -> _Film:
    """A film with its cameras as the room has them. Of a person seen `whole` the masks are known before."""
    beliefs = believed_masks(frames, whole)
    masks = settled_masks(frames, beliefs) if whole else []
    tick(0.2)
    height, width = frames[0].shape[:2]
    favoured = [enlarged_mask(mask, (width, height)) for mask in masks] or None
    scene = solve_scene(frames, favoured, lens, lambda fraction: tick(0.2 + 0.8 * fraction))
    return _Film(frames, beliefs, masks, scene)


def _locked(film: _Film) -> _Clip:
    """The film locked to the person; of a head, what the cameras go around."""
    person = person_tracks(film.scene, film.masks or None)
    masks = film.masks or settled_masks(film.frames, film.beliefs, film.scene, person)
    return _Clip(film.scene, lock_to_person(film.scene, person), tuple(masks))


def _placed(clip: _Clip, change: Similarity) -> ClipCameras:
    room = clip.scene.reconstruction.bundle.moved(change)
    person = clip.lock.scene.reconstruction.bundle.moved(change)
    cameras = []
    for bundle in (person, room):
        cameras.append(
            tuple(
                bundle.camera(c, clip.scene.size) if there else None
                for c, there in enumerate(clip.scene.reconstruction.registered)
            )
        )
    points = person.points[clip.lock.scene.reconstruction.solved]
    return ClipCameras(cameras[0], cameras[1], clip.lock.locked, clip.masks, points)
