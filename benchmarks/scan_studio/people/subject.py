"""Who is filmed: a textured surface of known shape, at rest, and how its arms may drift."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

LAMP_DIRECTIONS = ((0.5, 0.75, 0.6), (-0.7, 0.5, -0.2), (0.1, 0.6, -0.9))
"""Towards the room's lamps."""
LAMP_SHARES = (0.24, 0.14, 0.12)
"""What each lamp adds at most to a surface that faces it."""
ROOM_AMBIENT_SHARE = 0.6
"""What comes from everywhere."""


@dataclass(frozen=True)
class Arm:
    """An arm that turns about its shoulder."""

    weights: NDArray[np.float64]
    """(V,) in [0, 1]: how far each of the subject's vertices goes with it."""
    pivot: NDArray[np.float64]
    """(3,) metres: the shoulder."""
    reach: float
    """Metres from there to the wrist."""


@dataclass(frozen=True)
class Subject:
    """Somebody at rest: y up, facing +z, standing on y = 0 at the origin."""

    name: str
    vertices: NDArray[np.float64]
    """(V, 3) metres; of the template's people all of `engine.body.template`, whether they are drawn or not."""
    triangles: NDArray[np.int32]
    """(T, 3) of what is drawn, counter-clockwise seen from outside."""
    uv: NDArray[np.float32]
    """(U, 2) places on the texture, in [0, 1], (0, 0) its top left corner."""
    uv_triangles: NDArray[np.int32]
    """(T, 3) which of them are the corners of each triangle."""
    texture: NDArray[np.uint8]
    """(H, W, 3) sRGB."""
    shade: NDArray[np.float32]
    """(V,) by what the room's light multiplies the texture."""
    joints: Mapping[str, NDArray[np.float64]]
    """(3,) metres by their names; empty where there is no rig."""
    arms: tuple[Arm, ...] = ()
    """Left and right; none where there is no rig."""
    template: bool = False
    """Whether the vertices are those of `engine.body.template`, in its order."""

    @cached_property
    def height(self) -> float:
        """Metres from the ground to the highest vertex that is drawn."""
        return float(self.vertices[np.unique(self.triangles), 1].max())

    @cached_property
    def head(self) -> NDArray[np.float64]:
        """(3,) metres: about the middle of the head."""
        drawn = self.vertices[np.unique(self.triangles)]
        if "Head" in self.joints:
            neck = self.joints["Head"]
            upper = drawn[(drawn[:, 1] > neck[1]) & (np.abs(drawn - neck)[:, [0, 2]].max(1) < 0.2)]
        else:
            upper = drawn[drawn[:, 1] > self.height - 0.24]
        return np.asarray((upper.min(0) + upper.max(0)) / 2)


def room_light(normals: NDArray[np.floating]) -> NDArray[np.float32]:
    """(V,) by what the lamps multiply the colours of surfaces with these normals (V, 3): matt, without shadows."""
    directions = np.array(LAMP_DIRECTIONS)
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    lit = np.clip(normals @ directions.T, 0, 1) @ np.array(LAMP_SHARES)
    return np.minimum(ROOM_AMBIENT_SHARE + lit, 1).astype(np.float32)
