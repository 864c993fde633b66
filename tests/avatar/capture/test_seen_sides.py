"""Sides that no camera looked at are named by the person's own left and right."""

from __future__ import annotations

import numpy as np
import pytest

from engine.avatar.capture.seen_sides import unseen_side


@pytest.mark.parametrize(
    ("degrees", "unseen"),
    [
        ((0, 360), None),
        ((0, 280), None),  # the gap of 80 degrees is looked into from both ends
        ((-90, 90), "back"),
        ((90, 270), "front"),
        ((0, 180), "right side"),
        ((180, 360), "left side"),
    ],
)
def test_the_side_in_the_widest_gap_is_named(degrees: tuple[int, int], unseen: str | None) -> None:
    """Angles from the front, +z, to the person's left, +x; the person faces +z."""
    around = np.radians(np.linspace(*degrees, 40))
    eyes = np.stack([2 * np.sin(around), np.full(40, 1.4), 2 * np.cos(around)], axis=1)
    assert unseen_side(eyes) == unseen
