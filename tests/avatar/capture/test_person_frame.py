"""The person's frame is found again, wherever the cameras' own lies."""

from __future__ import annotations

import cv2
import numpy as np
import pytest
from made_orbit import SIZE, orbit
from scipy.spatial.transform import Rotation

from engine.avatar.capture.person_frame import TAKEN_HEIGHT_METRES, person_frame, upward
from engine.avatar.capture.person_lock import PersonLock
from engine.avatar.capture.scene_cameras import ClipScene
from engine.geometry.multiview.bundle import Bundle, Observations
from engine.geometry.multiview.structure_from_motion.mapping import Reconstruction
from engine.geometry.multiview.structure_from_motion.tracks import Tracks
from engine.geometry.registration.rigid import Similarity
from engine.perception.pose.body import BODY_LANDMARKS, Body

HEIGHT = 1.8


def standing() -> Bundle:
    """An orbit around somebody 1.8 m tall, of 300 points, on a floor of 200; they come first."""
    random = np.random.default_rng(4)
    body = random.uniform([-0.2, 0.02, -0.1], [0.2, HEIGHT - 0.02, 0.1], (300, 3))
    floor = random.uniform([-1.0, -0.004, -1.0], [1.0, 0.004, 1.0], (200, 3))
    bundle = orbit(16, 10, focal=330.0)
    return Bundle(
        bundle.rotations,
        bundle.translations,
        bundle.lenses,
        bundle.centres,
        bundle.lens_of,
        np.concatenate([body, floor]),
    )


def scene_of(bundle: Bundle) -> ClipScene:
    nothing = np.zeros(0, np.intp)
    tracks = Tracks(nothing, nothing, nothing, len(bundle.points))
    seen = Observations(nothing, nothing, np.zeros((0, 2)))
    everything = np.ones(len(bundle.rotations), np.bool_)
    return ClipScene(Reconstruction(bundle, everything, tracks, seen, np.zeros(0, np.bool_)), (), SIZE)


def silhouettes(bundle: Bundle) -> list[np.ndarray]:
    """Of a thin pole as tall as the person, at half size."""
    masks = []
    for c in range(len(bundle.rotations)):
        pole = np.array([[0, 0.0, 0], [0, HEIGHT, 0]])
        low, high = (bundle.camera(c, SIZE).project(pole)[:, :2] + 0.5) / 2 - 0.5
        drawn = np.zeros((SIZE[0] // 2, SIZE[1] // 2), np.uint8)
        cv2.line(drawn, tuple(np.rint(low).astype(int).tolist()), tuple(np.rint(high).astype(int).tolist()), (1,), 4)
        masks.append(drawn > 0)
    return masks


def facing(bundle: Bundle) -> list[Body]:
    """Bodies that face +z, as each camera has them."""
    bodies = []
    for c in range(len(bundle.rotations)):
        world = np.zeros((len(BODY_LANDMARKS), 3))
        for k, name in enumerate(BODY_LANDMARKS):
            world[k] = [0.2 if name.startswith("Left") else -0.2, 0, 0]
        seen = world @ np.array(bundle.camera(c, SIZE).axes).T
        bodies.append(Body(np.zeros((33, 2), np.float32), seen.astype(np.float32), np.ones(33, np.float32)))
    return bodies


def test_metres_up_ground_and_front_are_found_again() -> None:
    truth = standing()
    away = Similarity(0.4 * Rotation.from_rotvec([0.8, -1.9, 0.4]).as_matrix(), np.array([3.0, -1.0, 2.0]))
    moved = truth.moved(away)
    scene = scene_of(moved)
    person = np.arange(500) < 300
    lock = PersonLock(scene, np.ones(16, np.bool_), person)
    own = truth.points.copy()
    own[300:] = np.nan
    locked = scene_of(
        Bundle(moved.rotations, moved.translations, moved.lenses, moved.centres, moved.lens_of, away(own))
    )
    frame = person_frame(scene, PersonLock(locked, lock.locked, person), silhouettes(truth), facing(truth))
    assert frame.on_floor
    assert frame.height == pytest.approx(0.4 * HEIGHT, rel=0.02)
    found = frame.change(away(truth.points))
    off = found * HEIGHT / TAKEN_HEIGHT_METRES - truth.points
    assert np.abs(off[:, 1]).max() < 0.04 and np.abs(off[:, [0, 2]]).max() < 0.06


def test_up_is_what_level_cameras_agree_on() -> None:
    bundle = standing()
    turn = Rotation.from_rotvec([1.0, 0.5, -0.7]).as_matrix()
    moved = bundle.moved(Similarity(turn, np.zeros(3)))
    assert upward(moved, np.ones(16, np.bool_)) == pytest.approx(turn @ [0, 1, 0], abs=1e-6)
