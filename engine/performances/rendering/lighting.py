"""The studio's lamps, and the two things their light does besides falling on surfaces: mirroring in wet eyes, and
wandering about in the mouth."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from engine.performances.modelling.actor import Part, Scene
from engine.performances.modelling.chart import smooth_step
from engine.performances.rendering.visibility import VisiblePoints
from engine.render.lighting.light import Lamps, dome, softbox

KEY_BOX = (-40.0, 34.0, 44.0, 52.0)
FILL_BOX = (50.0, 8.0, 70.0, 60.0)
"""Softboxes: azimuth, elevation, width and height in degrees."""

KEY_IRRADIANCE = np.array([2.05, 1.98, 1.86], np.float32)
"""Irradiance of the key softbox on a surface that faces it."""
FILL_IRRADIANCE = np.array([0.42, 0.44, 0.47], np.float32)
"""Irradiance of the fill softbox on a surface that faces it."""

ZENITH_RADIANCE, HORIZON_RADIANCE, FLOOR_RADIANCE = (
    np.array([0.14, 0.145, 0.155]),
    np.full(3, 0.085),
    np.array([0.05, 0.043, 0.037]),
)
"""Radiance of the room from above, the sides and below."""

CATCHLIGHT_GAIN = 2.8
"""How much brighter the boxes look in the eyes than they light the face: their diffusers are not even."""

EYE_BOUNCE = np.array([0.10, 0.11, 0.12], np.float32)
"""Irradiance on the rims of the lids by light from the white of the eye."""

MOUTH_IRRADIANCE = np.array([0.40, 0.31, 0.27], np.float32)
"""Irradiance inside the mouth by light that its walls pass on to each other."""


def lamps(detail: float = 1.0) -> Lamps:
    """A large warm key from the sitter's right, a weak fill, two rims, a dim room; `detail` scales how many lamps
    stand for each."""

    def number(count: int) -> int:
        return max(round(count * detail), 2)

    return (
        softbox(KEY_BOX[0], KEY_BOX[1], KEY_BOX[2:], KEY_IRRADIANCE, number(22))
        + softbox(FILL_BOX[0], FILL_BOX[1], FILL_BOX[2:], FILL_IRRADIANCE, number(8))
        + softbox(152, 42, (50, 40), np.array([0.45, 0.45, 0.46]), number(4))
        + softbox(-152, 42, (50, 40), np.array([0.36, 0.36, 0.36]), number(4))
        + dome(ZENITH_RADIANCE, HORIZON_RADIANCE, FLOOR_RADIANCE, number(24))
    )


def interreflection(scene: Scene, seen: VisiblePoints, wet: NDArray[np.float32]) -> NDArray[np.float32]:
    """Irradiance (N, 3) by light that surfaces pass on to each other: between the walls of the mouth, fading towards
    the throat, and from the white of the eye onto the `wet` (N,) rims of the lids."""
    inside = (seen.part == Part.TEETH) | (seen.part == Part.TONGUE)
    head = scene.posed.head
    depth = 0.146 - (seen.position[inside] - head[:3, 3]) @ head[:3, 2]
    bounced = wet[:, None] * EYE_BOUNCE
    bounced[inside] += np.exp(-np.clip(depth, 0, None) / 0.013)[:, None].astype(np.float32) * MOUTH_IRRADIANCE
    return bounced


def catchlights(seen: VisiblePoints, irradiance: NDArray[np.float32]) -> NDArray[np.float32]:
    """What the wet eyes mirror (N, 3): the softboxes, sharp-edged, where the lids do not keep their light away."""
    mirrored = np.zeros_like(seen.position)
    eye = np.isin(seen.part, (Part.LEFT_EYE, Part.RIGHT_EYE))
    normal, view = seen.normal[eye], seen.view[eye]
    cosine = (normal * view).sum(1, keepdims=True)
    ray = 2 * cosine * normal - view
    azimuth = np.degrees(np.arctan2(ray[:, 0], ray[:, 2]))
    elevation = np.degrees(np.arcsin(np.clip(ray[:, 1], -1, 1)))
    fresnel = 0.025 + 0.975 * (1 - np.clip(cosine[:, 0], 0, 1)) ** 5
    open_to = np.clip(irradiance[eye].mean(1) / 0.55, 0, 1)
    for (x, y, width, height), light in ((KEY_BOX, KEY_IRRADIANCE), (FILL_BOX, FILL_IRRADIANCE)):
        inside = smooth_step(np.abs(azimuth - x), width / 2 + 3, width / 2 - 3) * smooth_step(
            np.abs(elevation - y), height / 2 + 3, height / 2 - 3
        )
        radiance = light / (np.radians(width) * np.radians(height) * np.cos(np.radians(y)))
        mirrored[eye] += CATCHLIGHT_GAIN * (inside * fresnel * open_to)[:, None] * radiance
    return mirrored
