"""Faulty films have the fault that they are named by, and no other."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from benchmarks.scan_studio.conditions import COMPANY_METRES, NAMED_CONDITIONS
from benchmarks.scan_studio.people.subject import Subject
from benchmarks.scan_studio.scenery.room import Room
from benchmarks.scan_studio.scenery.scene import Scene
from benchmarks.scan_studio.studio import Order, Take

SIZE = (72, 128)


def take(egg: Subject, conditions: str, frames: int = 40) -> Take:
    return Take("body", egg, Order({"body": frames, "head": 0}, SIZE, conditions=conditions))


def round_about(egg: Subject, conditions: str) -> NDArray[np.float64]:
    """Degrees round the subject at which each frame is taken."""
    eyes = np.array([camera.eye for camera in take(egg, conditions).truth().cameras])
    return np.asarray(np.degrees(np.unwrap(np.arctan2(eyes[:, 0], eyes[:, 2]))))


def shown(egg: Subject, room: Room, conditions: str) -> NDArray[np.float32]:
    """The light of the second of a few frames."""
    one = take(egg, conditions, 6)
    company = COMPANY_METRES if NAMED_CONDITIONS[conditions].company else None
    frames = one.frames(Scene(room, egg, company))
    next(frames)
    return next(frames)


def magenta(light: NDArray[np.float32]) -> int:
    """Pixels of somebody."""
    return int((np.minimum(light[..., 0], light[..., 2]) > light[..., 1] + 0.3).sum())


def sharpness(light: NDArray[np.float32]) -> float:
    """The steps from a pixel to the next along the rows, at the sharpest edges: the camera moves along them."""
    return float(np.quantile(np.abs(np.diff(light.mean(-1), axis=1)), 0.98))


def test_without_an_orbit_the_camera_stays_and_half_an_orbit_never_sees_the_right_side(egg: Subject) -> None:
    assert np.ptp(round_about(egg, "good")) > 680
    assert np.ptp(round_about(egg, "no-orbit")) < 8
    half = round_about(egg, "half-orbit")
    assert half.min() > -8
    assert 165 < half.max() < 190


def test_who_walks_away_is_elsewhere_at_the_end_alone(egg: Subject) -> None:
    stances = take(egg, "walks-away").truth().stances
    away = np.array([stance.translation for stance in stances])
    assert (away[:18] == 0).all()
    np.testing.assert_allclose(away[-10:], [[1.6, 0, 0]] * 10)


def test_films_are_blurred_by_long_exposures_and_by_haste(egg: Subject, plain_room: Room) -> None:
    good = sharpness(shown(egg, plain_room, "good"))
    assert sharpness(shown(egg, plain_room, "blurred")) < 0.65 * good
    assert sharpness(shown(egg, plain_room, "too-fast")) < 0.8 * good
    assert take(egg, "too-fast").seconds == take(egg, "good").seconds / 10


def test_dark_films_are_dark_and_two_people_are_two(egg: Subject, plain_room: Room) -> None:
    good = shown(egg, plain_room, "good")
    assert shown(egg, plain_room, "dark").mean() < 0.02 * good.mean()
    assert magenta(shown(egg, plain_room, "two-people")) > 1.3 * magenta(good)
