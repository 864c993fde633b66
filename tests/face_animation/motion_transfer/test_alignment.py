"""Phi and equation 1."""

from __future__ import annotations

import numpy as np
import pytest
from made_face import placed

from engine.face_animation.motion_transfer.alignment import align
from engine.face_animation.motion_transfer.control_points import carry_fiducials
from engine.geometry.registration.rigid import Similarity
from engine.perception.face.landmarks import EYES_AND_NOSE_TIP


def test_phi_looks_at_eyes_and_nose_tip_alone() -> None:
    """Whatever the other points of the two faces do, phi is theirs."""
    driver, target = placed(40, (100, 90)), placed(80, (300, 240), roll=12)
    phi = align(driver, target)
    assert phi.scale == pytest.approx(2, abs=1e-5)
    assert np.rad2deg(np.arctan2(phi.linear[1, 0], phi.linear[0, 0])) == pytest.approx(12, abs=1e-3)
    others = np.setdiff1d(np.arange(478), EYES_AND_NOSE_TIP)
    target[others] += np.random.default_rng(0).normal(0, 30, (len(others), 3))
    np.testing.assert_allclose(align(driver, target).linear, phi.linear)


def test_equation_1_by_hand() -> None:
    """p_i^t = p_0^t + phi (p_i^S - p_0^S): a quarter turn with scale 2 carries (1, 0) to (0, 2)."""
    phi = Similarity(np.array([[0.0, -2.0], [2.0, 0.0]]), np.array([77.0, 88.0]))
    neutral, target = np.array([[10.0, 10.0], [20.0, 10.0]]), np.array([[100.0, 50.0], [100.0, 70.0]])
    frames = np.array([[[10.0, 10.0], [20.0, 10.0]], [[11.0, 10.0], [20.0, 13.0]]])
    expected = [[[100.0, 50.0], [100.0, 70.0]], [[100.0, 52.0], [94.0, 70.0]]]
    np.testing.assert_allclose(carry_fiducials(phi, frames, neutral, target), expected)
