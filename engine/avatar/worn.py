"""What an avatar wears that stands off its body, as the rest of the avatar takes it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from engine.geometry.texture_charts.texture_atlas import TextureAtlas


@dataclass(frozen=True)
class Attachments:
    """All the pieces that stand off the body, as one surface.

    vertices : (V, 3) as the person stood, metres, in the world of the fitted template.
    triangles : (T, 3), counter-clockwise from outside; what lies hidden within the skin is left out.
    atlas : where the triangles lie on the avatar's texture, beside the template's charts.
    bones, weights : (V, 4) the joints of `engine.body.rig.HUMAN_RIG` that move each vertex, strongest first, summing to one.
    """

    vertices: NDArray[np.float64]
    triangles: NDArray[np.int32]
    atlas: TextureAtlas
    bones: NDArray[np.uint8]
    weights: NDArray[np.float32]


def no_attachments() -> Attachments:
    """Those of somebody whose body's skin is all there is."""
    none = np.zeros((0, 3), np.int32)
    atlas = TextureAtlas(np.zeros((0, 2), np.float32), none, np.zeros(0, np.int32))
    return Attachments(np.zeros((0, 3)), none, atlas, np.zeros((0, 4), np.uint8), np.zeros((0, 4), np.float32))
