"""A lid that comes out of its fold over an eyeball."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from engine.avatar.registration.eyes.shut_lids import (
    BLINK_GAP_METRES,
    MAX_DRAWN_BACK_METRES,
    SHUT_LID_METRES,
    drawn_back,
    shut_lid,
)
from engine.avatar.registration.eyes.tucked_lids import LidColumns, tucked_lid

RADIUS = 0.012
AHEAD = np.array([0.0, 0, 1])


def ball() -> NDArray[np.float64]:
    """(E, 3) vertices all over it."""
    out = np.random.default_rng(0).normal(size=(500, 3))
    return np.asarray(RADIUS * out / np.linalg.norm(out, axis=1, keepdims=True))


def on_ball(degrees: NDArray[np.float64] | float, off: float = 0.0004) -> NDArray[np.float64]:
    """(..., 3) places so far up before the ball, in its middle plane."""
    turn = np.radians(degrees)
    return (RADIUS + off) * np.stack([0 * turn, np.sin(turn), np.cos(turn)], -1)


def test_a_shut_lid_lies_on_the_ball_and_ends_on_the_lower_lid_and_in_its_fold() -> None:
    rim = np.stack([[-0.013, 0, 0.004], on_ball(20.0), [0.013, 0, 0.004], on_ball(-20.0)])
    untucked = on_ball(np.linspace(20, 65, 12), 0.0015)
    untucked[0] = on_ball(20.0)
    columns = tucked_lid(untucked[None], rim)
    up = LidColumns.of(columns, rim).up()[0]
    shut = shut_lid(columns, rim, on_ball(-20.0)[None], ball())[0]
    np.testing.assert_allclose(shut[0], on_ball(-20.0), atol=1e-9)
    np.testing.assert_array_equal(shut[up >= 1], columns[0, up >= 1])
    assert (up >= 1).sum() > 3 and ((up > 0.2) & (up < 0.6)).sum() > 1
    reach, height = np.linalg.norm(shut, axis=1), np.degrees(np.arctan2(shut[:, 1], shut[:, 2]))
    on_it = (up > 0.2) & (up < 0.6)
    np.testing.assert_allclose(reach[on_it], RADIUS + SHUT_LID_METRES, atol=1e-9)
    fold = np.degrees(np.arctan2(*[np.interp(1, up, columns[0, :, axis]) for axis in (1, 2)]))
    np.testing.assert_allclose(height[up < 1], -20 + up[up < 1] * (fold + 20), atol=1e-6)
    assert reach.min() > RADIUS


@pytest.mark.parametrize("degrees", [8.0, 14.0])
def test_an_eye_draws_back_by_what_a_straight_line_lacks_of_the_ball(degrees: float) -> None:
    """Of a line from so far above the middle to as far below most is lacking in its middle: half the blink has to give it."""
    first, last = on_ball(degrees, BLINK_GAP_METRES), on_ball(-degrees, BLINK_GAP_METRES)
    lacks = (RADIUS + BLINK_GAP_METRES) * (1 - np.cos(np.radians(degrees)))
    found = drawn_back(ball(), first[None], (last - first)[None], AHEAD)
    assert 2 * lacks <= found + 1e-9 and found < 4.2 * lacks
    for share in np.linspace(0.1, 1, 10):
        at = first + share * (last - first) + share * found * AHEAD
        assert np.linalg.norm(at) > RADIUS + BLINK_GAP_METRES - 3e-5


def test_an_eye_that_nothing_touches_stays_and_none_draws_back_farther_than_eyes_do() -> None:
    still = np.array([[0, 0, RADIUS + 0.001], [0.02, 0, 0]])
    assert drawn_back(ball(), still, np.zeros_like(still), AHEAD) == 0
    through = drawn_back(ball(), on_ball(80.0)[None], (on_ball(-80.0) - on_ball(80.0))[None], AHEAD)
    assert through == MAX_DRAWN_BACK_METRES
