"""What every performance promises: it starts and ends neutral, moves without jumps, and idle has no seam."""

import numpy as np
import pytest

from engine.body import FACE_UNITS
from engine.performances import PERFORMANCE_STATES, performance
from engine.performances.catalogue import PERFORMANCE_FPS, scored
from engine.performances.modelling.figure import Pose
from engine.performances.scores.score import PERFORMANCE_SECONDS, SCORES


def numbers(pose: Pose) -> np.ndarray:
    """A pose as one row of numbers: units, then degrees and millimetres."""
    units = [pose.units.get(name, 0.0) for name in FACE_UNITS]
    return np.array([*units, *pose.head, *pose.gaze, pose.breath, *(1000 * x for x in pose.lean)])


@pytest.mark.parametrize("name", SCORES)
def test_every_performance_starts_in_the_neutral_pose(name: str) -> None:
    np.testing.assert_allclose(numbers(SCORES[name](0.0)), numbers(Pose()), atol=0.01)


@pytest.mark.parametrize("name", SCORES)
def test_every_performance_ends_in_the_neutral_pose(name: str) -> None:
    np.testing.assert_allclose(numbers(SCORES[name](PERFORMANCE_SECONDS[name])), numbers(Pose()), atol=0.02)


@pytest.mark.parametrize("name", [entry.name for entry in scored() if entry.loops])
def test_idle_repeats_without_a_seam(name: str) -> None:
    step = numbers(SCORES[name](0.0)) - numbers(SCORES[name](PERFORMANCE_SECONDS[name] - 1 / PERFORMANCE_FPS))
    before = numbers(SCORES[name](PERFORMANCE_SECONDS[name] - 1 / PERFORMANCE_FPS)) - numbers(
        SCORES[name](PERFORMANCE_SECONDS[name] - 2 / PERFORMANCE_FPS)
    )
    assert np.abs(step).max() < 0.3
    assert np.abs(step - before).max() < 0.1
    if name == "idle":
        for t in (0.0, 0.5, 1.3, 4.9):
            np.testing.assert_allclose(
                numbers(SCORES[name](t))[:-8], numbers(SCORES[name](t % PERFORMANCE_SECONDS[name]))[:-8], atol=1e-9
            )


@pytest.mark.parametrize("name", SCORES)
def test_only_known_units_within_their_range_are_used(name: str) -> None:
    for t in np.arange(0, PERFORMANCE_SECONDS[name], 1 / PERFORMANCE_FPS):
        units = SCORES[name](t).units
        assert set(units) <= set(FACE_UNITS)
        assert all(-0.12 <= weight <= 1.25 for weight in units.values())


@pytest.mark.parametrize("name", SCORES)
def test_nothing_but_lids_and_eyes_jumps_between_frames(name: str) -> None:
    """Lips and brows of real drivers cover at most a fifth of their way from one frame to the next, a third in a
    start or in lively speech. A head that says no turns by some hundred degrees a second, any other by thirty."""
    state = performance(name).state
    rows = np.array([numbers(SCORES[name](t)) for t in np.arange(0, PERFORMANCE_SECONDS[name], 1 / PERFORMANCE_FPS)])
    quick = [i for i, unit in enumerate(FACE_UNITS) if unit.startswith("eye")]
    slow = [i for i in range(len(FACE_UNITS)) if i not in quick]
    assert np.abs(np.diff(rows[:, slow], axis=0)).max() < (0.37 if state in ("talk", "surprise") else 0.25)
    turned = np.abs(np.diff(rows[:, len(FACE_UNITS) : len(FACE_UNITS) + 3], axis=0)).max()  # degrees
    assert turned < (3.3 if state in ("nod", "shake") else 1.3)


@pytest.mark.parametrize(
    ("state", "rise", "at_least"),
    [
        ("happy", ("cheekSquintLeft", "mouthSmileLeft"), 0.6),  # 6 + 12
        ("surprise", ("browInnerUp", "browOuterUpLeft", "eyeWideLeft", "jawOpen"), 0.45),  # 1 + 2 + 5 + 26
        ("anger", ("browDownLeft", "eyeWideLeft", "eyeSquintLeft"), 0.3),  # 4 + 5 + 7
        ("fear", ("browInnerUp", "browOuterUpLeft", "browDownLeft", "eyeWideLeft", "mouthStretchLeft"), 0.25),
        ("sadness", ("browInnerUp", "mouthFrownLeft"), 0.6),  # 1 + 15
    ],
)
def test_emotions_show_their_action_units(state: str, rise: tuple[str, ...], at_least: float) -> None:
    """The units that the Facial Action Coding System gives for each emotion, all together for a while; further in the
    strong performance than in the normal one."""
    heights = []
    for name in (state, f"{state}-strong"):
        rows = np.array(
            [
                [SCORES[name](t).units.get(unit, 0.0) for unit in rise]
                for t in np.arange(0, PERFORMANCE_SECONDS[name], 1 / PERFORMANCE_FPS)
            ]
        )
        together = (rows > at_least * (1.0 if name == state else 0.9)).all(axis=1)
        assert together.sum() > 0.4 * PERFORMANCE_FPS, name
        heights.append(rows.max(axis=0).mean())
    assert heights[1] > 1.08 * heights[0]


def test_anger_tightens_the_lips_and_rage_bares_the_teeth() -> None:
    assert SCORES["anger"](1.2).units["mouthRollLower"] > 0.35 > 0.0 == SCORES["anger"](1.2).units.get("jawOpen", 0.0)
    assert SCORES["anger-strong"](1.2).units["mouthUpperUpLeft"] > 0.35


@pytest.mark.parametrize(("name", "axis"), [("nod", 0), ("nod-strong", 0), ("shake", 1), ("shake-strong", 1)])
def test_gestures_swing_about_one_axis(name: str, axis: int) -> None:
    head = np.array([SCORES[name](t).head for t in np.arange(0, PERFORMANCE_SECONDS[name], 1 / PERFORMANCE_FPS)])
    spans = np.ptp(head, axis=0)
    assert spans.argmax() == axis and spans[axis] > 3 * np.delete(spans, axis).max()
    way = head[:, axis] - head[:, axis].mean()
    assert (np.diff(np.sign(way[np.abs(way) > 0.2 * np.abs(way).max()])) != 0).sum() >= 3


def test_a_wink_shuts_one_eye_alone() -> None:
    for name in ("wink", "wink-strong"):
        lids = np.array(
            [
                [SCORES[name](t).units.get(f"eyeBlink{side}", 0.0) for side in ("Left", "Right")]
                for t in np.arange(0, PERFORMANCE_SECONDS[name], 1 / PERFORMANCE_FPS)
            ]
        )
        alone = (lids[:, 0] > 0.95) & (lids[:, 1] < 0.1)
        assert 0.15 * PERFORMANCE_FPS < alone.sum() < 0.5 * PERFORMANCE_FPS


@pytest.mark.parametrize("name", ["talk", "talk-strong"])
def test_talk_has_the_rhythm_of_speech_and_no_period(name: str) -> None:
    """The jaw of people who read aloud opens two to seven times a second; no two openings are alike."""
    jaw = np.array(
        [
            SCORES[name](t).units.get("jawOpen", 0.0)
            for t in np.arange(0, PERFORMANCE_SECONDS[name], 1 / PERFORMANCE_FPS)
        ]
    )
    tops = [i for i in range(1, len(jaw) - 1) if jaw[i - 1] < jaw[i] >= jaw[i + 1] and jaw[i] > 0.06]
    assert 2 < len(tops) / (tops[-1] - tops[0]) * PERFORMANCE_FPS < 7
    assert np.std(np.diff(tops)) > 1.0 and np.std(jaw[tops]) > 0.04
    lips = np.array(
        [
            SCORES[name](t).units.get("mouthPucker", 0.0)
            for t in np.arange(0, PERFORMANCE_SECONDS[name], 1 / PERFORMANCE_FPS)
        ]
    )
    assert abs(np.corrcoef(jaw, lips)[0, 1]) < 0.5  # the lips have a part of their own


def test_the_two_halves_of_the_face_differ_a_little() -> None:
    units = SCORES["happy"](0.7).units
    left, right = units["mouthSmileLeft"], units["mouthSmileRight"]
    assert 0.01 < abs(left - right) < 0.15


def test_the_catalogue_and_the_scores_agree() -> None:
    assert {entry.name for entry in scored()} == set(SCORES)
    assert {(entry.state, entry.strength) for entry in scored()} == {
        (state, strength) for state in PERFORMANCE_STATES for strength in ("normal", "strong")
    }
    for entry in scored():
        assert entry.name == entry.state + ("-strong" if entry.strength == "strong" else "")
        assert 0 < entry.poster_frame < entry.seconds * PERFORMANCE_FPS
