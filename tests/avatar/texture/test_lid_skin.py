"""The skin of a shut lid spans from the lower lid's to that above its fold."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from engine.avatar.texture.template_texture.lid_skin import LidSkin

ACROSS = np.linspace(-0.2, 1.2, 400)
BELOW, ABOVE, BROW = np.array([170.0, 125, 105]), np.array([190.0, 150, 128]), np.array([40.0, 30, 24])


def plain(colour: NDArray[np.float64]) -> NDArray[np.float64]:
    return np.repeat(colour[None], len(ACROSS), 0)


def test_it_goes_straight_from_one_to_the_other() -> None:
    lids = LidSkin.between(plain(BELOW), ACROSS, plain(ABOVE), ACROSS)
    up = np.array([0, 0.5, 1.0])
    found = lids.at(np.full(3, 0.4), up)
    np.testing.assert_allclose(found[0], BELOW, atol=0.01)
    np.testing.assert_allclose(np.diff(found, axis=0)[0], np.diff(found, axis=0)[1], atol=1e-9)
    np.testing.assert_allclose(found[2], BELOW + 0.8 * (ABOVE - BELOW), atol=0.1)


def test_a_brow_above_is_no_skin_and_the_lid_is_as_the_one_below() -> None:
    lids = LidSkin.between(plain(BELOW), ACROSS, plain(BROW), ACROSS)
    np.testing.assert_allclose(lids.at(np.array([0.2, 0.8]), np.array([0.5, 1.0])), plain(BELOW)[:2], atol=0.01)


def test_light_from_aside_is_on_the_lid_too() -> None:
    lit = plain(BELOW) * (0.9 + 0.2 * ACROSS[:, None])
    lids = LidSkin.between(lit, ACROSS, plain(BROW), ACROSS)
    found = lids.at(np.array([0.25, 0.75]), np.array([0.5, 0.5]))
    np.testing.assert_allclose(found, BELOW * np.array([[0.95], [1.05]]), rtol=0.01)


def test_lashes_and_shade_below_are_left_out() -> None:
    below = plain(BELOW)
    below[::4] = BROW
    lids = LidSkin.between(below, ACROSS, plain(ABOVE), ACROSS)
    np.testing.assert_allclose(lids.at(np.array([0.5]), np.array([0.0]))[0], BELOW, atol=0.01)
