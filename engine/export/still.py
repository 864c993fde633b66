"""Stills out: single pictures of a result, such as its poster."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from engine.export.synthetic import mark_image
from engine.media.image import write_image


def write_still(path: Path, rgb: NDArray[np.uint8], synthetic: bool) -> None:
    """Write `rgb` (H, W, 3) in the format of the name's ending; `synthetic` as `VideoWriter` takes it."""
    write_image(path, rgb)
    if synthetic:
        mark_image(path)
