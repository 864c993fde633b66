"""Faces cut out upright, all of one size, as networks that tell people apart were trained on them."""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.geometry.registration.rigid import fit_similarity
from engine.imaging.resample import resized


@dataclass(frozen=True)
class ChipLayout:
    """Where landmarks lie in a chip.

    side : pixels of the square chip.
    places : (K, 2) of its landmarks, pixels.
    vertices : for each landmark the mesh's vertices whose mean it is.
    """

    side: int
    places: NDArray[np.float64]
    vertices: tuple[tuple[int, ...], ...]


_SIDE, _PADDING = 150, 0.25
_MEAN_FACE = np.array(
    [[0.85957, 0.21350], [0.64606, 0.22897], [0.12058, 0.21373], [0.33409, 0.22906], [0.49011, 0.62780]]
)
DLIB_LAYOUT = ChipLayout(
    _SIDE, (_MEAN_FACE + _PADDING) / (1 + 2 * _PADDING) * _SIDE, ((263,), (362,), (33,), (133,), (2,))
)
"""The layout of dlib: corners of the eyes and the base of the nose of its mean face, a quarter of it left free all
around."""

ARCFACE_LAYOUT = ChipLayout(
    112,
    np.array([[38.2946, 51.6963], [73.5318, 51.5014], [56.0252, 71.7366], [41.5493, 92.3655], [70.7299, 92.2041]]),
    ((33, 133), (263, 362), (1, 4), (61,), (291,)),
)
"""The layout of most others: middles of the eyes, tip of the nose, corners of the mouth (J. Deng et al., ArcFace, CVPR
2019)."""


def face_chip(rgb: NDArray[np.uint8], mesh: NDArray[np.floating], layout: ChipLayout) -> NDArray[np.uint8]:
    """(side, side, 3) uint8: the face of a `mesh` (478, 2 or 3) in a picture `rgb` (H, W, 3), laid on the layout's landmarks by
    the similarity that fits best. What lies outside the picture is its edge drawn on."""
    seen = np.array([mesh[list(vertices), :2].mean(axis=0) for vertices in layout.vertices], np.float64)
    transform = fit_similarity(seen, layout.places)
    scale = float(np.sqrt(abs(np.linalg.det(transform.linear))))
    picture, linear, shift = rgb, transform.linear, transform.shift
    if scale < 0.5:  # a pixel of the chip stands for many: for their mean, not the nearest
        picture = resized(rgb, (round(2 * scale * rgb.shape[1]), round(2 * scale * rgb.shape[0])))
        ratio = np.array(rgb.shape[1::-1]) / picture.shape[1::-1]
        linear, shift = linear * ratio, shift + linear @ ((ratio - 1) / 2)
    side = (layout.side, layout.side)
    matrix = np.column_stack([linear, shift])
    chip = cv2.warpAffine(picture, matrix, side, flags=cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE)
    return np.asarray(chip, np.uint8)
