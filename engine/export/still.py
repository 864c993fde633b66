"""Stills out: single pictures of a result, such as its poster, and the small ones by which it is found among others."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from engine.export.synthetic import mark_image
from engine.imaging.resample import resized, size_within
from engine.media.image import over_white, write_image

THUMBNAIL_SIDE_PIXELS = 320
"""Pixels of a thumbnail's longer side, at most."""
THUMBNAIL_BYTES = 11_000
"""Of a thumbnail's file, at most: five in a list are less than 60 kB."""
_REDUCTIONS = tuple((share, quality) for share in (1.0, 0.7, 0.5) for quality in (80, 65, 50, 35))


def write_still(path: Path, rgb: NDArray[np.uint8], synthetic: bool) -> None:
    """Write `rgb` (H, W, 3) in the format of the name's ending; `synthetic` as `VideoWriter` takes it."""
    write_image(path, rgb)
    if synthetic:
        mark_image(path)


def write_first_impression(
    folder: Path, rgb: NDArray[np.uint8], alpha: NDArray[np.float32] | None, synthetic: bool
) -> tuple[Path, Path]:
    """What is shown of a job before it has a result: `preview.jpg`, `rgb` (H, W, 3) over white, and `thumbnail.jpg`, the
    same for lists. Returns their paths."""
    seen = over_white(rgb, alpha)
    preview, thumbnail = folder / "preview.jpg", folder / "thumbnail.jpg"
    write_still(preview, seen, synthetic)
    write_thumbnail(thumbnail, seen, synthetic)
    return preview, thumbnail


def write_thumbnail(path: Path, rgb: NDArray[np.uint8], synthetic: bool) -> None:
    """Write `rgb` (H, W, 3) as a JPEG within `THUMBNAIL_SIDE_PIXELS` and `THUMBNAIL_BYTES`: the coarser, the more there is to
    see in it."""
    for share, quality in _REDUCTIONS:
        small = resized(np.ascontiguousarray(rgb), size_within(rgb.shape, round(THUMBNAIL_SIDE_PIXELS * share)))
        write_image(path, small, quality=quality)
        if synthetic:
            mark_image(path)
        if path.stat().st_size <= THUMBNAIL_BYTES:
            return
