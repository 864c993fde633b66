"""Where the skin around an eye lies: between the brow and the cheek, along the eye from its outer corner to the inner one."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from engine.perception.face.landmarks import LEFT_EYE_CORNER_VERTICES, RIGHT_EYE_CORNER_VERTICES

EYE_CORNER_VERTEX_PAIRS = (RIGHT_EYE_CORNER_VERTICES, LEFT_EYE_CORNER_VERTICES)
"""Vertices at which both lids of an eye end, the outer one first; right eye first."""
UPPER_LID_STRIPS = (
    ((247, 30, 29, 27, 28, 56, 190), (246, 161, 160, 159, 158, 157, 173)),
    ((467, 260, 259, 257, 258, 286, 414), (466, 388, 387, 386, 385, 384, 398)),
)
"""Vertices of the skin above the upper lid, and of the lid's edge, from the eye's outer corner on."""
LOWER_LID_EDGES = ((7, 163, 144, 145, 153, 154, 155), (249, 390, 373, 374, 380, 381, 382))
"""Vertices of the lower lid's edge."""
BELOW_BROW_VERTICES = ((113, 225, 224, 223, 222, 221, 189), (342, 445, 444, 443, 442, 441, 413))
"""Vertices below the brow."""
BELOW_EYE_VERTICES = ((31, 228, 229, 230, 231, 232, 233), (261, 448, 449, 450, 451, 452, 453))
"""Vertices of the skin below the eye, where the cheek begins."""
UPPER_REACH_SHARE = 0.6
"""Of the way from the skin above the lid up to below the brow, at which the socket begins: brows stand above."""
OUTER_REACH_EYE_WIDTHS, INNER_REACH_EYE_WIDTHS = 0.3, 0.2
"""Eye widths beyond the corners that are of the socket: lashes and their paint go beyond the outer one, and the nose begins at the inner one."""
CURVE_DEGREE = 3
"""Of the polynomials along the eye that a lid's edge and the ends of the socket are, since each of their points is tracked by itself."""


@dataclass(frozen=True)
class SocketFrame:
    """The socket of one eye of a face: places in it are told in eye widths, along the eye from the outer corner, and down.

    origin : (2,) float64, the outer corner, pixels.
    axes : (2, 2) float64, along and down, of length 1.
    width : pixels from corner to corner.
    top, bottom : (7, 2) float64, where the socket begins and ends, along and down.
    upper, lower : (9, 2) float64, both lids' edges from corner to corner.
    """

    origin: NDArray[np.float64]
    axes: NDArray[np.float64]
    width: float
    top: NDArray[np.float64]
    bottom: NDArray[np.float64]
    upper: NDArray[np.float64]
    lower: NDArray[np.float64]

    def of_pixels(self, x: NDArray[np.floating], y: NDArray[np.floating]) -> tuple[NDArray, NDArray]:
        """Where pixels (h, w) are, along and down."""
        right, down = (x - self.origin[0]) / self.width, (y - self.origin[1]) / self.width
        return right * self.axes[0, 0] + down * self.axes[0, 1], right * self.axes[1, 0] + down * self.axes[1, 1]

    def pixels(self, along: NDArray[np.floating], down: NDArray[np.floating]) -> NDArray[np.float64]:
        """(..., 2) the pixels at places (...)."""
        return np.asarray(self.origin + self.width * (along[..., None] * self.axes[0] + down[..., None] * self.axes[1]))

    def ends(self, along: NDArray[np.floating]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """(...) how far down the socket begins and ends `along` the eye."""
        held = np.clip(along, 0, 1)
        return np.asarray(self._top(held), np.float64), np.asarray(self._bottom(held), np.float64)

    def rim(self, along: NDArray[np.floating]) -> NDArray[np.float64]:
        """(...) how far down the upper lid's edge is `along` the eye; beyond the corners as at them."""
        return np.asarray(self._rim(np.clip(along, 0, 1)), np.float64)

    @cached_property
    def _rim(self) -> np.polynomial.Polynomial:
        return np.polynomial.Polynomial.fit(self.upper[:, 0], self.upper[:, 1], CURVE_DEGREE)

    @cached_property
    def _top(self) -> np.polynomial.Polynomial:
        return np.polynomial.Polynomial.fit(self.top[:, 0], self.top[:, 1], CURVE_DEGREE)

    @cached_property
    def _bottom(self) -> np.polynomial.Polynomial:
        return np.polynomial.Polynomial.fit(self.bottom[:, 0], self.bottom[:, 1], CURVE_DEGREE)

    def box(self, shape: tuple[int, ...]) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
        """The first pixel (x, y) of the socket in a picture of `shape`, and the first beyond it."""
        along = np.array([-OUTER_REACH_EYE_WIDTHS, 1 + INNER_REACH_EYE_WIDTHS])
        spread = np.concatenate([self.top[:, 1], self.bottom[:, 1]])
        corners = self.pixels(*np.meshgrid(along, [spread.min(), spread.max()])).reshape(-1, 2)
        low = np.maximum(np.floor(corners.min(axis=0)).astype(int), 0)
        return low, np.minimum(np.ceil(corners.max(axis=0)).astype(int) + 1, (shape[1], shape[0]))


def socket_frame(mesh: NDArray[np.floating], side: int) -> SocketFrame:
    """That of the right eye, 0, or the left one of a face at `mesh` (478, 2 or 3), pixels."""
    outer, inner = EYE_CORNER_VERTEX_PAIRS[side]
    above, edge = UPPER_LID_STRIPS[side]
    places = mesh[:, :2].astype(np.float64)
    across = places[inner] - places[outer]
    width = max(float(np.linalg.norm(across)), 1.0)
    right = across / width
    down = np.array([-right[1], right[0]]) * (1.0 if side == 0 else -1.0)
    axes = np.array([right, down])
    top = places[list(above)] + UPPER_REACH_SHARE * (places[list(BELOW_BROW_VERTICES[side])] - places[list(above)])
    rows = (top, places[list(BELOW_EYE_VERTICES[side])])
    lids = (places[[outer, *row, inner]] for row in (edge, LOWER_LID_EDGES[side]))
    return SocketFrame(places[outer], axes, width, *((row - places[outer]) @ axes.T / width for row in (*rows, *lids)))
