"""Landmarks that somebody has placed by hand."""

import numpy as np
import pytest

from engine.avatar.landmarks.given import given_landmarks, placed_by_hand
from engine.avatar.options import AvatarOptions
from engine.errors import InputError
from engine.geometry.camera import Camera

ELBOW = np.array([0.4, 1.1, 0.05])
FRAMES = np.array([3, 40, 77, 118])
PLACED = np.array([0, 2, 3])


def camera(degrees: float) -> Camera:
    eye = 3 * np.array([np.sin(np.radians(degrees)), 0.0, np.cos(np.radians(degrees))]) + [0, 1, 0]
    return Camera((0.0, 0.0, 0.0), 1400.0, (359.5, 639.5), (1280, 720)).aimed(eye, (0.0, 1.0, 0.0))


CAMERAS = [camera(0), camera(40), camera(90)]


def options(**places: list[tuple[int, tuple[float, float]]]) -> AvatarOptions:
    landmarks = {name: [{"frame": f, "place": at} for f, at in some] for name, some in places.items()}
    return AvatarOptions.model_validate({"landmarks": landmarks})


def seen(view: int, at: np.ndarray = ELBOW) -> tuple[float, float]:
    x, y = CAMERAS[view].project(at, np.float64)[:2]
    return float(x), float(y)


def test_where_two_frames_point_at_it_the_landmark_is() -> None:
    chosen = options(LeftElbow=[(3, seen(0)), (118, seen(2))])
    (given,) = given_landmarks(chosen.landmarks, FRAMES, PLACED)
    assert given.views.tolist() == [0, 2]  # among the frames with a camera
    np.testing.assert_allclose(placed_by_hand(given, CAMERAS), ELBOW, atol=1e-6)


def test_fingers_that_are_seven_pixels_off_place_it_no_further_off_than_those_are_wide() -> None:
    places = [(3, np.add(seen(0), (6, -4))), (77, np.add(seen(1), (-5, 5))), (118, np.add(seen(2), (4, 6)))]
    chosen = options(LeftElbow=[(f, (at[0], at[1])) for f, at in places])
    (given,) = given_landmarks(chosen.landmarks, FRAMES, PLACED)
    assert np.linalg.norm(placed_by_hand(given, CAMERAS) - ELBOW) < 7.2 * 3 / 1400


def test_frames_that_point_at_different_things_are_refused() -> None:
    knee = np.array([0.1, 0.5, 0.0])
    (given,) = given_landmarks(options(LeftElbow=[(3, seen(0)), (118, seen(2, knee))]).landmarks, FRAMES, PLACED)
    with pytest.raises(InputError) as raised:
        placed_by_hand(given, CAMERAS)
    assert raised.value.code == "landmarks_needed" and raised.value.correctable == ("landmarks",)


@pytest.mark.parametrize(
    ("name", "frame", "code"), [("LeftElbov", 3, "landmark_unknown"), ("LeftElbow", 40, "frame_not_used")]
)
def test_what_is_not_there_is_said(name: str, frame: int, code: str) -> None:
    chosen = options(**{name: [(frame, (1.0, 1.0)), (118, (1.0, 1.0))]})
    with pytest.raises(InputError) as raised:
        given_landmarks(chosen.landmarks, FRAMES, PLACED)
    assert raised.value.code == code
