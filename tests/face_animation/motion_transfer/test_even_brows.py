"""Brows move as bands."""

from __future__ import annotations

import numpy as np

from engine.face_animation.motion_transfer.even_brows import brow_share, even_brows
from engine.perception.face.head_pose import canonical_face
from engine.perception.face.landmarks import LEFT_BROW, RIGHT_BROW

FACE = canonical_face()[:, :2].astype(float)
BELOW = brow_share() == 0


def test_a_raised_forehead_stays_raised_and_the_rest_of_the_face_as_it_is() -> None:
    np.testing.assert_allclose(even_brows().sum(axis=1), 1)
    offsets = np.random.default_rng(0).normal(size=(478, 2))
    np.testing.assert_array_equal((even_brows() @ offsets)[BELOW], offsets[BELOW])


def test_a_hook_in_a_brow_is_evened_out() -> None:
    """One point of a brow that rises alone takes its neighbours along, and rises by less."""
    hook = np.zeros(478)
    hook[LEFT_BROW[2]] = 1.0
    evened = even_brows() @ hook
    assert evened[LEFT_BROW[2]] < 0.4
    assert np.abs(evened[list(RIGHT_BROW)]).max() < 0.01


def test_one_brow_rises_without_the_other() -> None:
    raised = np.where(FACE[:, 0] > 0, 1.0, 0.0) * ~BELOW
    evened = even_brows() @ raised
    outer = list(LEFT_BROW[:3])
    assert evened[outer].mean() > 0.9 and evened[list(RIGHT_BROW[:3])].mean() < 0.1
