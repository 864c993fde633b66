"""How surfaces answer to a lamp: Lambert's law for what enters the skin, a microfacet lobe for what glances off.

Works on the visible points of a picture, (N, ...), some lamps at a time, adding up.

Source of the lobe: B. Walter et al., Microfacet Models for Refraction through Rough Surfaces, EGSR 2007 (GGX),
with Schlick's Fresnel term. Skin gets two lobes, as measured by T. Weyrich et al., SIGGRAPH 2006.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numba import prange
from numpy.typing import NDArray

from engine.compiled import njit
from engine.render.lighting.light import Lamps, cast_shadow, light_visibility


@dataclass(frozen=True)
class Surface:
    """The N visible points of a scene, one row for each.

    position : (N, 3) float32 metres.
    normal : (N, 3) float32, of the coarse surface.
    bumped : (N, 3) float32, the normal with the surface's fine relief.
    view : (N, 3) float32 unit vectors to the eye.
    roughness : (N,) float32, of the first lobe.
    reflectance : (N,) float32, at normal incidence.
    softness : (N, 3) float32 in [0, 1], how far the diffuse light of each colour forgets the fine relief: red light travels
        furthest under the skin.
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


SHADOW_MAPS_AT_ONCE = 32
"""Lamps whose shadows are held at a time: each takes a megabyte or two."""


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
    irradiance, mirrored = np.zeros_like(surface.position), np.zeros_like(surface.position)
    for first in range(0, len(lamps.directions), SHADOW_MAPS_AT_ONCE):
        directions = lamps.directions[first : first + SHADOW_MAPS_AT_ONCE]
        shadows = [cast_shadow(*casters, direction, centre, radius, map_size) for direction in directions]
        _add(  # in the order in which they are written: numba knows no keywords
            surface.position,
            surface.normal,
            surface.bumped,
            surface.view,
            surface.roughness,
            surface.reflectance,
            surface.softness,
            directions,
            lamps.irradiance[first : first + SHADOW_MAPS_AT_ONCE],
            np.stack([shadow.depth for shadow in shadows]),
            np.stack([shadow.view for shadow in shadows]),
            np.array([bias], np.float32),
            irradiance,
            mirrored,
        )
    return Lighting(irradiance, mirrored)


@njit(inline="always")
def _lobe(nl: float, nv: float, nh: float, vh: float, roughness: float, reflectance: float) -> float:
    """GGX times the cosine towards the lamp: the mirrored share of the irradiance of a lamp."""
    one = np.float32(1)
    a2 = roughness * roughness * roughness * roughness
    d = nh * nh * (a2 - one) + one
    distribution = a2 / (np.float32(np.pi) * d * d)
    # height-correlated Smith term, already divided by 4 (n.l) (n.v)
    masking = np.float32(0.5) / (
        nl * np.sqrt(nv * nv * (one - a2) + a2) + nv * np.sqrt(nl * nl * (one - a2) + a2) + np.float32(1e-6)
    )
    missed = one - vh
    fresnel = reflectance + (one - reflectance) * missed * missed * missed * missed * missed
    return distribution * masking * fresnel * nl


@njit(parallel=True, fastmath=True, error_model="numpy")
def _add(
    position: np.ndarray,
    normal: np.ndarray,
    bumped: np.ndarray,
    view: np.ndarray,
    roughness: np.ndarray,
    reflectance: np.ndarray,
    softness: np.ndarray,
    lamps: np.ndarray,
    colours: np.ndarray,
    depths: np.ndarray,
    light_views: np.ndarray,
    biases: np.ndarray,
    irradiance: np.ndarray,
    mirrored: np.ndarray,
) -> None:
    one, nought, bias = np.float32(1), np.float32(0), biases[0]
    for i in prange(len(position)):
        px, py, pz = position[i, 0], position[i, 1], position[i, 2]
        ax, ay, az = normal[i, 0], normal[i, 1], normal[i, 2]
        bx, by, bz = bumped[i, 0], bumped[i, 1], bumped[i, 2]
        vx, vy, vz = view[i, 0], view[i, 1], view[i, 2]
        nv = max(bx * vx + by * vy + bz * vz, np.float32(0.02))
        wide, gloss = roughness[i], reflectance[i]
        tight = wide * np.float32(0.6)
        for k in range(len(lamps)):
            lx, ly, lz = lamps[k, 0], lamps[k, 1], lamps[k, 2]
            smooth = ax * lx + ay * ly + az * lz
            fine = bx * lx + by * ly + bz * lz
            if smooth <= 0 and fine <= 0:
                continue
            # a surface seen at a grazing angle by the lamp needs a larger lift
            lift = bias * (one + np.float32(2) * (one - min(max(smooth, nought), one)))
            share = light_visibility(depths[k], light_views[k], px + lift * ax, py + lift * ay, pz + lift * az, bias)
            if share <= 0:
                continue
            for c in range(3):
                cosine = fine + softness[i, c] * (smooth - fine)
                if cosine > 0:
                    irradiance[i, c] += colours[k, c] * share * cosine
            if fine > 0 and smooth > 0 and gloss > 0:
                hx, hy, hz = lx + vx, ly + vy, lz + vz
                scale = one / np.sqrt(hx * hx + hy * hy + hz * hz + np.float32(1e-12))
                nh = min(max((bx * hx + by * hy + bz * hz) * scale, nought), one)
                vh = min(max((vx * hx + vy * hy + vz * hz) * scale, nought), one)
                lobes = np.float32(0.25) * _lobe(fine, nv, nh, vh, tight, gloss)
                lobes += np.float32(0.75) * _lobe(fine, nv, nh, vh, wide, gloss)
                # bumps must not catch light that grazes the surface they lie on
                lobes *= share * min(one, np.float32(5) * smooth)
                for c in range(3):
                    mirrored[i, c] += colours[k, c] * lobes
