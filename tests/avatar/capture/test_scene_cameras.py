"""Cameras of small films of a room: found as they were, or refused with a word."""

from __future__ import annotations

import numpy as np
import pytest
from conftest import FilmedRoom
from made_room import FOCAL, Room, orbit, pattern

from engine.avatar.capture.scene_cameras import film_pairs, solve_scene
from engine.errors import InputError
from engine.geometry.camera import Camera
from engine.geometry.multiview.structure_from_motion.mapping import Reconstruction
from engine.geometry.registration.rigid import fit_similarity


def eye_errors(found: Reconstruction, cameras: list[Camera]) -> np.ndarray:
    """Metres, of the cameras that were found."""
    true = np.array([one.eye for one in cameras])[found.registered]
    eyes = found.bundle.eyes[found.registered]
    return np.linalg.norm(fit_similarity(eyes, true)(eyes) - true, axis=1)


def test_all_cameras_of_an_orbit_are_found(filmed: FilmedRoom) -> None:
    """Two metres away, at 162x288, without knowing the lens."""
    found = filmed.scene.reconstruction
    assert found.registered.all()
    assert eye_errors(found, filmed.cameras).max() < 0.015
    assert found.bundle.lenses[0, 0] == pytest.approx(FOCAL, rel=0.02)


def test_the_last_frames_are_matched_with_the_first(filmed: FilmedRoom) -> None:
    pairs = film_pairs(filmed.scene.features)
    assert (0, 19) in pairs and (1, 19) in pairs
    assert all((i, i + 1) in pairs for i in range(19))
    assert (0, 10) not in pairs, "they look at opposite walls"


def test_half_an_orbit_gives_its_cameras() -> None:
    room, cameras = Room(), orbit(9, turn=np.pi)
    found = solve_scene([room.picture(one) for one in cameras]).reconstruction
    assert found.registered.all()
    assert eye_errors(found, cameras).max() < 0.02


def test_a_camera_that_stands_still_is_refused() -> None:
    picture = Room().picture(orbit(1)[0]).astype(np.int16)
    random = np.random.default_rng(0)
    noisy = [np.clip(picture + random.integers(-4, 5, picture.shape), 0, 255).astype(np.uint8) for _ in range(6)]
    with pytest.raises(InputError) as error:
        solve_scene(noisy)
    assert error.value.code == "camera_stands_still"


def test_frames_that_have_nothing_in_common_are_refused() -> None:
    frames = [pattern(20 + k, 288, 162).astype(np.uint8) for k in range(6)]
    with pytest.raises(InputError) as error:
        solve_scene(frames)
    assert error.value.code == "cameras_not_found"
