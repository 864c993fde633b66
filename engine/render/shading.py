"""How surfaces answer to a lamp: Lambert's law for what enters the skin, a microfacet lobe for what glances off.

Works on the visible points of a picture, (N, ...), one lamp after the other, adding up.

Source of the lobe: B. Walter et al., Microfacet Models for Refraction through Rough Surfaces, EGSR 2007 (GGX),
with Schlick's Fresnel term. Skin gets two lobes, as measured by T. Weyrich et al., SIGGRAPH 2006.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numba import njit, prange
from numpy.typing import NDArray

from engine.render.light import Lamps, cast_shadow, lit


@dataclass(frozen=True)
class Surface:
    """The visible points of a scene, one row for each.

    `position` (N, 3) metres; `normal` (N, 3) the coarse surface, `bumped` (N, 3) with its fine relief;
    `view` (N, 3) unit vectors to the eye; `roughness` (N,) of the first lobe; `reflectance` (N,) at normal
    incidence; `softness` (N, 3) for each colour, how far its diffuse light forgets the fine relief [0, 1]:
    red light travels furthest under the skin.
    """

    position: NDArray[np.float32]
    normal: NDArray[np.float32]
    bumped: NDArray[np.float32]
    view: NDArray[np.float32]
    roughness: NDArray[np.float32]
    reflectance: NDArray[np.float32]
    softness: NDArray[np.float32]


@dataclass(frozen=True)
class Lighting:
    """What a surface receives and mirrors, (N, 3) float32 each: `irradiance` is yet to be multiplied by the
    albedo (and divided by pi), `mirrored` goes to the eye as it is."""

    irradiance: NDArray[np.float32]
    mirrored: NDArray[np.float32]


def illuminate(
    surface: Surface,
    lamps: Lamps,
    casters: tuple[NDArray[np.floating], NDArray[np.integer]],
    centre: NDArray[np.floating],
    radius: float,
    map_size: int = 640,
    bias: float = 7e-4,
) -> Lighting:
    """Light a surface by every lamp, with shadows cast by the mesh `casters` (vertices, triangles) inside the
    ball of `radius` metres around `centre`. `bias` (metres) keeps a surface from shading itself."""
    irradiance = np.zeros_like(surface.position)
    mirrored = np.zeros_like(surface.position)
    for direction, colour in zip(lamps.directions, lamps.irradiance, strict=True):
        shadow = cast_shadow(*casters, direction, centre, radius, map_size)
        _add(  # in the order in which they are written: numba knows no keywords
            surface.position,
            surface.normal,
            surface.bumped,
            surface.view,
            surface.roughness,
            surface.reflectance,
            surface.softness,
            direction,
            colour,
            shadow.depth,
            shadow.view,
            bias,
            irradiance,
            mirrored,
        )
    return Lighting(irradiance, mirrored)


@njit(cache=True, inline="always")
def _lobe(nl: float, nv: float, nh: float, vh: float, roughness: float, reflectance: float) -> float:
    """GGX times the cosine towards the lamp: the mirrored share of the irradiance of a lamp."""
    a2 = roughness**4
    d = nh * nh * (a2 - 1) + 1
    distribution = a2 / (np.pi * d * d)
    # height-correlated Smith term, already divided by 4 (n.l) (n.v)
    masking = 0.5 / (nl * np.sqrt(nv * nv * (1 - a2) + a2) + nv * np.sqrt(nl * nl * (1 - a2) + a2) + 1e-6)
    fresnel = reflectance + (1 - reflectance) * (1 - vh) ** 5
    return distribution * masking * fresnel * nl


@njit(cache=True, parallel=True, fastmath=True, error_model="numpy")
def _add(
    position: np.ndarray,
    normal: np.ndarray,
    bumped: np.ndarray,
    view: np.ndarray,
    roughness: np.ndarray,
    reflectance: np.ndarray,
    softness: np.ndarray,
    lamp: np.ndarray,
    colour: np.ndarray,
    depth: np.ndarray,
    light_view: np.ndarray,
    bias: float,
    irradiance: np.ndarray,
    mirrored: np.ndarray,
) -> None:
    for i in prange(len(position)):
        smooth = normal[i, 0] * lamp[0] + normal[i, 1] * lamp[1] + normal[i, 2] * lamp[2]
        fine = bumped[i, 0] * lamp[0] + bumped[i, 1] * lamp[1] + bumped[i, 2] * lamp[2]
        if smooth <= 0 and fine <= 0:
            continue
        # a surface seen at a grazing angle by the lamp needs a larger lift
        lift = bias * (1 + 2 * (1 - min(max(smooth, 0.0), 1.0)))
        share = lit(
            depth,
            light_view,
            position[i, 0] + lift * normal[i, 0],
            position[i, 1] + lift * normal[i, 1],
            position[i, 2] + lift * normal[i, 2],
            bias,
        )
        if share <= 0:
            continue
        for c in range(3):
            cosine = fine + softness[i, c] * (smooth - fine)
            if cosine > 0:
                irradiance[i, c] += colour[c] * share * cosine
        if fine > 0 and smooth > 0 and reflectance[i] > 0:
            hx, hy, hz = lamp[0] + view[i, 0], lamp[1] + view[i, 1], lamp[2] + view[i, 2]
            scale = 1 / np.sqrt(hx * hx + hy * hy + hz * hz + 1e-12)
            nh = min(max((bumped[i, 0] * hx + bumped[i, 1] * hy + bumped[i, 2] * hz) * scale, 0.0), 1.0)
            nv = max(bumped[i, 0] * view[i, 0] + bumped[i, 1] * view[i, 1] + bumped[i, 2] * view[i, 2], 0.02)
            vh = min(max((view[i, 0] * hx + view[i, 1] * hy + view[i, 2] * hz) * scale, 0.0), 1.0)
            tight = _lobe(fine, nv, nh, vh, roughness[i] * 0.6, reflectance[i])
            wide = _lobe(fine, nv, nh, vh, roughness[i], reflectance[i])
            # bumps must not catch light that grazes the surface they lie on
            gloss = share * min(1.0, 5 * smooth) * (0.25 * tight + 0.75 * wide)
            for c in range(3):
                mirrored[i, c] += colour[c] * gloss
