"""How long a job still takes, from how its fraction grew."""

from __future__ import annotations

import time
from collections import deque
from collections.abc import Callable

MIN_FRACTION = 0.02
MIN_SECONDS = 1.0
JUMP_FRACTION = 0.05
"""A fraction that grows by this much in `JUMP_SECONDS` was not worked for: the stage had been stored before."""
JUMP_SECONDS = 0.5


class Eta:
    """Assumes that the rest goes as fast as the later half of what this attempt has done so far.

    The beginning is slow, for much is done for the first time: modules are read, functions compiled. So the earlier half
    is forgotten as the work goes on; and where the process has not worked on this kind before, its first stage does not
    count at all.
    """

    def __init__(self, cold: bool = False, clock: Callable[[], float] = time.monotonic) -> None:
        self._cold, self._clock = cold, clock
        self._first: str | None = None
        self._fraction: float | None = None
        self._worked = 0.0
        self._steps: deque[tuple[float, float]] = deque()
        """(moment, what had been worked for by then), from the middle of the work on."""
        self._began = self._last = clock()

    def after(self, fraction: float, stage: str = "") -> float | None:
        """Seconds left at this fraction, in this stage; None while too little is known."""
        moment = self._clock()
        self._first = self._first or stage
        self._cold = self._cold and stage == self._first
        if self._fraction is None or self._cold:  # a resumed job begins in the middle
            self._began, self._worked = moment, 0.0
            self._steps.clear()
        elif not (fraction - self._fraction > JUMP_FRACTION and moment - self._last < JUMP_SECONDS):
            self._worked += max(fraction - self._fraction, 0.0)
        self._fraction, self._last = fraction, moment
        self._steps.append((moment, self._worked))
        while len(self._steps) > 2 and self._steps[0][1] < self._worked / 2:
            self._steps.popleft()
        return self._estimate(moment, fraction)

    def _estimate(self, moment: float, fraction: float) -> float | None:
        since, before = self._steps[0]
        later = self._worked - before
        if moment - self._began < MIN_SECONDS or self._worked < MIN_FRACTION or later <= 0 or moment <= since:
            return None
        return round((moment - since) * (1 - fraction) / later, 1)
