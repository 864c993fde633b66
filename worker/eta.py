"""How long a job still takes, from how its fraction grew."""

from __future__ import annotations

import time
from collections.abc import Callable

LEAST_FRACTION = 0.02
LEAST_SECONDS = 1.0
JUMP = 0.05
JUMP_SECONDS = 0.5
"""A fraction that grows by this much in this time was not worked for: the stage had been stored before."""


class Eta:
    """Assumes that the rest goes as fast as what this attempt has done so far."""

    def __init__(self, clock: Callable[[], float] = time.monotonic) -> None:
        self._clock = clock
        self._began = self._last = clock()
        self._fraction: float | None = None
        self._worked = 0.0

    def after(self, fraction: float) -> float | None:
        """Seconds left at this fraction; None while too little is known."""
        moment = self._clock()
        if self._fraction is None:
            self._began = moment  # a resumed job begins in the middle
        elif not (fraction - self._fraction > JUMP and moment - self._last < JUMP_SECONDS):
            self._worked += max(fraction - self._fraction, 0.0)
        self._fraction, self._last = fraction, moment
        elapsed = moment - self._began
        if elapsed < LEAST_SECONDS or self._worked < LEAST_FRACTION:
            return None
        return round(elapsed * (1 - fraction) / self._worked, 1)
