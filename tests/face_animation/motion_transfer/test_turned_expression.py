"""A turned head's expression is even; one seen from the front is as it is."""

from __future__ import annotations

import cv2
import numpy as np
import pytest
from made_face import placed
from numpy.typing import NDArray

from engine.face_animation.motion_transfer.head_motion import HeadMotion
from engine.face_animation.motion_transfer.turned_expression import even_out_turned
from engine.perception.face.head_pose import mirror_vertices

FACE = placed(40.0, (150.0, 120.0)).astype(float)
SMIRK = np.zeros((478, 3), np.float32)
SMIRK[291] = (6.0, -4.0, 1.0)
OPPOSITE = 61


def turned(degrees: tuple[float, float, float], expression: NDArray[np.float32], neutral: NDArray = FACE) -> HeadMotion:
    rotation = cv2.Rodrigues(np.deg2rad(degrees))[0][None]
    return HeadMotion(neutral, np.ones(1), rotation, np.zeros((1, 3)), expression[None])


@pytest.mark.parametrize("degrees", [(0.0, 0.0, 0.0), (15.0, 3.0, -20.0)])
def test_a_smirk_of_a_head_that_nods_or_tilts_is_one(degrees: tuple[float, float, float]) -> None:
    np.testing.assert_allclose(even_out_turned(turned(degrees, SMIRK))[0], SMIRK, atol=0.05)


@pytest.mark.parametrize("degrees", [20.0, -20.0])
def test_of_a_turned_head_both_corners_go_the_mean(degrees: float) -> None:
    even = even_out_turned(turned((0.0, degrees, 0.0), SMIRK))[0]
    np.testing.assert_allclose(even[291], (3.0, -2.0, 0.5), atol=0.02)
    np.testing.assert_allclose(even[OPPOSITE], (-3.0, -2.0, 0.5), atol=0.02)


@pytest.mark.parametrize("degrees", [0.0, 10.0, 25.0])
def test_what_both_halves_do_stays_at_any_turn(degrees: float) -> None:
    smile = SMIRK.copy()
    smile[OPPOSITE] = (-6.0, -4.0, 1.0)
    np.testing.assert_allclose(even_out_turned(turned((0.0, degrees, 0.0), smile))[0], smile, atol=0.02)


def test_it_counts_from_the_front_not_from_rest() -> None:
    """A driver whose neutral frame is turned, and who turns to the camera, shows there what they do."""
    rotation = cv2.Rodrigues(np.deg2rad((0.0, 20.0, 0.0)))[0]
    neutral = FACE @ rotation.T
    smirk = np.asarray(SMIRK @ rotation.T, np.float32)
    front = even_out_turned(turned((0.0, -20.0, 0.0), smirk, neutral))[0]
    np.testing.assert_allclose(front, smirk, atol=0.05)
    aside = even_out_turned(turned((0.0, 0.0, 0.0), smirk, neutral))[0] @ rotation
    np.testing.assert_allclose(aside[OPPOSITE], aside[291] * (-1, 1, 1), atol=0.02)
    assert mirror_vertices()[291] == OPPOSITE
