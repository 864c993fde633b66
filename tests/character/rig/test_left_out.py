"""What a character leaves out of its outline is told, with its place and its share."""

from __future__ import annotations

import numpy as np
import pytest

from engine.character.rig.left_out import left_out, warn_of_silhouette

MASK = np.zeros((400, 200), np.bool_)
MASK[20:380, 60:140] = True


def with_ball() -> np.ndarray:
    mask = MASK.copy()
    mask[200:240, 140:170] = True
    return mask


def test_a_held_thing_is_told_with_its_place_and_share() -> None:
    (ball,) = left_out(with_ball(), MASK)
    assert ball.box == (140, 200, 30, 40)
    assert ball.share == pytest.approx(1200 / with_ball().sum(), rel=0.02)


def test_an_outline_that_is_off_by_a_pixel_leaves_nothing_out() -> None:
    inner = np.zeros_like(MASK)
    inner[21:379, 61:139] = True
    assert left_out(MASK, inner) == [] and left_out(MASK, MASK) == []
    assert left_out(np.zeros_like(MASK), MASK) == []


def test_the_warnings_say_where_and_how_much() -> None:
    notices: dict[str, str] = {}
    warn_of_silhouette(0.96, left_out(with_ball(), MASK), notices.__setitem__)
    assert "4.0% at x 140 to 170, y 200 to 240" in notices["piece_left_out"]
    assert "96.0%" in notices["silhouette_differs"]
    notices.clear()
    warn_of_silhouette(0.981, [], notices.__setitem__)
    assert not notices
