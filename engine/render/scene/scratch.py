"""Arrays that are used again for every frame: memory that is fresh costs as much as what is done in it."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import DTypeLike, NDArray


class Scratch:
    """What one thread works in. Arrays of one name share their memory: each is gone when the next is asked for."""

    def __init__(self) -> None:
        self._held: dict[str, NDArray] = {}

    def filled(self, name: str, shape: tuple[int, int], value: float, dtype: DTypeLike) -> NDArray:
        """An array that holds `value` everywhere, contiguous."""
        count = math.prod(shape)
        held = self._held.get(name)
        if held is None or len(held) < count:
            held = self._held[name] = np.empty(count, dtype)
        array = held[:count].reshape(shape)
        array.fill(value)
        return array
