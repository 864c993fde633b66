"""What is seen between the lips: one interface, behind which other systems may put a mouth of their own."""

from __future__ import annotations

from typing import Protocol

import numpy as np
from numpy.typing import NDArray


class MouthInterior(Protocol):
    """Draws the inside of a mouth. Frames are drawn side by side: drawing changes nothing but the frame."""

    def draw(self, frame: NDArray[np.uint8], face: NDArray[np.float32], driver_frame: int) -> None:
        """Draw between the lips of a `face` (478, 2), in place, pixels of the `frame` (H, W, 3), what the driver shows in
        its `driver_frame`."""
