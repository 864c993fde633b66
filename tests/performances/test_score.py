"""What every performance promises: it starts and ends neutral, moves without jumps, and idle has no seam."""

import numpy as np
import pytest

from engine.body import FACE_UNITS
from engine.performances import catalogue
from engine.performances.catalogue import FPS
from engine.performances.figure import Pose
from engine.performances.score import SCORES, SECONDS


def numbers(pose: Pose) -> np.ndarray:
    """A pose as one row of numbers: units, then degrees and millimetres."""
    units = [pose.units.get(name, 0.0) for name in FACE_UNITS]
    return np.array([*units, *pose.head, *pose.gaze, pose.breath, *(1000 * x for x in pose.lean)])


@pytest.mark.parametrize("name", SCORES)
def test_every_performance_starts_in_the_neutral_pose(name: str) -> None:
    np.testing.assert_allclose(numbers(SCORES[name](0.0)), numbers(Pose()), atol=0.01)


@pytest.mark.parametrize("name", SCORES)
def test_every_performance_ends_in_the_neutral_pose(name: str) -> None:
    np.testing.assert_allclose(numbers(SCORES[name](SECONDS[name])), numbers(Pose()), atol=0.02)


def test_idle_repeats_without_a_seam() -> None:
    for t in (0.0, 0.5, 1.3, 4.9):
        np.testing.assert_allclose(
            numbers(SCORES["idle"](t))[:-8], numbers(SCORES["idle"](t % SECONDS["idle"]))[:-8], atol=1e-9
        )
    step = numbers(SCORES["idle"](0.0)) - numbers(SCORES["idle"](SECONDS["idle"] - 1 / FPS))
    before = numbers(SCORES["idle"](SECONDS["idle"] - 1 / FPS)) - numbers(SCORES["idle"](SECONDS["idle"] - 2 / FPS))
    assert np.abs(step).max() < 0.15
    assert np.abs(step - before).max() < 0.05


@pytest.mark.parametrize("name", SCORES)
def test_only_known_units_within_their_range_are_used(name: str) -> None:
    for t in np.arange(0, SECONDS[name], 1 / FPS):
        units = SCORES[name](t).units
        assert set(units) <= set(FACE_UNITS)
        assert all(-0.12 <= weight <= 1.25 for weight in units.values())


@pytest.mark.parametrize("name", SCORES)
def test_nothing_but_lids_and_eyes_jumps_between_frames(name: str) -> None:
    """Lips and brows of real drivers cover at most a fifth of their way from one frame to the next."""
    rows = np.array([numbers(SCORES[name](t)) for t in np.arange(0, SECONDS[name], 1 / FPS)])
    quick = [i for i, unit in enumerate(FACE_UNITS) if unit.startswith("eye")]
    slow = [i for i in range(len(FACE_UNITS)) if i not in quick]
    assert np.abs(np.diff(rows[:, slow], axis=0)).max() < 0.25
    assert np.abs(np.diff(rows[:, len(FACE_UNITS) : len(FACE_UNITS) + 3], axis=0)).max() < 1.0  # degrees


def test_the_two_halves_of_the_face_differ_a_little() -> None:
    units = SCORES["happy"](0.7).units
    left, right = units["mouthSmileLeft"], units["mouthSmileRight"]
    assert 0.01 < abs(left - right) < 0.15


def test_the_catalogue_and_the_scores_agree() -> None:
    assert {entry.name for entry in catalogue()} == set(SCORES)
