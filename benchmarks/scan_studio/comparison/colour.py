"""How unlike a film an avatar looks, drawn where the film shows the person: the root mean square error in CIELAB.

Only those pixels count that the drawn avatar covers, its outline left out, where a pixel holds something of the room as well.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Literal

import cv2
import numpy as np
from numpy.typing import NDArray

from benchmarks.scan_studio.scenery.drawing import TexturedMesh, draw_over, empty_depths
from engine.geometry.camera import Camera
from engine.media.colour_conversion.tone_mapping import srgb_code, srgb_light, xyz_of

UNCOUNTED_OUTLINE_PIXELS = 2
"""Pixels along the outline that do not count."""


@dataclass(frozen=True)
class ColourError:
    """In units of CIELAB (CIE 1976)."""

    rmse: float
    """Over all pixels of all frames: the root of the mean of the squared distances of colours."""
    frames: NDArray[np.float64]
    """(F,) the same of each frame; NaN where nothing of the avatar is seen."""


def film_colour_error(
    mesh: TexturedMesh,
    stands: Sequence[NDArray[np.floating]],
    frames: Iterable[NDArray[np.uint8]],
    cameras: Sequence[Camera],
    gains: NDArray[np.floating] | Literal["fitted"] | None = None,
) -> ColourError:
    """Compare a film's frames (H, W, 3) with a mesh whose vertices (V, 3) stand before each frame's camera as `stands` has it.

    `gains` (F, 3), where they are known, are by what the phone multiplied red, green and blue light. The drawn colours
    are multiplied by them, too, so that the drift of the exposure is nobody's fault. "fitted": by the median of what
    each frame shows brighter than drawn. Raises ValueError where no frame shows any.
    """
    squares, counts = [], []
    fits = isinstance(gains, str)
    given = np.ones((len(cameras), 3)) if gains is None or isinstance(gains, str) else gains
    for frame, vertices, camera, gain in zip(frames, stands, cameras, given, strict=True):
        drawn = np.zeros((*camera.size, 3), np.uint8)
        covered = draw_over(drawn, empty_depths(camera), mesh, vertices, camera)
        side = 2 * UNCOUNTED_OUTLINE_PIXELS + 1
        inside = cv2.erode(covered.astype(np.uint8), np.ones((side, side), np.uint8), borderValue=1) > 0
        counts.append(int(inside.sum()))
        if counts[-1]:
            if fits:
                gain = _brighter(frame[inside], drawn[inside])
            away = cielab(frame[inside]) - cielab(_brightened(drawn[inside], gain))
            squares.append(float((away**2).sum()))
        else:
            squares.append(0.0)
    if not sum(counts):
        raise ValueError("no frame shows anything of the avatar")
    each = np.array([square / count if count else np.nan for square, count in zip(squares, counts, strict=True)])
    return ColourError(float(np.sqrt(sum(squares) / sum(counts))), np.sqrt(each))


def cielab(rgb: NDArray[np.uint8]) -> NDArray[np.float64]:
    """(N, 3) L*, a* and b* of sRGB colours (N, 3), for a white of D65 (CIE 15: OpenCV's tables are off by 0.2)."""
    matrix = xyz_of("bt709")
    share = (srgb_light(np.arange(256) / 255)[rgb] @ matrix.T) / matrix.sum(1)
    x, y, z = np.where(share > (6 / 29) ** 3, np.cbrt(share), share / (3 * (6 / 29) ** 2) + 4 / 29).T
    return np.stack([116 * y - 16, 500 * (x - y), 200 * (y - z)], 1)


def _brighter(frame: NDArray[np.uint8], drawn: NDArray[np.uint8]) -> NDArray[np.float64]:
    """(3,) by what the light of colours (N, 3) is more than that of others."""
    light = srgb_light(np.arange(1, 257) / 256)  # black has no ratio
    return np.asarray(np.median(light[frame] / light[drawn], axis=0))


def _brightened(rgb: NDArray[np.uint8], gain: NDArray[np.floating]) -> NDArray[np.uint8]:
    tables = [np.rint(255 * srgb_code(np.minimum(srgb_light(np.arange(256) / 255) * g, 1))) for g in gain]
    return np.stack([tables[k].astype(np.uint8)[rgb[:, k]] for k in range(3)], 1)
