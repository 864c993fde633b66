"""The neutral frame is found in tracks in which the test knows it."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from made_face import driver, opened, placed, shut, smiling
from numpy.typing import NDArray

from engine.errors import InputError
from engine.media.video import read_video
from engine.perception.faces import FaceTracker
from engine.perception.landmarks import LIPS_INNER, LIPS_OUTER, eye_distance
from engine.performances import video
from engine.portrait.driver import DriverTrack
from engine.portrait.expression import expression, lopsided
from engine.portrait.neutral import choose_neutral_frame, neutral_cost

REST = 12
"""The only frame of the clip with a closed mouth, open eyes and a face from the front."""

BROWS = (70, 63, 105, 66, 107, 336, 296, 334, 293, 300)
UPPER_LIDS = (158, 159, 160, 385, 386, 387)


def clip(rest: NDArray) -> list[NDArray]:
    """Twenty frames that talk, blink and turn, and one at rest."""
    frames: list[NDArray] = []
    for i in range(20):
        face = rest
        if i % 4 == 0:
            face = opened(face, 0.2)
        elif i % 4 == 1:
            face = shut(face, 0.1)
        elif i % 4 == 2:
            face = smiling(face, 0.2)
        else:
            face = placed(50, (100, 100), yaw=20, pitch=8)
        frames.append(face)
    frames[REST] = rest
    return frames


def raised(face: NDArray, up: float) -> NDArray[np.float32]:
    """The face with its brows up by so many eye distances, and with them the upper lids by a quarter."""
    high = face.copy()
    high[list(BROWS), 1] -= up * eye_distance(face)
    high[list(UPPER_LIDS), 1] -= up * eye_distance(face) / 4
    return high


@pytest.fixture(scope="module")
def rest() -> NDArray[np.float32]:
    return placed(50, (100, 100))


@pytest.fixture
def track(tmp_path: Path, rest: NDArray) -> DriverTrack:
    return driver(tmp_path, clip(rest))


def test_it_is_the_frame_at_rest(track: DriverTrack, rest: NDArray) -> None:
    assert choose_neutral_frame(track, rest, None) == REST


def test_the_target_s_size_and_place_do_not_count(track: DriverTrack) -> None:
    assert choose_neutral_frame(track, placed(160, (700, 500)), None) == REST


def test_a_driver_that_moves_in_the_picture_has_the_same(tmp_path: Path, rest: NDArray) -> None:
    moved = [m * np.float32(1 + 0.02 * i) + (3 * i, -2 * i, 0) for i, m in enumerate(clip(rest))]
    assert choose_neutral_frame(driver(tmp_path, moved), rest, None) == REST


def test_a_target_with_an_open_mouth_is_matched_with_an_open_mouth(track: DriverTrack, rest: NDArray) -> None:
    assert choose_neutral_frame(track, opened(rest, 0.2), None) in (0, 4, 8, 16)


def test_a_turned_target_is_matched_with_a_turned_head(track: DriverTrack) -> None:
    """The paper assumes a frontal target; differences against a turned frame suit a turned one."""
    assert choose_neutral_frame(track, placed(50, (100, 100), yaw=20, pitch=8), None) % 4 == 3


def test_frames_without_a_face_are_not_taken(track: DriverTrack, rest: NDArray) -> None:
    found = np.ones(20, bool)
    found[REST] = False
    assert choose_neutral_frame(replace(track, found=found), rest, None) != REST


def test_the_user_s_choice_counts(track: DriverTrack, rest: NDArray) -> None:
    assert choose_neutral_frame(track, rest, 5) == 5


@pytest.mark.parametrize("chosen", [20, 999])
def test_a_choice_beyond_the_clip_is_refused(track: DriverTrack, rest: NDArray, chosen: int) -> None:
    with pytest.raises(InputError) as caught:
        choose_neutral_frame(track, rest, chosen)
    assert caught.value.code == "neutral_frame_out_of_range"
    assert caught.value.correctable == ("neutral_frame",)
    assert "after trim, at 25 a second, there are 20" in caught.value.detail


def test_costs_are_least_for_a_match_and_finite(track: DriverTrack, rest: NDArray) -> None:
    cost = neutral_cost(track.meshes, rest)
    assert np.isfinite(cost).all() and (cost >= 0).all()
    assert np.argsort(cost)[0] == REST


def test_one_frame_is_enough(tmp_path: Path, rest: NDArray) -> None:
    assert choose_neutral_frame(driver(tmp_path, [opened(rest, 0.1)]), rest, None) == 0


def test_an_open_mouth_that_does_not_smile_is_no_grin(tmp_path: Path, rest: NDArray) -> None:
    """The frames whose opening is right grin: a mouth that is at rest stands for the target's all the same."""
    frames = [rest, *(opened(smiling(rest, 0.12 * i), 0.03 * i) for i in range(1, 6)), rest]
    speaking = opened(rest, 0.12)
    chosen = choose_neutral_frame(driver(tmp_path, frames), speaking, None)
    assert chosen in (0, 1, len(frames) - 1)
    grinning = opened(smiling(rest, 0.48), 0.12)
    assert choose_neutral_frame(driver(tmp_path, frames), grinning, None) in (3, 4, 5)


def test_a_mouth_torn_to_a_side_does_not_stand_for_a_smile(tmp_path: Path, rest: NDArray) -> None:
    """It alone is as open as the target's; a mouth that is less so is nearer to it all the same."""
    lips = list(LIPS_OUTER + LIPS_INNER)
    target = opened(smiling(rest, 0.2), 0.15)
    torn = target.copy()
    torn[lips, 0] += 0.12 * eye_distance(rest)
    frames = [torn, torn, opened(smiling(rest, 0.15), 0.08), torn, torn]
    assert choose_neutral_frame(driver(tmp_path, frames), target, None) == 2
    assert choose_neutral_frame(driver(tmp_path, frames), torn, None) != 2


def test_how_far_lips_are_lopsided_is_the_distance_from_their_mirror_image(rest: NDArray) -> None:
    assert np.abs(lopsided(rest[None])).max() < 0.01
    moved = placed(50, (100, 100), yaw=15)
    assert np.abs(lopsided(moved[None])).max() < 0.02  # a turn is none
    aside = rest.copy()
    aside[list(LIPS_OUTER + LIPS_INNER), 0] += 0.1 * eye_distance(rest)
    assert np.allclose(lopsided(aside[None]) - lopsided(rest[None]), (0.2, 0), atol=0.01)


def test_a_driver_that_is_surprised_most_of_the_time_rests_where_it_is_not(tmp_path: Path, rest: NDArray) -> None:
    """Neither the mean of the clip nor its usual lids are a face at rest."""
    ahead = [raised(rest, up) for up in (0, 0.03, 0.06, 0.09)]
    frames = [*ahead, *[opened(raised(rest, 0.12), 0.2)] * 20, *reversed(ahead)]
    assert choose_neutral_frame(driver(tmp_path, frames), rest, None) in (0, 1, len(frames) - 2, len(frames) - 1)


def test_a_driver_that_frowns_most_of_the_time_rests_where_it_does_not(tmp_path: Path, rest: NDArray) -> None:
    frames = [rest, *[raised(rest, -0.12)] * 20, raised(rest, -0.06)]
    assert choose_neutral_frame(driver(tmp_path, frames), rest, None) == 0


@pytest.mark.parametrize("name", ["surprise", "surprise-strong", "anger-strong", "fear-strong", "sadness-strong"])
def test_a_built_in_performance_rests_where_it_begins(name: str, rest: NDArray) -> None:
    """Each begins and ends with a face that does nothing."""
    with FaceTracker() as tracker:
        meshes = np.stack([tracker(frame.rgb)[0] for frame in read_video(video(name), fps=15, longest_side=480)])
    shown = expression(meshes)
    assert np.abs(shown[int(neutral_cost(meshes, rest).argmin())] - shown[0]).max() < 0.05


@pytest.mark.parametrize("low", [-0.05, -0.03])
def test_a_driver_of_low_brows_rests_where_it_usually_is(tmp_path: Path, rest: NDArray, low: float) -> None:
    """Calm people's brows lie higher; its own do not while it does nothing."""
    calm, up = raised(rest, low), raised(rest, low + 0.08)
    frames = [up, *[calm] * 20, up, up]
    assert 1 <= choose_neutral_frame(driver(tmp_path, frames), rest, None) <= 20
