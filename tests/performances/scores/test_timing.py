"""Curves in time: where they start, where they end, and that they never jump."""

import numpy as np
import pytest

from engine.performances.scores.timing import blink, ease, glances, idle_noise, swell


def test_an_eased_step_starts_and_ends_at_rest() -> None:
    t = np.linspace(0, 3, 3001)
    values = np.array([ease(x, 1.0, 2.0) for x in t])
    speed = np.gradient(values, t)
    assert values[0] == 0 and values[-1] == 1
    assert ease(1.5, 1.0, 2.0) == pytest.approx(0.5)
    assert (np.diff(values) >= 0).all()
    assert abs(speed[1000]) < 1e-3 and abs(speed[2000]) < 1e-3
    assert speed.max() == pytest.approx(1.875, rel=1e-3)  # of the path of least jerk


def test_a_swell_is_whole_between_apex_and_release() -> None:
    assert swell(0.2, 0.3, 0.9, 2.0, 3.0) == 0
    assert swell(0.9, 0.3, 0.9, 2.0, 3.0) == 1
    assert swell(2.0, 0.3, 0.9, 2.0, 3.0, sag=0.2) == pytest.approx(0.8)
    assert swell(3.0, 0.3, 0.9, 2.0, 3.0) == 0


def test_a_blink_shuts_in_a_tenth_of_a_second_and_opens_more_slowly() -> None:
    t = np.linspace(0.9, 1.6, 701)
    lid = np.array([blink(x, 1.0) for x in t])
    assert lid.max() == 1
    assert lid[0] == 0 and lid[-1] == pytest.approx(0, abs=1e-3)
    assert np.abs(np.diff(lid)).max() < 0.03  # in a millisecond
    falling = (t[lid >= 0.9].min() - t[lid >= 0.1].min()) * 1000
    rising = (t[lid >= 0.1].max() - t[lid >= 0.9].max()) * 1000
    assert 40 < falling < 100
    assert 80 < rising < 220
    at_30_fps = [max(blink(k / 30 + phase, 1.0) for k in range(60)) for phase in np.linspace(0, 1 / 30, 20)]
    assert min(at_30_fps) > 0.98  # however the frames fall, one of them shows the eye shut


def test_glances_hold_between_saccades() -> None:
    places = ((-1.0, 0.0, 0.0), (1.0, 2.0, -3.0), (2.0, 0.0, 0.0))
    assert glances(0.5, places) == (0, 0)
    assert glances(1.5, places) == (2, -3)
    assert glances(2.5, places) == (0, 0)


@pytest.mark.parametrize("seed", range(5))
def test_unrest_repeats_without_a_seam_from_zero(seed: int) -> None:
    t = np.linspace(0, 10, 2001)
    values = np.array([idle_noise(x, seed, 5.0) for x in t])
    assert values[0] == pytest.approx(0, abs=1e-12)
    np.testing.assert_allclose(values[:1000], values[1000:2000], atol=1e-9)
    assert 0.5 < values.std() < 1.5
    assert np.abs(np.diff(values)).max() < 0.1
