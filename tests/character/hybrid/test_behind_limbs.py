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


def test_it_begins_as_light_as_what_it_meets() -> None:
    """A shirt that is darker towards the arm: no step at the border, and lighter further in."""
    rgb = np.zeros((300, 200, 3), np.uint8)
    rgb[:] = np.clip(200 - 2 * np.maximum(np.arange(200) - 90, 0), 120, 200)[None, :, None]
    hidden = np.zeros((300, 200), np.bool_)
    hidden[50:250, 130:170] = True
    rgb[hidden] = [220, 170, 140]
    filled = mirrored_behind(rgb, hidden, np.broadcast_to(np.arange(200) < 170, hidden.shape)).astype(int)
    across = filled[100:200, 125:135].mean((0, 2))
    assert np.abs(np.diff(across)).max() < 6, "grey levels from one pixel to the next"
    assert filled[100:200, 150:168].mean() > across[4] + 10
