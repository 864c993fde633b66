"""The sway is as far as it is said to be, about the ankles, and the arms drift on their own."""

from __future__ import annotations

import numpy as np
import pytest

from benchmarks.scan_studio.people.subject import Subject
from benchmarks.scan_studio.people.sway import ARM_METRES, CHEST_SHARE, SmoothCurve, Sway

MOMENTS = np.linspace(0, 80, 400)


def test_a_smooth_curve_has_no_mean_and_is_one_long_where_it_is_longest() -> None:
    curve = SmoothCurve(3, 80, seed=5)(np.linspace(0, 80, 3000))
    np.testing.assert_allclose(curve.mean(0), 0, atol=2e-3)
    assert np.linalg.norm(curve, axis=1).max() == pytest.approx(1, abs=2e-3)


def test_the_chest_moves_by_the_sway_and_the_feet_stay(egg: Subject) -> None:
    sway = Sway(egg, 0.005, 80, seed=1)
    chest, feet = np.array([0, CHEST_SHARE * egg.height, 0]), np.zeros(3)
    stances = [sway(second) for second in MOMENTS.tolist()]
    moved = np.array([stance.rotation @ chest + stance.translation - chest for stance in stances])
    assert np.linalg.norm(moved, axis=1).max() == pytest.approx(0.005, rel=0.02)
    np.testing.assert_allclose(moved.mean(0), 0, atol=2e-4)  # at rest they stand in the middle of their sway
    for stance in stances:
        np.testing.assert_allclose(stance.rotation @ feet + stance.translation, 0, atol=1e-12)


def test_wrists_drift_by_eight_and_eleven_millimetres_against_the_body(egg: Subject) -> None:
    sway = Sway(egg, 0.005, 80, seed=1)
    for k, sign in enumerate((1, -1)):
        to_wrist = sign * egg.arms[k].reach * np.array([1.0, 0.0, 0.0])
        drifts = []
        for second in MOMENTS.tolist():
            vector = sway(second).arms[k]
            drifts.append(np.linalg.norm(np.cross(vector, to_wrist)))
        assert max(drifts) == pytest.approx(ARM_METRES[k], rel=0.02)


def test_what_goes_with_no_arm_moves_rigidly(egg: Subject) -> None:
    stance = Sway(egg, 0.02, 80, seed=3)(31.0)
    trunk = (egg.arms[0].weights + egg.arms[1].weights) == 0
    expected = egg.vertices[trunk] @ stance.rotation.T + stance.translation
    np.testing.assert_allclose(stance.place(egg)[trunk], expected, atol=1e-12)
    assert np.abs(stance.place(egg)[~trunk] - egg.vertices[~trunk] @ stance.rotation.T).max() > 0.005


def test_who_stands_still_is_at_rest(egg: Subject) -> None:
    sway = Sway(egg, 0.0, 80, seed=1)
    for second in (0.0, 33.3, 80.0):
        np.testing.assert_array_equal(sway(second).place(egg), egg.vertices)
