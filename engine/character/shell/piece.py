"""What a shell has beside the template: surfaces of their own, in the colours that the picture has there."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True)
class Colours:
    """A picture of a piece's own.

    places : (N, 2) float64, where in it each vertex is, from 0 to 1 across and down.
    rgb : (A, B, 3) uint8.
    """

    places: NDArray[np.float64]
    rgb: NDArray[np.uint8]


@dataclass(frozen=True)
class Piece:
    """A closed surface in the grid's picture space.

    kind : what it is, for the report: `skirt`, or the joint that carries it.
    vertices : (N, 3) float64.
    triangles : (M, 3) int32, counter-clockwise seen from outside in metres.
    bones : (N, 4) int, the joints that move it, strongest first.
    weights : (N, 4) float32.
    colours : its own; the picture's at its vertices' places unless they are given.
    """

    kind: str
    vertices: NDArray[np.float64]
    triangles: NDArray[np.int32]
    bones: NDArray[np.intp]
    weights: NDArray[np.float32]
    colours: Colours | None = None
