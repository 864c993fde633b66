"""How long a job still takes, from how its fraction grew."""

from __future__ import annotations

import time

LEAST_FRACTION = 0.02
LEAST_SECONDS = 1.0


class Eta:
    """Assumes that the rest goes as fast as what this attempt has done so far.

    A resumed job jumps over stored stages: the fraction at its first report is not its own work.
    """

    def __init__(self) -> None:
        self._first: tuple[float, float] | None = None

    def after(self, fraction: float) -> float | None:
        """Seconds left at this fraction; None while too little is known."""
        moment = time.monotonic()
        if self._first is None:
            self._first = (moment, fraction)
        elapsed, done = moment - self._first[0], fraction - self._first[1]
        if elapsed < LEAST_SECONDS or done < LEAST_FRACTION:
            return None
        return round(elapsed * (1 - fraction) / done, 1)
