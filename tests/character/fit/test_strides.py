"""How far one leg is before the other: known strides, seen too short."""

from __future__ import annotations

import numpy as np

from engine.body.fitting.observation import DIRECTED_LIMBS
from engine.character.fit.template_fit import LEG_DEPTH_GAIN, legs_apart

FRONT = np.array([0.0, 0, 1])


def limbs(left: tuple[float, float, float], right: tuple[float, float, float]) -> np.ndarray:
    """Directions of `DIRECTED_LIMBS`, both legs straight, arms down."""
    found = np.tile([0.0, -1, 0], (len(DIRECTED_LIMBS), 1))
    found[4:6], found[6:] = left, right
    return found / np.linalg.norm(found, axis=1, keepdims=True)


def test_a_stride_that_is_surely_seen_grows_and_what_both_legs_share_stays() -> None:
    seen = limbs((0, -1, 0.3), (0, -1, -0.5))
    found = legs_apart(seen, FRONT)
    np.testing.assert_allclose((found[4:6] + found[6:]) / 2, (seen[4:6] + seen[6:]) / 2, atol=1e-12)
    grown = (found[4:6] - found[6:])[:, 2] / (seen[4:6] - seen[6:])[:, 2]
    assert (grown > 0.95 * LEG_DEPTH_GAIN).all() and (grown < LEG_DEPTH_GAIN).all()
    np.testing.assert_array_equal(found[:4], seen[:4])


def test_what_is_rather_noise_shrinks() -> None:
    seen = limbs((0, -1, 0.02), (0, -1, -0.02))
    apart = np.ptp(legs_apart(seen, FRONT)[[4, 6], 2])
    assert 0 < apart < np.ptp(seen[[4, 6], 2])


def test_legs_that_are_spread_by_somebody_turned_stay_so() -> None:
    """One foot is nearer to the viewer, and neither is before the other."""
    turn = np.radians(30)
    across, front = np.array([np.cos(turn), 0, -np.sin(turn)]), np.array([np.sin(turn), 0, np.cos(turn)])
    down = np.array([0.0, -1, 0])
    seen = limbs(tuple(down + 0.4 * across), tuple(down - 0.4 * across))
    np.testing.assert_allclose(legs_apart(seen, front), seen, atol=1e-12)
