"""The neutral frame is found in tracks in which the test knows it."""

from __future__ import annotations

import tracemalloc
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from made_face import driver, opened, placed, shut, smiling
from numpy.typing import NDArray

from engine.errors import InputError
from engine.face_animation.driver_tracking.driver import track_driver
from engine.face_animation.driver_tracking.neutral import (
    choose_neutral_frame,
    distance_from_rest,
    estimate_rest,
    expression_beyond_rest,
    warn_if_never_at_rest,
)
from engine.media.excerpt import Excerpt
from engine.media.image import read_image
from engine.media.video import read_video
from engine.perception.expression.features import measure_expression
from engine.perception.expression.measures import MEASURES, REST_SPREAD, general_rest, measure
from engine.perception.face.faces import FaceTracker
from engine.perception.face.landmarks import LIPS_INNER, LIPS_OUTER, eye_distance
from engine.perception.face_track.track import FaceTrack
from engine.performances import video
from engine.portrait.driver_segments.rest import own_rest

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
def track(tmp_path: Path, rest: NDArray) -> FaceTrack:
    return driver(tmp_path, clip(rest))


def taken(track: FaceTrack, target: NDArray, chosen: int | None = None) -> int:
    return choose_neutral_frame(track, target, chosen).frame


def test_it_is_the_frame_at_rest(track: FaceTrack, rest: NDArray) -> None:
    assert taken(track, rest) == REST


def test_the_target_s_size_and_place_do_not_count(track: FaceTrack) -> None:
    assert taken(track, placed(160, (700, 500))) == REST


def test_a_driver_that_moves_in_the_picture_has_the_same(tmp_path: Path, rest: NDArray) -> None:
    moved = [m * np.float32(1 + 0.02 * i) + (3 * i, -2 * i, 0) for i, m in enumerate(clip(rest))]
    assert taken(driver(tmp_path, moved), rest) == REST


def test_a_target_with_an_open_mouth_is_matched_with_an_open_mouth(track: FaceTrack, rest: NDArray) -> None:
    assert taken(track, opened(rest, 0.2)) in (0, 4, 8, 16)


def test_a_turned_target_is_matched_with_a_turned_head(track: FaceTrack) -> None:
    """The paper assumes a frontal target; differences against a turned frame suit a turned one."""
    assert taken(track, placed(50, (100, 100), yaw=20, pitch=8)) % 4 == 3


def test_frames_without_a_face_are_not_taken(track: FaceTrack, rest: NDArray) -> None:
    found = np.ones(20, bool)
    found[REST] = False
    assert taken(replace(track, found=found), rest) != REST


def test_the_user_s_choice_counts(track: FaceTrack, rest: NDArray) -> None:
    choice = choose_neutral_frame(track, rest, 5)
    assert (choice.frame, choice.reason) == (5, "chosen")


@pytest.mark.parametrize("chosen", [20, 999])
def test_a_choice_beyond_the_clip_is_refused(track: FaceTrack, rest: NDArray, chosen: int) -> None:
    with pytest.raises(InputError) as caught:
        choose_neutral_frame(track, rest, chosen)
    assert caught.value.code == "neutral_frame_out_of_range"
    assert caught.value.correctable == ("neutral_frame",)
    assert "after trim, at 25 a second, there are 20" in caught.value.detail


def test_one_frame_is_enough(tmp_path: Path, rest: NDArray) -> None:
    assert taken(driver(tmp_path, [opened(rest, 0.1)]), rest) == 0


def test_an_open_mouth_that_does_not_smile_is_no_grin(tmp_path: Path, rest: NDArray) -> None:
    """The frames whose opening is right grin: a mouth that is at rest stands for the target's all the same."""
    frames = [rest, *(opened(smiling(rest, 0.12 * i), 0.03 * i) for i in range(1, 6)), rest]
    speaking = opened(rest, 0.12)
    chosen = taken(driver(tmp_path, frames), speaking)
    assert chosen in (0, 1, len(frames) - 1)
    grinning = opened(smiling(rest, 0.48), 0.12)
    assert taken(driver(tmp_path, frames), grinning) in (3, 4, 5)


def test_a_mouth_torn_to_a_side_does_not_stand_for_a_smile(tmp_path: Path, rest: NDArray) -> None:
    """It alone is as open as the target's; a mouth that is less so is nearer to it all the same."""
    lips = list(LIPS_OUTER + LIPS_INNER)
    target = opened(smiling(rest, 0.2), 0.15)
    torn = target.copy()
    torn[lips, 0] += 0.12 * eye_distance(rest)
    frames = [torn, torn, opened(smiling(rest, 0.15), 0.08), torn, torn]
    assert taken(driver(tmp_path, frames), target) == 2
    assert taken(driver(tmp_path, frames), torn) != 2


def test_a_driver_that_is_surprised_most_of_the_time_rests_where_it_is_not(tmp_path: Path, rest: NDArray) -> None:
    """Neither the mean of the clip nor its usual lids are a face at rest."""
    ahead = [raised(rest, up) for up in (0, 0.03, 0.06, 0.09)]
    frames = [*ahead, *[opened(raised(rest, 0.12), 0.2)] * 20, *reversed(ahead)]
    assert taken(driver(tmp_path, frames), rest) in (0, 1, len(frames) - 2, len(frames) - 1)


def test_a_driver_that_frowns_most_of_the_time_rests_where_it_does_not(tmp_path: Path, rest: NDArray) -> None:
    frames = [rest, *[raised(rest, -0.12)] * 20, rest]
    assert taken(driver(tmp_path, frames), rest) in (0, len(frames) - 1)


@pytest.mark.parametrize("name", ["surprise", "surprise-strong", "anger-strong", "fear-strong", "sadness-strong"])
def test_a_built_in_performance_rests_where_it_begins(name: str, tmp_path: Path, rest: NDArray) -> None:
    """Each begins and ends with a face that does nothing."""
    with FaceTracker() as tracker:
        meshes = [tracker(frame.rgb)[0] for frame in read_video(video(name), fps=15, longest_side=480)]
    shown = measure_expression(np.stack(meshes))
    assert np.abs(shown[taken(driver(tmp_path, meshes), rest)] - shown[0]).max() < 0.05


@pytest.mark.parametrize("low", [-0.05, -0.03])
def test_a_driver_of_low_brows_rests_where_it_usually_is(tmp_path: Path, rest: NDArray, low: float) -> None:
    """Calm people's brows lie higher; its own do not while it does nothing."""
    calm, up = raised(rest, low), raised(rest, low + 0.08)
    frames = [up, *[calm] * 20, up, up]
    assert 1 <= taken(driver(tmp_path, frames), rest) <= 20


def lively(rest: NDArray) -> list[NDArray]:
    """Laughs and says "oh" with its brows up through all of thirty frames but two, which are at rest."""
    frames = [opened(smiling(raised(rest, 0.1), 0.15), 0.1 + 0.01 * (i % 5)) for i in range(15)]
    frames += [opened(raised(rest, 0.15), 0.04 + 0.005 * (i % 4)) for i in range(15)]
    frames[6] = frames[7] = rest
    return frames


def test_a_driver_at_rest_stands_for_a_target_whose_face_is_built_otherwise(tmp_path: Path, rest: NDArray) -> None:
    """High brows and a mouth that is a little open or narrow are how the target is, not what it does: a frame that is
    nearer to them, but shows an expression, is not taken."""
    track = driver(tmp_path, lively(rest))
    for built in (raised(rest, 0.12), raised(rest, -0.05), opened(rest, 0.02), smiling(rest, -0.1), shut(rest, 0.5)):
        choice = choose_neutral_frame(track, built, None)
        assert choice.frame in (6, 7)
        assert choice.reason == "at_rest"


def test_an_expressive_frame_is_taken_where_the_target_wears_it(tmp_path: Path, rest: NDArray) -> None:
    choice = choose_neutral_frame(driver(tmp_path, lively(rest)), opened(smiling(rest, 0.3), 0.12), None)
    assert choice.frame < 15 and choice.frame not in (6, 7)
    assert choice.reason == "like_the_target"


def test_no_expression_is_said_to_be_shared_that_the_driver_never_shows(tmp_path: Path, rest: NDArray) -> None:
    grin = opened(smiling(rest, 0.3), 0.12)
    assert choose_neutral_frame(driver(tmp_path, [rest] * 4), grin, None).reason == "at_rest"
    shouting = [opened(raised(rest, 0.15), 0.3 + 0.01 * i) for i in range(4)]
    assert choose_neutral_frame(driver(tmp_path, shouting), smiling(rest, 0.3), None).reason == "nearest_to_rest"


def test_of_frames_at_rest_the_one_that_looks_where_the_target_looks_is_taken(tmp_path: Path, rest: NDArray) -> None:
    turned = placed(50, (100, 100), yaw=20)
    talking = [opened(turned, 0.2)] * 4  # turned further towards the target, but not at rest
    track = driver(tmp_path, [rest, placed(50, (100, 100), yaw=12), rest, *talking])
    assert taken(track, turned) == 1
    assert taken(track, rest) in (0, 2)


def test_a_driver_that_is_never_at_rest_is_told_of(tmp_path: Path, rest: NDArray) -> None:
    told: list[str] = []
    laughing = [opened(smiling(raised(rest, 0.15), 0.3), 0.2 + 0.01 * i) for i in range(10)]
    for frames in (laughing, [*laughing, rest]):
        warn_if_never_at_rest(
            choose_neutral_frame(driver(tmp_path, frames), rest, None), lambda code, _: told.append(code)
        )
    assert told == ["driver_never_at_rest"]


def test_rest_is_what_few_frames_show_if_the_others_are_unlike_any_rest(rest: NDArray) -> None:
    own = estimate_rest(measure(np.stack(lively(rest))))
    np.testing.assert_allclose(own, measure(rest[None])[0], atol=0.02)


def test_a_rest_of_thousands_of_frames_takes_little_memory() -> None:
    """The distances of 2000 frames from one another are 32 MB, and the peak of a clip of three minutes was three such."""
    values = general_rest() + np.random.default_rng(5).normal(size=(5400, len(MEASURES))) * REST_SPREAD
    tracemalloc.start()
    try:
        estimate_rest(values)
        assert tracemalloc.get_traced_memory()[1] < 10e6
    finally:
        tracemalloc.stop()


def test_rest_is_calm_here_and_a_habit_where_moments_are_cut(rest: NDArray) -> None:
    """Somebody who smiles a little all the time, but for three frames."""
    habit = smiling(rest, 0.2)
    values = measure(np.stack([*[habit] * 60, *[rest] * 3, *[smiling(rest, 1)] * 20])).astype(float)
    values += np.random.default_rng(3).normal(0, 0.005, values.shape)
    assert np.abs(estimate_rest(values) - measure(rest[None])[0]).max() < 0.02
    assert np.abs(own_rest(values) - measure(habit[None])[0]).max() < 0.02


def test_being_unlike_rest_is_the_mean_square_in_what_people_differ_by(rest: NDArray) -> None:
    calm = measure(rest[None]).astype(float)
    more = calm.copy()
    more[0, MEASURES.index("mouth_wide")] += 0.3  # three standard deviations of one of nine measures
    slope = 2 * 3 * (calm[0, 1] - general_rest()[1]) / 0.1
    assert distance_from_rest(more) - distance_from_rest(calm) == pytest.approx((9 + slope) / 9, abs=1e-6)


def test_what_a_target_wears_is_beyond_what_people_differ_by(rest: NDArray) -> None:
    assert not expression_beyond_rest(rest).any()
    assert not expression_beyond_rest(raised(rest, 0.2)).any()
    worn = expression_beyond_rest(opened(rest, 0.3))
    assert worn[0] == pytest.approx(measure(opened(rest, 0.3)[None])[0, 0] - general_rest()[0] - 0.03, abs=1e-5)


def test_a_lively_driver_s_only_calm_moment_is_found(media) -> None:
    """Of its nine seconds, brows up and lips parted or rounded, only the first frames are calm."""
    track = track_driver(Excerpt(media("driving/woman_wow_d10.mp4"), trim=(0.0, 4.0)))
    for target in ("photo_bw_dylan.jpg", "photo_like_girl_dark.jpg", "painting_kahlo.png"):
        with FaceTracker() as tracker:
            mesh = tracker(read_image(media(f"portraits/{target}")).rgb)[0]
        assert taken(track, mesh) <= 2, target
