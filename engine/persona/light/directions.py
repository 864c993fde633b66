"""The lights of a collection: how faces look where a light comes from one side, as its own photographs show it.

Kemelmacher-Shlizerman and Seitz tell shape by a rank-four subspace, an ambient light and three directions. Here the coefficients of the same
subspace, told of each photograph's coarse light on the average face's normals, choose the photographs that are lit most from a side.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from engine.imaging.luminance import LUMINANCE_WEIGHTS
from engine.persona.light.low_frequencies import low_frequencies
from engine.persona.persona import Persona

LIGHT_DIRECTIONS: Mapping[str, tuple[float, float]] = {"left": (-1.0, 0.0), "right": (1.0, 0.0)}
"""Of a picture, x and y down. Lights from above and below differ by so little in collections that they change nothing to be seen."""
STRONGEST_SHARE, MIN_SIDE_LIT_PHOTOS = 0.1, 8
"""Of the photographs, those that are lit most from a side, and how many at least."""
RATIO_OFFSET_LEVELS = 8.0
"""Grey levels that are added on both sides of a ratio, so that black is no division by nothing."""
MIN_LIGHT_BELIEF = 0.01


class DirectedLight(NamedTuple):
    """gain : (H, W, 3) float32 over the average light, 1 in the mean of the face.
    strength : of the logarithm of light, by which it changes from one side of the face to straight ahead.
    """

    gain: NDArray[np.float32]
    strength: float


def directed_light(persona: Persona, direction: str) -> DirectedLight:
    """The light from a side, one of `LIGHT_DIRECTIONS`, in the mean of the photographs that show it most."""
    frame = persona.frame
    face = frame.face
    normals = frame.interpolated(frame.normals)[face]
    basis = np.column_stack([normals[:, :2], np.ones(len(normals))])
    average = low_frequencies(persona.average.astype(np.float32), face.astype(np.float32), frame.scale)
    logs, strengths = [], []
    for colours, belief in zip(persona.colours, persona.belief, strict=True):
        weights = face * (belief.astype(np.float32) / 255)
        own = low_frequencies(colours.astype(np.float32), weights, frame.scale)
        logs.append(np.log((own + RATIO_OFFSET_LEVELS) / (average + RATIO_OFFSET_LEVELS)))
        trust = weights[face][:, None] + MIN_LIGHT_BELIEF
        light = (logs[-1][face] @ LUMINANCE_WEIGHTS)[:, None]
        told = np.linalg.lstsq(basis * trust, light * trust, rcond=None)[0][:2, 0]
        strengths.append(float(told @ LIGHT_DIRECTIONS[direction]))
    count = min(max(MIN_SIDE_LIT_PHOTOS, round(STRONGEST_SHARE * len(logs))), len(logs))
    chosen = np.argsort(strengths)[::-1][:count]
    share = np.maximum(np.array(strengths)[chosen], 1e-3)
    mean = np.average(np.array(logs)[chosen], axis=0, weights=share)
    return DirectedLight(
        np.exp(mean - mean[face].mean(axis=0)).astype(np.float32), float(np.average(share, weights=share))
    )
