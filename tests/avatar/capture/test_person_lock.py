"""Cameras locked to what sways: it stands still in them."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from conftest import FilmedRoom
from made_orbit import SIZE as MADE_SIZE
from made_orbit import observed
from made_orbit import orbit as bare_orbit
from made_room import PILLAR_HEIGHT, PILLAR_RADIUS, pillar_mask

from engine.avatar.capture.person_lock import focus_of, lock_to_person, person_tracks
from engine.avatar.capture.scene_cameras import ClipScene
from engine.geometry.multiview.bundle import Bundle
from engine.geometry.multiview.structure_from_motion.mapping import Lens, Reconstruction, reconstruct
from engine.geometry.multiview.structure_from_motion.tracks import PairMatches
from engine.geometry.registration.rigid import fit_similarity


def test_the_focus_is_what_all_cameras_look_at() -> None:
    bundle = bare_orbit(12)
    seen = observed(bundle)
    found = Reconstruction(bundle, np.ones(12, np.bool_), None, seen, np.ones(len(seen), np.bool_))  # type: ignore[arg-type]
    focus = focus_of(found)
    assert focus.middle == pytest.approx([0, 0.9, 0], abs=0.02)
    assert focus.distance == pytest.approx(2.0, rel=0.03)


def test_tracks_of_the_pillar_are_told_from_those_of_the_room(filmed: FilmedRoom) -> None:
    found = filmed.scene.reconstruction
    masks = [pillar_mask(camera) for camera in filmed.cameras]
    to_room = fit_similarity(found.bundle.eyes, np.array([one.eye for one in filmed.cameras]))
    points = to_room(found.bundle.points)
    near = np.hypot(points[:, 0], points[:, 2]) < PILLAR_RADIUS + 0.05
    pillar = near & (points[:, 1] > 0.05) & (points[:, 1] < PILLAR_HEIGHT)
    chosen = person_tracks(filmed.scene, masks) & found.solved
    assert chosen[pillar].mean() > 0.9
    assert pillar[chosen].mean() > 0.95


def test_tracks_that_were_found_nowhere_are_the_persons_where_masks_say_so(filmed: FilmedRoom) -> None:
    masks = [pillar_mask(camera) for camera in filmed.cameras]
    found = filmed.scene.reconstruction
    lost = np.flatnonzero(person_tracks(filmed.scene, masks) & found.solved)[::5]
    points = found.bundle.points.copy()
    points[lost] = np.nan
    scene = replace(filmed.scene, reconstruction=replace(found, bundle=replace(found.bundle, points=points)))
    assert len(lost) > 5 and person_tracks(scene, masks)[lost].all()
    assert not person_tracks(scene, None)[lost].any()


def test_who_sways_stands_still_in_locked_cameras() -> None:
    """Relative to somebody who sways by 6 mm, cameras are where they were less the sway: locked ones say so, the room's do
    not. From exact features with 0.3 pixels of noise."""
    truth = bare_orbit(24, 150)
    phase = 2 * np.pi * np.arange(24) / 24
    sway = 0.006 * np.stack([np.sin(phase), np.zeros(24), np.cos(2 * phase)], axis=1)
    eyes_of_body = truth.eyes - sway
    of_body = replace(truth, translations=-np.einsum("cij,cj->ci", truth.rotations, eyes_of_body))
    features, pairs, moving = matched_orbit(truth, of_body, 40)
    found = reconstruct(features, pairs, Lens(truth.lenses[0], truth.centres[0], known=True))
    assert found is not None and found.registered.all()
    scene = ClipScene(found, (), MADE_SIZE)
    own = np.zeros(found.tracks.count, np.bool_)
    own[found.tracks.track[found.tracks.feature < moving[found.tracks.image]]] = True
    lock = lock_to_person(scene, own)
    assert lock.locked.all()
    before, after = (pixel_errors(one, of_body) for one in (found.bundle, lock.scene.reconstruction.bundle))
    assert np.median(before) > 0.7
    assert np.median(after) < 0.5 * np.median(before)


def matched_orbit(room: Bundle, body: Bundle, count: int) -> tuple[list, list[PairMatches], np.ndarray]:
    """Features and matches of an orbit: the first `count` points as the cameras of `body` see them, the others as those of
    `room` do; and how many of each frame's features, which come first, are the body's."""
    seen, other = observed(room, 0.3), observed(body, 0.3)
    features, names = [], []
    for c in range(len(room.rotations)):
        fixed, moving = (seen.camera == c) & (seen.point >= count), (other.camera == c) & (other.point < count)
        features.append(np.concatenate([other.pixels[moving], seen.pixels[fixed]]))
        names.append(np.concatenate([other.point[moving], seen.point[fixed]]))
    pairs = []
    for a in range(len(features)):
        for b in ((a + step) % len(features) for step in (1, 2, 3)):
            _, i, j = np.intersect1d(names[a], names[b], return_indices=True)
            pairs.append(PairMatches(a, b, np.stack([i, j], axis=1)))
    return (
        features,
        pairs,
        np.array([int(((other.camera == c) & (other.point < count)).sum()) for c in range(len(features))]),
    )


def pixel_errors(bundle: Bundle, truth: Bundle) -> np.ndarray:
    """(C,) pixels by which points of the resting body are seen from where they are, in the mean over each frame."""
    moved = bundle.moved(fit_similarity(bundle.eyes, truth.eyes))
    return np.array(
        [
            np.linalg.norm(
                (
                    moved.camera(c, MADE_SIZE).project(truth.points[:100])
                    - truth.camera(c, MADE_SIZE).project(truth.points[:100])
                )[:, :2],
                axis=1,
            ).mean()
            for c in range(len(truth.rotations))
        ]
    )


def test_without_a_person_all_stays_as_the_room_has_it(filmed: FilmedRoom) -> None:
    nobody = np.zeros(filmed.scene.reconstruction.tracks.count, np.bool_)
    lock = lock_to_person(filmed.scene, nobody)
    assert not lock.locked.any()
    assert np.array_equal(lock.scene.reconstruction.bundle.eyes, filmed.scene.reconstruction.bundle.eyes)
