"""An expression in a few numbers, whatever the head's turn: faces at known places, moved by known lengths."""

from __future__ import annotations

import numpy as np
import pytest
from made_face import opened, placed
from numpy.typing import NDArray

from engine.perception.expression.features import (
    EXPRESSION_FEATURES,
    TURNED_CHUNK_FRAMES,
    frontalise,
    lip_asymmetry,
    measure_expression,
)
from engine.perception.face.landmarks import LIPS_INNER, LIPS_OUTER, eye_distance


@pytest.fixture
def rest() -> NDArray:
    return placed()


def test_a_face_turned_to_the_front_is_the_same_wherever_it_was_and_however_large() -> None:
    turned = np.stack([placed(50, (300, 40), yaw=15, roll=20), placed(90, (10, 500), pitch=-12)])
    front = frontalise(turned)
    assert np.abs(front[0] - front[1]).max() < 1e-3
    assert np.allclose(eye_distance(front), 1, atol=1e-6)


def test_an_expression_is_measured_alike_however_the_head_is_turned() -> None:
    plain = measure_expression(placed()[None])
    turned = measure_expression(placed(70, (5, 300), yaw=12, pitch=-10, roll=25)[None])
    assert turned[0, :5] == pytest.approx(plain[0, :5], abs=2e-3)


def test_a_mouth_opened_by_a_known_length_is_open_by_it_and_nothing_else_has_moved(rest: NDArray) -> None:
    shown = dict(zip(EXPRESSION_FEATURES, (measure_expression(np.stack([rest, opened(rest, 0.2)]))).T, strict=True))
    assert shown["mouth_open"][1] - shown["mouth_open"][0] == pytest.approx(0.2, abs=0.02)
    for name in ("inner_brows_up", "outer_brows_up", "eyes_open"):
        assert shown[name][1] == pytest.approx(shown[name][0], abs=1e-3), name


def test_faces_measured_in_several_goes_are_those_measured_alone(rest: NDArray) -> None:
    many = np.repeat(rest[None], TURNED_CHUNK_FRAMES + 2, axis=0)
    many[-1] = opened(rest, 0.2)
    together = measure_expression(many)
    assert len(together) == len(many)
    assert np.allclose(together[[0, -1]], measure_expression(many[[0, -1]]), atol=1e-6)


def test_how_far_lips_are_lopsided_is_the_distance_from_their_mirror_image(rest: NDArray) -> None:
    assert np.abs(lip_asymmetry(rest[None])).max() < 0.01
    moved = placed(50, (100, 100), yaw=15)
    assert np.abs(lip_asymmetry(moved[None])).max() < 0.02  # a turn is none
    aside = rest.copy()
    aside[list(LIPS_OUTER + LIPS_INNER), 0] += 0.1 * eye_distance(rest)
    assert np.allclose(lip_asymmetry(aside[None]) - lip_asymmetry(rest[None]), (0.2, 0), atol=0.01)
