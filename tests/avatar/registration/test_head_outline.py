"""A head that stands out of what frames have of the person."""

from __future__ import annotations

import numpy as np
import pytest

from engine.avatar.registration.head_outline import beside_share
from engine.avatar.registration.part_outlines import Silhouette
from engine.geometry.camera import Camera


def silhouette(turn: float, seen: bool = True) -> Silhouette:
    """A ball of 10 cm about the origin, from two metres away; or nobody."""
    lens = Camera((0.0, 0.0, 1.0), 400.0, (99.5, 99.5), (200, 200))
    y, x = np.indices((200, 200)) - 99.5
    disc = np.hypot(x, y) < 400 * 0.1 / np.sqrt(2**2 - 0.1**2)
    return Silhouette(disc & seen, lens.aimed([2 * np.sin(turn), 0.0, 2 * np.cos(turn)], [0.0, 0.0, 0.0]))


@pytest.mark.parametrize(("lift", "share"), [(0.0, 0.0), (0.1, 0.5), (0.21, 1.0), (5.0, 0.0)])
def test_what_stands_out_of_the_outline_is_counted_where_pictures_have_it(lift: float, share: float) -> None:
    height = np.linspace(-0.097, 0.097, 400)
    line = np.stack([np.zeros(400), height + lift, np.zeros(400)], 1)
    views = [silhouette(turn) for turn in np.arange(8) * np.pi / 4]
    assert beside_share(line, views) == pytest.approx(share, abs=0.03)


def test_few_frames_that_miss_a_person_say_nothing() -> None:
    views = [silhouette(turn, seen=turn > 1) for turn in np.arange(8) * np.pi / 4]
    assert beside_share(np.zeros((4, 3)), views) == 0
