"""Light that goes on into what is filled."""

from __future__ import annotations

import numpy as np

from engine.character.shell.colours.light_of_the_picture import LIGHT_TEXELS, MAX_LIGHT_LEVELS, light_of_the_picture

SIDE = 512
SHOWN = np.broadcast_to((np.arange(SIDE) < SIDE // 2).astype(np.float32), (SIDE, SIDE))


def light(levels: float) -> np.ndarray:
    """Of a picture whose left half is shown, and lighter by so much than what is filled."""
    return light_of_the_picture(np.full((SIDE, SIDE, 3), levels, np.float32), SHOWN)[SIDE // 2, :, 0]


def test_what_is_filled_begins_as_light_as_what_it_meets_and_goes_over_into_itself() -> None:
    across = light(10.0)
    beside = SIDE // 2 + 4
    assert abs(across[beside] - 10) < 1.5
    assert (np.diff(across[beside:]) <= 1e-4).all()
    assert across[SIDE // 2 + int(4 * LIGHT_TEXELS)] < 0.5


def test_another_colour_is_no_light() -> None:
    assert np.abs(light(200.0)).max() <= MAX_LIGHT_LEVELS + 1e-3
    np.testing.assert_allclose(light(0.0), 0)


def test_where_nothing_is_shown_nothing_is_lighter() -> None:
    change = np.full((SIDE, SIDE, 3), 20, np.float32)
    np.testing.assert_allclose(light_of_the_picture(change, np.zeros((SIDE, SIDE), np.float32)), 0)
