"""How faces move in time: eased steps, swells with onset, apex and offset, blinks, glances, small unrest.

All functions take seconds (a number or an array) and give a weight.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

BLINK_CLOSES = 0.10
BLINK_REOPENING_SECONDS = 0.22
"""Seconds. Spontaneous blinks: the lid falls about twice as fast as it rises (K.-A. Kwon et al., High-speed camera
characterization of voluntary eye blinking kinematics, 2013)."""

SACCADE_SECONDS = 0.045
"""Seconds of a saccade of a few degrees."""


def ease(t: float, start: float, end: float) -> float:
    """0 before `start`, 1 after `end`, between them the path of least jerk, which limbs and lips follow
    (T. Flash, N. Hogan, 1985)."""
    x = float(np.clip((t - start) / (end - start), 0, 1))
    return x**3 * (10 - 15 * x + 6 * x * x)


def swell(t: float, onset: float, apex: float, release: float, end: float, sag: float = 0.0) -> float:
    """A movement that rises from `onset` to `apex`, loses the share `sag` of its strength until `release`, and is
    gone at `end`."""
    held = 1 - sag * ease(t, apex, release)
    return ease(t, onset, apex) * held * (1 - ease(t, release, end))


def blink(t: float, at: float, depth: float = 1.0, slow: float = 1.0) -> float:
    """A blink whose lid starts to fall at `at`: shut after `BLINK_CLOSES`, held for a frame, reopened fast first
    and settling slowly."""
    down = ease(t, at, at + slow * BLINK_CLOSES)
    shut = at + slow * (BLINK_CLOSES + 0.035)
    x = max((t - shut) / (slow * BLINK_REOPENING_SECONDS), 0.0)
    # a critically damped rise, cut off where less than a hundredth is left
    left = (1 + 6.6 * x) * np.exp(-6.6 * x) if x < 1.4 else 0.0
    fade = 1 - ease(x, 1.0, 1.4)
    return float(depth * down * (left * fade if x > 0 else 1.0))


def glances(t: float, places: tuple[tuple[float, float, float], ...]) -> tuple[float, float]:
    """The gaze (up, left) in degrees: from `places` (time, up, left), each reached by a saccade that starts at its
    time, the first before the clip begins."""
    up, left = places[0][1:]
    for at, next_up, next_left in places[1:]:
        share = ease(t, at, at + SACCADE_SECONDS)
        up, left = up + share * (next_up - up), left + share * (next_left - left)
    return up, left


def idle_noise(t: float, seed: int, period: float, fastest: int = 5) -> float:
    """Small motion that never quite stops: a sum of the first harmonics of `period`, so that it repeats without a
    seam; zero at t = 0, of about unit strength."""
    rng = np.random.default_rng(seed)
    order = np.arange(1, fastest + 1)
    strength = rng.normal(size=(2, fastest)) / order**0.9
    strength /= np.sqrt(0.5 * (strength**2).sum())
    angle = 2 * np.pi * order * t / period
    wave: NDArray[np.float64] = strength[0] * np.sin(angle) + strength[1] * (np.cos(angle) - 1)
    return float(wave.sum())
