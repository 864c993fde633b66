"""How a film is laid out."""

from __future__ import annotations

import numpy as np
import pytest

from engine.persona.film import MAX_DRIVER_WIDTH_RATIO, beside, size_beside

BACKGROUND = (10, 20, 30)


@pytest.mark.parametrize(("driver", "width"), [((480, 480), 1400), ((720, 1280), 1050), ((1920, 1080), 600 + 1200)])
def test_a_driver_beside_the_puppet_is_as_high_as_it(driver: tuple[int, int], width: int) -> None:
    assert size_beside(driver, (600, 800)) == (width, 800)


def test_what_is_too_wide_is_fitted() -> None:
    left, right = np.full((50, 400, 3), 255, np.uint8), np.full((100, 60, 3), 99, np.uint8)
    both = beside(left, right, BACKGROUND)
    assert both.shape == (100, 60 + round(MAX_DRIVER_WIDTH_RATIO * 60), 3)
    assert (both[:, 120:] == 99).all() and (both[45:55, :120] == 255).all() and (both[:42, :120] == BACKGROUND).all()
