"""A textured mesh that the joints of a skeleton move: what a character is to exporters and renderers."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from engine.geometry.rigging.skeleton import Skeleton


@dataclass(frozen=True)
class SkinnedMesh:
    """One mesh with one texture.

    skeleton : the joints that move it.
    vertices : (V, 3) float32 metres, at rest (the skeleton's T-pose).
    triangles : (T, 3) int32, counter-clockwise seen from outside.
    uv : (V, 2) float32 in [0, 1], (0, 0) at the texture's upper left corner. Vertices along a seam of the texture are there
        once for each side.
    bones : (V, 4) uint8, the joints that move each vertex, strongest first.
    weights : (V, 4) float32, how much each of them does, summing to one.
    texture : (H, W, 3) uint8 sRGB.
    """

    skeleton: Skeleton
    vertices: NDArray[np.float32]
    triangles: NDArray[np.int32]
    uv: NDArray[np.float32]
    bones: NDArray[np.uint8]
    weights: NDArray[np.float32]
    texture: NDArray[np.uint8]
