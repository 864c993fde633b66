"""What is painted where limbs hide the trunk."""

from __future__ import annotations

import numpy as np

from engine.character.hybrid.behind_limbs import mirrored_behind


def test_stripes_go_on_at_their_height() -> None:
    """A striped shirt above black trousers, an arm at its right side: no black beneath the arm, and all stripes."""
    rgb = np.zeros((200, 160, 3), np.uint8)
    rgb[20:120, 30:130] = np.where(np.arange(100)[:, None, None] // 10 % 2, [200, 30, 30], 250)
    true, hidden = rgb.copy(), np.zeros((200, 160), np.bool_)
    hidden[30:110, 105:130] = True
    rgb[hidden] = [220, 170, 140]
    filled = mirrored_behind(rgb, hidden, true.any(-1))
    middle = slice(40, 100)
    assert (np.abs(filled[middle].astype(int) - true[middle]).max(-1) < 5).mean() > 0.97
    assert (filled[~hidden] == rgb[~hidden]).all()


def test_of_what_is_hidden_all_over_nothing_is_made_up() -> None:
    rgb = np.full((20, 20, 3), 7, np.uint8)
    everything = np.ones((20, 20), np.bool_)
    assert (mirrored_behind(rgb, everything, everything) == rgb).all()
